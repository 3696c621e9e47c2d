#include <algorithm>
#include <cmath>

#include "report/batch/ComparedResults.h"
#include "report/batch/Html.h"
#include "report/batch/NumberFormat.h"
#include "report/batch/PublishedResults.h"
#include "report/batch/ReportParts.h"

namespace polemcl::report {
namespace {

/// "0.174 ± 0.012", the spread in a lighter ink.
std::string withSpread(const MetricColumn& column, const Spread& spread) {
  std::string mean = column.figure(spread.mean);
  if (!std::isfinite(spread.deviation)) return mean;
  return mean + element("span", "class=\"sd\"", " ± " + column.figure(spread.deviation));
}

/// The first author, for narrow columns.
std::string firstWord(const std::string& system) {
  return escaped(system.substr(0, system.find(' ')));
}

bool isBad(const RunCounts& counts) {
  return counts.lost + counts.failed > 0;
}

std::string sessionName(const BatchResults& results, const SessionSummary& session) {
  return escaped(results.sessions[session.session].name);
}

std::string healthBar(const MetricSpreads& figures) {
  std::string parts;
  const std::pair<const char*, double> shares[] = {
      {"ok", figures.ok.mean}, {"degraded", figures.degraded.mean}, {"lost", figures.lost.mean}};
  for (const auto& [className, share] : shares)
    if (share > 0)
      parts += element("i",
                       "class=\"" + std::string(className) +
                           "\" style=\"width:" + metricText(100 * share, 2) + "%\"",
                       "");
  return element("span", "class=\"bar\" aria-hidden=\"true\"", parts);
}

}  // namespace

std::string changeText(double ratio) {
  constexpr double several = 3;  // from there on, per cent are hard to read
  if (!std::isfinite(ratio)) return enDash;
  if (ratio >= several) return metricText(ratio, ratio < 10 ? 1 : 0) + " times";
  const std::string text = metricText(std::abs(100 * (ratio - 1)), 0);
  return (text == "0" ? "±" : ratio > 1 ? "+" : "\xE2\x88\x92") + text + " %";
}

std::string runsText(const RunCounts& counts) {
  std::string text = countText(counts.runs);
  if (counts.lost > 0) text += ", " + countText(counts.lost) + " wrong";
  if (counts.failed > 0) text += ", " + countText(counts.failed) + " failed";
  return text;
}

std::string configurationsTable(const BatchResults& results, const Summaries& summaries) {
  HtmlTable table(
      "Settings compared: means over the localized sessions, each with the same weight.");
  const auto columnOf = [&](Quantity quantity, const auto& figure) {
    std::vector<double> values;
    for (const ConfigurationSummary& summary : summaries) values.push_back(figure(summary));
    return MetricColumn(quantity, values);
  };
  std::vector<HeadCell> head{{"Setting"}, {"Sessions"}};
  std::vector<MetricColumn> columns;
  for (const SessionColumn& column : sessionColumns) {
    columns.push_back(columnOf(column.quantity, [&](const ConfigurationSummary& summary) {
      return (summary.figures.*column.ours).mean;
    }));
    head.push_back({columns.back().head(column.html)});
  }
  const MetricColumn largest = columnOf(Quantity::length, [](const ConfigurationSummary& summary) {
    return summary.figures.posMax.largest;
  });
  head.insert(head.end(), {{largest.head("Largest")}, {"Last against first"}, {"Runs in all"}});
  table.head(head);
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    const ConfigurationSummary& summary = summaries[i];
    std::vector<std::string> cells{escaped(results.configurations[i].name),
                                   countText(summary.localized)};
    for (std::size_t k = 0; k < columns.size(); ++k)
      cells.push_back(columns[k].figure((summary.figures.*sessionColumns[k].ours).mean));
    cells.push_back(largest.figure(summary.figures.posMax.largest));
    cells.push_back(changeText(summary.lastOverFirst));
    cells.push_back(runsText(summary.counts));
    table.row(cells, isBad(summary.counts) ? "bad" : "");
  }
  return table.str();
}

namespace {

/// A configuration's summary of a session that was localized, or null.
const SessionSummary* localized(const ConfigurationSummary& configuration, std::size_t session) {
  const auto found = std::find_if(
      configuration.sessions.begin(), configuration.sessions.end(),
      [&](const SessionSummary& one) { return one.session == session && one.counts.runs > 0; });
  return found == configuration.sessions.end() ? nullptr : &*found;
}

}  // namespace

