#include "ReportTables.h"

#include <polemcl/report/PublishedFigures.h>

#include <algorithm>
#include <cmath>

#include "ComparedFigures.h"
#include "FigureText.h"
#include "Html.h"

namespace polemcl::report {
namespace {

constexpr int decimals = 3;

const std::vector<HeadCell> paperFigures{{"Δ<sub>pos</sub> (m)"},
                                         {"RMSE<sub>pos</sub> (m)"},
                                         {"Δ<sub>ang</sub> (°)"},
                                         {"RMSE<sub>ang</sub> (°)"}};
constexpr Spread FigureSpreads::*paperSpreads[] = {&FigureSpreads::posMean, &FigureSpreads::posRmse,
                                                   &FigureSpreads::angMeanDeg,
                                                   &FigureSpreads::angRmseDeg};

std::string number(double value) {
  return figureText(value, decimals);
}

std::string percent(double share) {
  return figureText(100 * share, 1);
}

/// "0.174 ± 0.012", the spread in a lighter ink.
std::string withSpread(const Spread& spread) {
  if (!std::isfinite(spread.deviation)) return number(spread.mean);
  return number(spread.mean) + element("span", "class=\"sd\"", " ± " + number(spread.deviation));
}

std::vector<HeadCell> joined(std::vector<HeadCell> cells, const std::vector<HeadCell>& more) {
  cells.insert(cells.end(), more.begin(), more.end());
  return cells;
}

bool isBad(const RunCounts& counts) {
  return counts.lost + counts.failed > 0;
}

std::string sessionName(const BatchResults& results, const SessionSummary& session) {
  return escaped(results.sessions[session.session].name);
}

std::string healthBar(const FigureSpreads& figures) {
  std::string parts;
  const std::pair<const char*, double> shares[] = {
      {"ok", figures.ok.mean}, {"degraded", figures.degraded.mean}, {"lost", figures.lost.mean}};
  for (const auto& [className, share] : shares)
    if (share > 0)
      parts += element("i",
                       "class=\"" + std::string(className) +
                           "\" style=\"width:" + figureText(100 * share, 2) + "%\"",
                       "");
  return element("span", "class=\"bar\" aria-hidden=\"true\"", parts);
}

}  // namespace

std::string changeText(double ratio) {
  if (!std::isfinite(ratio)) return enDash;
  const std::string text = figureText(std::abs(100 * (ratio - 1)), 0);
  return (text == "0" ? "±" : ratio > 1 ? "+" : "\xE2\x88\x92") + text + " %";
}

std::string runsText(const RunCounts& counts) {
  std::string text = countText(counts.runs);
  if (counts.lost > 0) text += ", " + countText(counts.lost) + " lost";
  if (counts.failed > 0) text += ", " + countText(counts.failed) + " failed";
  return text;
}

std::string settingsTable(const BatchResults& results,
                          const std::vector<SettingSummary>& summaries) {
  HtmlTable table(
      "Settings compared: means over the localized sessions, each with the same weight.");
  table.head(joined(joined({{"Setting"}, {"Sessions"}}, paperFigures),
                    {{"Largest (m)"}, {"Last against first"}, {"Runs"}}));
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    const SettingSummary& summary = summaries[i];
    std::vector<std::string> cells{escaped(results.settings[i].name), countText(summary.localized)};
    for (const auto spread : paperSpreads) cells.push_back(number((summary.figures.*spread).mean));
    cells.push_back(number(summary.figures.posMax.largest));
    cells.push_back(changeText(summary.lastOverFirst));
    cells.push_back(runsText(summary.counts));
    table.row(cells, isBad(summary.counts) ? "bad" : "");
  }
  return table.str();
}

