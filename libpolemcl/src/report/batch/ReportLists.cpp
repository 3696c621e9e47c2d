#include <algorithm>
#include <cmath>
#include <map>

#include "io/file/TextFile.h"
#include "report/batch/Html.h"
#include "report/batch/NumberFormat.h"
#include "report/batch/ReportParts.h"

namespace polemcl::report {
namespace {

constexpr std::size_t mostOpenRows = 20;  // a longer list of troubles is folded away

/// A figure of a run in a list of runs.
struct RunColumn {
  const char* html;  ///< without its unit
  Quantity quantity;
  double ErrorMetrics::*figure;
};
constexpr RunColumn runColumns[] = {
    {"Δ<sub>pos</sub>", Quantity::length, &ErrorMetrics::posMean},
    {"RMSE<sub>pos</sub>", Quantity::length, &ErrorMetrics::posRmse},
    {"Largest", Quantity::length, &ErrorMetrics::posMax},
    {"Δ<sub>lat</sub>", Quantity::length, &ErrorMetrics::latMean},
    {"Δ<sub>lon</sub>", Quantity::length, &ErrorMetrics::lonMean},
    {"Δ<sub>ang</sub>", Quantity::angle, &ErrorMetrics::angMeanDeg},
    {"RMSE<sub>ang</sub>", Quantity::angle, &ErrorMetrics::angRmseDeg}};

MetricColumn unitOf(const RunColumn& column, const BatchResults& results,
                    std::size_t configuration) {
  std::vector<double> values;
  for (const SessionResult& result : results.results)
    if (result.configuration == configuration)
      for (const BatchRun& run : result.runs) values.push_back(run.errors.*column.figure);
  return {column.quantity, values};
}

std::vector<std::string> runCells(const BatchRun& run, const std::string& session, RunState state,
                                  const std::vector<MetricColumn>& units) {
  std::vector<std::string> cells{
      session, std::to_string(run.run), std::to_string(run.seed),
      state == RunState::ok ? name(state) : element("span", "class=\"bad\"", name(state))};
  for (std::size_t i = 0; i < units.size(); ++i)
    cells.push_back(units[i].figure(run.errors.*runColumns[i].figure));
  const HealthShares& health = run.health;
  cells.insert(cells.end(), {countText(run.errors.poses), percentText(health.ok),
                             percentText(health.degraded), percentText(health.lost),
                             health.firstPoseScan ? std::to_string(*health.firstPoseScan) : enDash,
                             std::to_string(health.relocalizations)});
  return cells;
}

std::string failedTasks(const std::vector<FailedTask>& failures) {
  if (failures.empty()) return "";
  HtmlTable table("Tasks that failed.");
  table.head({{"Task"}, {"Reason"}, {"Log"}});
  for (const FailedTask& task : failures)
    table.row({escaped(task.task), escaped(task.reason),
               task.log.empty() ? enDash : element("code", escaped(task.log))});
  return table.str("words");
}

/// "section.key" -> value of an INI text, without comments; in the order of the keys.
std::map<std::string, std::string> valuesOf(const std::string& ini) {
  std::map<std::string, std::string> values;
  std::string section;
  for (std::size_t begin = 0; begin < ini.size();) {
    const std::size_t end = std::min(ini.find('\n', begin), ini.size());
    const std::string line = ini.substr(begin, end - begin);
    begin = end + 1;
    const std::size_t comment = std::min(line.find_first_of(";#"), line.find("//"));
    const std::string text(io::trimmed(line.substr(0, comment)));
    const std::size_t equals = text.find('=');
    if (!text.empty() && text.front() == '[' && text.back() == ']')
      section = text.substr(1, text.size() - 2) + '.';
    else if (equals != std::string::npos)
      values[section + std::string(io::trimmed(text.substr(0, equals)))] =
          std::string(io::trimmed(text.substr(equals + 1)));
  }
  return values;
}

}  // namespace

std::string runsTable(const BatchResults& results, std::size_t configuration) {
  HtmlTable table("Setting " + results.configurations[configuration].name + ": every run.");
  std::vector<HeadCell> head{{"Session"}, {"Run"}, {"Seed"}, {"State"}};
  std::vector<MetricColumn> units;
  for (const RunColumn& column : runColumns) {
    units.push_back(unitOf(column, results, configuration));
    head.push_back({units.back().head(column.html)});
  }
  head.insert(head.end(), {{"Poses"},
                           {"ok (%)"},
                           {"degraded (%)"},
                           {"lost (%)"},
                           {"First pose at scan"},
                           {"Relocalizations"}});
  table.head(head);
  bool any = false;
  for (std::size_t k = 0; k < results.sessions.size(); ++k)
    if (const SessionResult* result = results.find(configuration, k))
      for (const BatchRun& run : result->runs) {
        const RunState state = stateOf(run, results.lostBound);
        table.row(runCells(run, escaped(results.sessions[k].name), state, units));
        any = true;
      }
  return any ? table.str() : "";
}

std::string troublesTables(const BatchResults& results) {
  HtmlTable table("Runs that failed or went wrong.");
  table.head({{"Session"},
              {"Setting"},
              {"Run"},
              {"Seed"},
              {"Δ<sub>pos</sub>"},
              {"At the end"},
              {"What happened"}});
  std::size_t count = 0;
  for (std::size_t k = 0; k < results.sessions.size(); ++k)
    for (std::size_t i = 0; i < results.configurations.size(); ++i) {
      const SessionResult* result = results.find(i, k);
      if (!result) continue;
      for (const BatchRun& run : result->runs) {
        const RunState state = stateOf(run, results.lostBound);
        if (state == RunState::ok) continue;
        ++count;
        table.row({escaped(results.sessions[k].name), escaped(results.configurations[i].name),
                   std::to_string(run.run), std::to_string(run.seed),
                   lengthText(run.errors.posMean), lengthText(run.errors.posEnd),
                   state == RunState::failed ? "failed: " + escaped(run.failure)
                   : run.errors.poses == 0   ? "never knew a pose"
                                             : "wrong pose"});
      }
    }
  std::string failed = failedTasks(results.failures);
  if (count == 0) return failed;
  return failed + (count <= mostOpenRows ? table.str("remark")
                                         : foldable(plural(count, "run") + " failed or wrong",
                                                    table.str("remark"), false));
}

std::string sessionsTable(const BatchResults& results) {
  HtmlTable table("Sessions, in the order they were driven.");
  table.head({{"Session"}, {"Date"}, {"Length (m)"}, {"Scans"}, {"Poles per scan"}});
  for (const BatchSession& session : results.sessions)
    table.row({escaped(session.name), session.date.empty() ? enDash : escaped(session.date),
               metricText(session.length, 0), countText(session.scans),
               metricText(session.polesPerScan, 1)});
  return table.str();
}

std::string timingsTable(const BatchTimings& timings) {
  HtmlTable table("Times of the tasks, each on one process.");
  table.head({{"Task"}, {"Number"}, {"Total"}, {"Median"}, {"Longest"}});
  double all = 0;
  std::size_t count = 0;
  for (const TaskTimes& task : timings.tasks) {
    std::vector<double> seconds = task.seconds;
    if (seconds.empty()) continue;
    std::sort(seconds.begin(), seconds.end());
    double total = 0;
    for (double one : seconds) total += one;
    all += total;
    count += seconds.size();
    table.row({escaped(task.kind), countText(seconds.size()), durationText(total),
               durationText(seconds[(seconds.size() - 1) / 2]), durationText(seconds.back())});
  }
  table.foot({"All", countText(count), durationText(all), "", ""});
  return table.str();
}

std::string differencesTable(const BatchResults& results) {
  std::vector<std::map<std::string, std::string>> values;
  std::map<std::string, bool> differs;
  for (const BatchConfiguration& configuration : results.configurations)
    values.push_back(valuesOf(configuration.config));
  for (const auto& one : values)
    for (const auto& [key, value] : one)
      differs[key] |= std::any_of(values.begin(), values.end(),
                                  [&, &key = key, &value = value](const auto& other) {
                                    const auto found = other.find(key);
                                    return found == other.end() || found->second != value;
                                  });
  HtmlTable table("Keys whose values are not the same in all settings.");
  std::vector<HeadCell> head{{"Key"}};
  for (const BatchConfiguration& configuration : results.configurations)
    head.push_back({escaped(configuration.name)});
  table.head(head);
  bool any = false;
  for (const auto& [key, different] : differs) {
    if (!different) continue;
    any = true;
    std::vector<std::string> cells{element("code", escaped(key))};
    for (const auto& one : values) {
      const auto found = one.find(key);
      cells.push_back(found == one.end() ? enDash : element("code", escaped(found->second)));
    }
    table.row(cells);
  }
  return any ? table.str("words") : "";
}

}  // namespace polemcl::report