std::string sideBySideTable(const BatchResults& results, const Summaries& summaries) {
  HtmlTable table("Sessions with all settings side by side: mean over the runs.");
  std::vector<double> positions;
  for (const ConfigurationSummary& configuration : summaries)
    for (const SessionSummary& session : configuration.sessions)
      positions.push_back(session.figures.posMean.mean);
  const MetricColumn position(Quantity::length, positions), heading(Quantity::angle, {});
  std::vector<HeadCell> names{{""}}, columns{{"Session"}};
  for (const BatchConfiguration& configuration : results.configurations) {
    names.push_back({escaped(configuration.name), 3});
    columns.insert(
        columns.end(),
        {{position.head("Δ<sub>pos</sub>")}, {heading.head("Δ<sub>ang</sub>")}, {"Runs"}});
  }
  table.head(names);
  table.head(columns);
  for (std::size_t k = 0; k < results.sessions.size(); ++k) {
    std::vector<std::string> cells{escaped(results.sessions[k].name)};
    bool any = false;
    for (const ConfigurationSummary& configuration : summaries) {
      const SessionSummary* session = localized(configuration, k);
      any |= session != nullptr;
      cells.push_back(session ? position.figure(session->figures.posMean.mean) : enDash);
      cells.push_back(session ? heading.figure(session->figures.angMeanDeg.mean) : enDash);
      cells.push_back(!session ? enDash
                      : isBad(session->counts)
                          ? element("span", "class=\"bad\"", runsText(session->counts))
                          : runsText(session->counts));
    }
    if (any) table.row(cells);
  }
  return table.str();
}

namespace {

/// The paper's table of one configuration, with what was published for its sessions.
class SessionRows {
 public:
  SessionRows(const BatchResults& results, const ConfigurationSummary& configuration)
      : m_results(results), m_configuration(configuration), m_published(publishedRows(results)) {
    for (const SessionColumn& column : sessionColumns)
      m_columns.push_back(unitOf(column, configuration, m_published));
    for (std::size_t i = 0; i < m_published.systems.size(); ++i)
      if (std::isfinite(m_published.mean(i, configuration, &PublishedSession::mapShare)))
        m_withShares.push_back(i);
  }
  void head(HtmlTable& table) const {
    const std::size_t systems = m_published.systems.size();
    std::vector<HeadCell> groups{{""}, {"<i>f</i><sub>map</sub> (%)", 1 + m_withShares.size()}};
    std::vector<HeadCell> names{{"Session"}, {"this run"}};
    for (std::size_t system : m_withShares)
      names.push_back({firstWord(m_published.systems[system])});
    for (std::size_t i = 0; i < m_columns.size(); ++i) {
      groups.push_back({m_columns[i].head(sessionColumns[i].html), 1 + systems});
      names.push_back({"this run"});
      for (const std::string& system : m_published.systems) names.push_back({firstWord(system)});
    }
    groups.push_back({systems > 0 ? "" : "Runs"});
    names.push_back({"Runs"});
    if (systems == 0) groups.front() = {"Session"};
    table.head(groups);
    if (systems > 0) table.head(names);
  }
  std::vector<std::string> row(const SessionSummary& session) const {
    return cells(
        sessionName(m_results, session), session.mapShare,
        [&](std::size_t i) {
          return withSpread(m_columns[i], session.figures.*sessionColumns[i].ours);
        },
        [&](std::size_t system, double PublishedSession::*figure) {
          return m_published.figure(system, session, figure);
        },
        session.counts.runs > 0 ? runsText(session.counts) : "map only");
  }
  std::vector<std::string> foot() const {
    return cells(
        "Mean of sessions", m_configuration.mapShare.mean,
        [&](std::size_t i) {
          return m_columns[i].figure((m_configuration.figures.*sessionColumns[i].ours).mean);
        },
        [&](std::size_t system, double PublishedSession::*figure) {
          return m_published.mean(system, m_configuration, figure);
        },
        runsText(m_configuration.counts) + " in all");
  }
  std::string caption() const {
    std::string text = ": mean ± standard deviation over the runs of each session";
    if (m_published.systems.empty()) return text + ".";
    text += ", and the means published: ";
    for (std::size_t i = 0; i < m_published.systems.size(); ++i)
      text += (i == 0 ? "" : ", ") + m_published.systems[i];
    return text + ". Published means below are over the sessions of this table alone.";
  }