std::string sideBySideTable(const BatchResults& results,
                            const std::vector<SettingSummary>& summaries) {
  HtmlTable table("Sessions with all settings side by side: mean over the runs.");
  std::vector<HeadCell> names{{""}}, columns{{"Session"}};
  for (const BatchSetting& setting : results.settings) {
    names.push_back({escaped(setting.name), 3});
    columns = joined(columns, {{"Δ<sub>pos</sub> (m)"}, {"Δ<sub>ang</sub> (°)"}, {"Runs"}});
  }
  table.head(names);
  table.head(columns);
  for (std::size_t k = 0; k < results.sessions.size(); ++k) {
    std::vector<std::string> cells{escaped(results.sessions[k].name)};
    bool any = false;
    for (const SettingSummary& setting : summaries) {
      const auto found =
          std::find_if(setting.sessions.begin(), setting.sessions.end(),
                       [&](const SessionSummary& session) { return session.session == k; });
      const bool has = found != setting.sessions.end() && found->counts.runs > 0;
      any |= has;
      cells.push_back(has ? number(found->figures.posMean.mean) : enDash);
      cells.push_back(has ? number(found->figures.angMeanDeg.mean) : enDash);
      cells.push_back(has ? (isBad(found->counts)
                                 ? element("span", "class=\"bad\"", runsText(found->counts))
                                 : runsText(found->counts))
                          : enDash);
    }
    if (any) table.row(cells);
  }
  return table.str();
}

std::string paperTable(const BatchResults& results, std::size_t setting,
                       const SettingSummary& summary) {
  HtmlTable table("Setting " + results.settings[setting].name +
                  ": mean ± standard deviation over the runs of each session.");
  table.head(
      joined(joined({{"Session"}, {"<i>f</i><sub>map</sub> (%)"}}, paperFigures), {{"Runs"}}));
  for (const SessionSummary& session : summary.sessions) {
    std::vector<std::string> cells{sessionName(results, session), percent(session.mapShare)};
    for (const auto spread : paperSpreads) cells.push_back(withSpread(session.figures.*spread));
    cells.push_back(session.counts.runs > 0 ? runsText(session.counts) : "map only");
    table.row(cells, isBad(session.counts) ? "bad" : "");
  }
  std::vector<std::string> cells{"Mean of sessions", percent(summary.mapShare.mean)};
  for (const auto spread : paperSpreads) cells.push_back(number((summary.figures.*spread).mean));
  cells.push_back(runsText(summary.counts));
  table.foot(cells);
  return table.str();
}

std::string publishedTable(const BatchResults& results,
                           const std::vector<SettingSummary>& summaries) {
  const PublishedDataset* dataset = publishedFigures(results.dataset);
  if (!dataset) return "";
  const std::vector<ComparedColumn> columns = comparedColumns(*dataset);
  HtmlTable table(dataset->title + ": published figures, and ours below.");
  std::vector<HeadCell> head{{"System"}};
  for (const ComparedColumn& column : columns) head.push_back({column.html});
  table.head(head);
  std::string remarks;
  const auto remark = [&](const std::string& system, const std::string& text) {
    if (!text.empty()) remarks += element("li", sentence(system + ": " + text)) + '\n';
  };
  for (const PublishedFigure& system : dataset->figures) {
    std::vector<std::string> cells{escaped(system.system)};
    for (const ComparedColumn& column : columns) cells.push_back(number(system.*column.published));
    table.row(cells);
    remark(escaped(system.system), escaped(system.remark));
  }
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    const std::string ours = "polemcl, " + escaped(results.settings[i].name);
    std::vector<std::string> cells{ours};
    for (const ComparedColumn& column : columns)
      cells.push_back(number((summaries[i].figures.*column.ours).mean));
    table.row(cells, "ours");
    remark(ours,
           plural(summaries[i].localized, "session") + ", runs: " + runsText(summaries[i].counts));
  }
  return table.str() + element("ul", "class=\"note\"", '\n' + remarks) + '\n';
}

std::string healthTable(const BatchResults& results, std::size_t setting,
                        const SettingSummary& summary) {
  HtmlTable table("Setting " + results.settings[setting].name +
                  ": shares of scans, mean over the runs of each session.");
  table.head({{"Session"},
              {"ok (%)"},
              {"degraded (%)"},
              {"lost (%)"},
              {"Share"},
              {"Relocalizations per run"}});
  for (const SessionSummary& session : summary.sessions) {
    if (session.counts.runs == 0) continue;
    const FigureSpreads& figures = session.figures;
    table.row({sessionName(results, session), percent(figures.ok.mean),
               percent(figures.degraded.mean), percent(figures.lost.mean), healthBar(figures),
               figureText(session.relocalizations, 1)});
  }
  return table.str();
}

}  // namespace polemcl::report
