#include <algorithm>
#include <cmath>
#include <ostream>

#include "io/file/AtomicFile.h"
#include "io/file/TextFile.h"
#include "report/batch/BatchFiles.h"
#include "report/batch/RunMetrics.h"

namespace polemcl::report {
namespace {

constexpr int significantDigits = 9;

/// A field, in quotes where it needs them; one line, for readers that go line by line.
std::string field(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::replace(text.begin(), text.end(), '\r', ' ');
  const bool spaces = !text.empty() && (text.front() == ' ' || text.back() == ' ');
  if (!spaces && text.find_first_of(",\"#") == std::string::npos) return text;
  std::string quoted = "\"";
  for (char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

/// A number as text; empty when the value is not finite.
std::string field(double value) {
  return std::isfinite(value) ? io::significant(value, significantDigits) : "";
}

std::string place(const BatchResults& results, const SessionResult& result) {
  return field(results.configurations[result.configuration].name) + ',' +
         field(results.sessions[result.session].name);
}

void writeRun(std::ostream& out, const BatchRun& run, double lostBound) {
  out << ',' << run.run << ',' << run.seed << ',' << name(stateOf(run, lostBound)) << ','
      << field(run.failure);
  for (const MetricName& name : metricNames) out << ',' << field(run.errors.*name.figure);
  out << ',' << run.errors.poses << ',' << run.errors.unmatched;
  for (const ShareName& name : shareNames) out << ',' << field(run.health.*name.share);
  out << ',';
  if (run.health.firstPoseScan) out << *run.health.firstPoseScan;
  out << ',' << run.health.relocalizations << '\n';
}

void writeSession(std::ostream& out, const SessionSummary& summary) {
  out << ',' << field(summary.mapShare) << ',';
  if (summary.counts.runs > 0) out << summary.mapPoles;
  out << ',' << summary.counts.runs << ',' << summary.counts.lost << ',' << summary.counts.failed;
  const auto both = [&](const Spread& spread) {
    out << ',' << field(spread.mean) << ',' << field(spread.deviation);
  };
  for (const MetricName& name : metricNames) both(summary.figures.*name.spread);
  both(summary.figures.axisRmse);
  for (const ShareName& name : shareNames) out << ',' << field((summary.figures.*name.spread).mean);
  out << ',' << field(summary.relocalizations) << '\n';
}

}  // namespace

void writeRunsCsv(const std::filesystem::path& file, const BatchResults& results) {
  io::AtomicFile out(file);
  out.stream() << "setting,session,run,seed,state,reason";
  for (const MetricName& name : metricNames) out.stream() << ',' << name.key;
  out.stream() << ",poses,unmatched,ok_share,degraded_share,lost_share,first_pose_scan,"
                  "relocalizations\n";
  for (std::size_t i = 0; i < results.configurations.size(); ++i)
    for (std::size_t k = 0; k < results.sessions.size(); ++k)
      if (const SessionResult* result = results.find(i, k))
        for (const BatchRun& run : result->runs) {
          out.stream() << place(results, *result);
          writeRun(out.stream(), run, results.lostBound);
        }
  out.commit();
}

void writeMapsCsv(const std::filesystem::path& file, const BatchResults& results) {
  io::AtomicFile out(file);
  out.stream() << "setting,session,truth,map_poles,truth_poles";
  for (const ScoreName& name : scoreNames)
    for (const char* figure : {"precision", "recall", "f1", "matches"})
      out.stream() << ',' << name.key << '_' << figure;
  out.stream() << '\n';
  for (std::size_t i = 0; i < results.configurations.size(); ++i)
    for (std::size_t k = 0; k < results.sessions.size(); ++k) {
      const SessionResult* result = results.find(i, k);
      if (!result || !result->score) continue;
      const MapScores& scores = *result->score;
      out.stream() << place(results, *result) << ',' << field(scores.truth) << ','
                   << scores.near.mapPoles << ',' << scores.near.truthPoles;
      for (const ScoreName& name : scoreNames) {
        const MapScore& score = scores.*name.score;
        out.stream() << ',' << field(score.precision) << ',' << field(score.recall) << ','
                     << field(score.f1) << ',' << score.matches;
      }
      out.stream() << '\n';
    }
  out.commit();
}

void writeSessionsCsv(const std::filesystem::path& file, const BatchResults& results) {
  io::AtomicFile out(file);
  out.stream() << "setting,session,date,length_m,scans,f_map,map_poles,runs,lost,failed";
  for (const MetricName& name : metricNames)
    out.stream() << ',' << name.key << ',' << name.key << "_sd";
  out.stream() << ",axis_rmse,axis_rmse_sd,ok_share,degraded_share,lost_share,relocalizations\n";
  const Summaries summaries = summarize(results);
  for (std::size_t i = 0; i < summaries.size(); ++i)
    for (const SessionSummary& summary : summaries[i].sessions) {
      const BatchSession& session = results.sessions[summary.session];
      out.stream() << place(results, *results.find(i, summary.session)) << ','
                   << field(session.date) << ',' << field(session.length) << ',' << session.scans;
      writeSession(out.stream(), summary);
    }
  out.commit();
}

}  // namespace polemcl::report