 private:
  template <typename Ours, typename Theirs>
  std::vector<std::string> cells(const std::string& name, double mapShare, const Ours& ours,
                                 const Theirs& theirs, const std::string& runs) const {
    std::vector<std::string> row{name, percentText(mapShare)};
    const std::size_t systems = m_published.systems.size();
    for (std::size_t k : m_withShares)
      row.push_back(percentText(theirs(k, &PublishedSession::mapShare)));
    for (std::size_t i = 0; i < m_columns.size(); ++i) {
      row.push_back(ours(i));
      for (std::size_t k = 0; k < systems; ++k)
        row.push_back(m_columns[i].figure(theirs(k, sessionColumns[i].published)));
    }
    row.push_back(runs);
    return row;
  }

  const BatchResults& m_results;
  const ConfigurationSummary& m_configuration;
  const PublishedRows m_published;
  std::vector<MetricColumn> m_columns;
  std::vector<std::size_t> m_withShares;  ///< systems that give f_map
};

}  // namespace

std::string paperTable(const BatchResults& results, std::size_t configuration,
                       const ConfigurationSummary& summary) {
  const SessionRows rows(results, summary);
  HtmlTable table("Setting " + results.configurations[configuration].name + rows.caption());
  rows.head(table);
  for (const SessionSummary& session : summary.sessions)
    table.row(rows.row(session), isBad(session.counts) ? "bad" : "");
  table.foot(rows.foot());
  return table.str(results.published.empty() ? "" : "dense");
}

std::string publishedTable(const BatchResults& results, const Summaries& summaries) {
  const PublishedDataset* dataset = publishedResults(results.dataset);
  if (!dataset || dataset->figures.empty()) return "";
  const std::vector<ComparedColumn> columns = comparedColumns(*dataset);
  HtmlTable table(dataset->title + ": published results, and those of this batch below.");
  std::vector<HeadCell> head{{"System"}};
  std::vector<MetricColumn> units;
  for (const ComparedColumn& column : columns) {
    units.push_back(unitOf(column, *dataset, summaries));
    head.push_back({units.back().head(column.html)});
  }
  table.head(head);
  std::string remarks;
  const auto remark = [&](const std::string& system, const std::string& text) {
    if (!text.empty()) remarks += element("li", sentence(system + ": " + text)) + '\n';
  };
  for (const PublishedResult& system : dataset->figures) {
    std::vector<std::string> cells{escaped(system.system)};
    for (std::size_t i = 0; i < columns.size(); ++i)
      cells.push_back(units[i].figure(system.*columns[i].published));
    table.row(cells);
    remark(escaped(system.system), escaped(system.remark));
  }
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    const std::string ours = "polemcl, " + escaped(results.configurations[i].name);
    std::vector<std::string> cells{ours};
    for (std::size_t k = 0; k < columns.size(); ++k)
      cells.push_back(units[k].figure((summaries[i].figures.*columns[k].ours).mean));
    table.row(cells, "ours");
    const std::string& description = results.configurations[i].description;
    remark(ours, (description.empty() ? "" : sentence(escaped(description)) + ' ') +
                     escaped(rowText(results.configurations[i], summaries[i])));
  }
  return table.str() + element("ul", "class=\"note\"", '\n' + remarks) + '\n';
}

std::string healthTable(const BatchResults& results, std::size_t configuration,
                        const ConfigurationSummary& summary) {
  HtmlTable table("Setting " + results.configurations[configuration].name +
                  ": shares of scans, mean over the runs of each session.");
  table.head({{"Session"},
              {"ok (%)"},
              {"degraded (%)"},
              {"lost (%)"},
              {"Share"},
              {"Relocalizations per run"}});
  for (const SessionSummary& session : summary.sessions) {
    if (session.counts.runs == 0) continue;
    const MetricSpreads& figures = session.figures;
    table.row({sessionName(results, session), percentText(figures.ok.mean),
               percentText(figures.degraded.mean), percentText(figures.lost.mean),
               healthBar(figures), metricText(session.relocalizations, 1)});
  }
  return table.str();
}

}  // namespace polemcl::report
