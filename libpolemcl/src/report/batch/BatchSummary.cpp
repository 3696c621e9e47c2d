#include <algorithm>
#include <cmath>

#include "report/batch/RunMetrics.h"

namespace polemcl::report {
namespace {

void count(RunCounts& counts, RunState state) {
  ++counts.runs;
  counts.lost += state == RunState::lost;
  counts.failed += state == RunState::failed;
}

/// The values of all runs that have a result.
template <typename Value>
Spread spreadOver(const std::vector<BatchRun>& runs, const Value& value) {
  std::vector<double> values;
  for (const BatchRun& run : runs)
    if (run.failure.empty()) values.push_back(value(run));
  return spreadOf(values);
}

SessionSummary summaryOf(const SessionResult& result, double lostBound) {
  SessionSummary summary;
  summary.session = result.session;
  summary.mapShare = result.mapShare;
  summary.mapPoles = result.mapPoles;
  for (const BatchRun& run : result.runs) count(summary.counts, stateOf(run, lostBound));
  const auto over = [&](const auto& value) { return spreadOver(result.runs, value); };
  for (const MetricName& name : metricNames)
    summary.figures.*name.spread =
        over([&](const BatchRun& run) { return run.errors.*name.figure; });
  for (const ShareName& name : shareNames)
    summary.figures.*name.spread =
        over([&](const BatchRun& run) { return run.health.*name.share; });
  summary.figures.axisRmse = over([](const BatchRun& run) { return axisRmse(run.errors); });
  summary.relocalizations =
      over([](const BatchRun& run) { return double(run.health.relocalizations); }).mean;
  return summary;
}

void sumUpScores(ConfigurationSummary& configuration, const BatchResults& results,
                 std::size_t index) {
  for (const ScoreName& name : scoreNames) {
    std::vector<double> precision, recall, f1;
    for (std::size_t k = 0; k < results.sessions.size(); ++k) {
      const SessionResult* result = results.find(index, k);
      if (!result || !result->score) continue;
      const MapScore& one = (*result->score).*name.score;
      precision.push_back(one.precision);
      recall.push_back(one.recall);
      f1.push_back(one.f1);
    }
    configuration.scores.maps = f1.size();
    configuration.scores.*
        name.means = {spreadOf(precision).mean, spreadOf(recall).mean, spreadOf(f1).mean};
  }
}

Spread overSessions(const std::vector<SessionSummary>& sessions, Spread MetricSpreads::*figure) {
  std::vector<double> means, largest;
  for (const SessionSummary& session : sessions) {
    means.push_back((session.figures.*figure).mean);
    largest.push_back((session.figures.*figure).largest);
  }
  Spread spread = spreadOf(means);
  spread.largest = spreadOf(largest).largest;
  return spread;
}

void sumUp(ConfigurationSummary& configuration) {
  std::vector<double> shares, means;
  const bool localizes =
      std::any_of(configuration.sessions.begin(), configuration.sessions.end(),
                  [](const SessionSummary& session) { return session.counts.runs > 0; });
  for (const SessionSummary& session : configuration.sessions) {
    const RunCounts& counts = session.counts;
    configuration.counts.runs += counts.runs;
    configuration.counts.lost += counts.lost;
    configuration.counts.failed += counts.failed;
    configuration.lostSessions += counts.runs > 0 && counts.lost + counts.failed == counts.runs;
    if (!localizes || counts.runs > 0) shares.push_back(session.mapShare);
    if (session.figures.posMean.count > 0) means.push_back(session.figures.posMean.mean);
  }
  configuration.localized = means.size();
  for (const MetricName& name : metricNames)
    configuration.figures.*name.spread = overSessions(configuration.sessions, name.spread);
  for (const ShareName& name : shareNames)
    configuration.figures.*name.spread = overSessions(configuration.sessions, name.spread);
  configuration.figures.axisRmse = overSessions(configuration.sessions, &MetricSpreads::axisRmse);
  configuration.mapShare = spreadOf(shares);
  if (means.size() > 1 && means.front() > 0)
    configuration.lastOverFirst = means.back() / means.front();
}

}  // namespace

double axisRmse(const ErrorMetrics& errors) {
  return std::sqrt((errors.xRmse * errors.xRmse + errors.yRmse * errors.yRmse) / 2);
}

Spread spreadOf(const std::vector<double>& values) {
  Spread spread;
  double sum = 0, squares = 0;
  for (double value : values) {
    if (!std::isfinite(value)) continue;
    ++spread.count;
    sum += value;
    spread.largest = spread.count == 1 ? value : std::max(spread.largest, value);
  }
  if (spread.count == 0) return spread;
  spread.mean = sum / static_cast<double>(spread.count);
  if (spread.count < 2) return spread;
  for (double value : values)
    if (std::isfinite(value)) squares += (value - spread.mean) * (value - spread.mean);
  spread.deviation = std::sqrt(squares / static_cast<double>(spread.count - 1));
  return spread;
}

const char* name(RunState state) {
  return state == RunState::ok ? "ok" : state == RunState::lost ? "lost" : "failed";
}

RunState stateOf(const BatchRun& run, double lostBound) {
  if (!run.failure.empty()) return RunState::failed;
  const ErrorMetrics& errors = run.errors;
  const bool known = errors.poses > 0 && std::isfinite(errors.posMean);
  return !known || errors.posMean > lostBound || errors.posEnd > lostBound ? RunState::lost
                                                                           : RunState::ok;
}

Summaries summarize(const BatchResults& results) {
  Summaries summaries(results.configurations.size());
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    for (std::size_t k = 0; k < results.sessions.size(); ++k)
      if (const SessionResult* result = results.find(i, k))
        summaries[i].sessions.push_back(summaryOf(*result, results.lostBound));
    sumUp(summaries[i]);
    sumUpScores(summaries[i], results, i);
  }
  return summaries;
}

}  // namespace polemcl::report
