#include <cmath>

#include "report/batch/Html.h"
#include "report/batch/NumberFormat.h"
#include "report/batch/PublishedResults.h"
#include "report/batch/ReportParts.h"

namespace polemcl::report {
namespace {

std::string share(double value) {
  return metricText(value, 3);
}

template <typename Score>
void addShares(std::vector<std::string>& cells, const Score& score) {
  for (double value : {score.precision, score.recall, score.f1}) cells.push_back(share(value));
}

/// Precision, recall and F1 in the three ways to count, after the columns `first`; `last` ends it.
void addHead(HtmlTable& table, const std::vector<HeadCell>& first,
             const std::vector<HeadCell>& last) {
  std::vector<HeadCell> groups{{""}}, names = first;
  for (std::size_t i = 1; i < first.size(); ++i) groups.push_back({""});
  for (const char* way :
       {"authors' count, 1\xC2\xA0m", "one to one, 1\xC2\xA0m", "one to one, 0.5\xC2\xA0m"}) {
    groups.push_back({way, 3});
    names.insert(names.end(), {{"P"}, {"R"}, {"F1"}});
  }
  for (const HeadCell& cell : last) {
    groups.push_back({""});
    names.push_back(cell);
  }
  table.head(groups);
  table.head(names);
}

}  // namespace

std::string mapScoresTable(const BatchResults& results, const Summaries& summaries) {
  const PublishedDataset* dataset = publishedResults(results.dataset);
  HtmlTable table("Precision, recall and F1 of the maps, mean over the maps of a setting.");
  addHead(table, {{"System"}}, {{"Maps"}});
  if (dataset)
    for (const PublishedMapScore& system : dataset->maps) {
      std::vector<std::string> cells{escaped(system.system)};
      addShares(cells, system);
      cells.insert(cells.end(), 7, enDash);
      table.row(cells);
    }
  bool any = false;
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    const ScoreSummary& scores = summaries[i].scores;
    if (scores.maps == 0) continue;
    any = true;
    std::vector<std::string> cells{"polemcl, " + escaped(results.configurations[i].name)};
    for (const ScoreMeans* means : {&scores.near, &scores.oneToOne, &scores.oneToOneHalf})
      addShares(cells, *means);
    cells.push_back(countText(scores.maps));
    table.row(cells, "ours");
  }
  return any ? table.str() : "";
}

std::string everyScoreTable(const BatchResults& results) {
  HtmlTable table("Every map that was scored, by the session that completes it.");
  addHead(table, {{"Session"}, {"Setting"}}, {{"Poles"}, {"True poles"}, {"Truth"}});
  std::vector<std::size_t> maps(results.configurations.size(), 0);
  bool several = false;
  for (std::size_t k = 0; k < results.sessions.size(); ++k)
    for (std::size_t i = 0; i < results.configurations.size(); ++i) {
      const SessionResult* result = results.find(i, k);
      if (!result || !result->score) continue;
      several |= ++maps[i] > 1;
      const MapScores& scores = *result->score;
      std::vector<std::string> cells{escaped(results.sessions[k].name),
                                     escaped(results.configurations[i].name)};
      for (const MapScore* score : {&scores.near, &scores.oneToOne, &scores.oneToOneHalf})
        addShares(cells, *score);
      cells.push_back(countText(scores.near.mapPoles));
      cells.push_back(countText(scores.near.truthPoles));
      cells.push_back(escaped(scores.truth));
      table.row(cells);
    }
  return several ? table.str() : "";
}

}  // namespace polemcl::report
