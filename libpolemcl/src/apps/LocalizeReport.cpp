#include <polemcl/apps/LocalizeReport.h>
#include <polemcl/apps/Version.h>
#include <polemcl/io/AtomicFile.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace polemcl::apps {

using Json = nlohmann::ordered_json;

namespace {

constexpr double degree = M_PI / 180;

/// Figures that are averaged over the runs, by the names of `pole-eval trajectory`.
const std::pair<const char*, double TrajectoryErrors::*> figures[] = {
    {"pos_mean", &TrajectoryErrors::posMean},
    {"pos_rmse", &TrajectoryErrors::posRmse},
    {"lat_mean", &TrajectoryErrors::latMean},
    {"lon_mean", &TrajectoryErrors::lonMean},
    {"ang_mean_deg", &TrajectoryErrors::angMeanDeg},
    {"ang_rmse_deg", &TrajectoryErrors::angRmseDeg},
    {"pos_max", &TrajectoryErrors::posMax}};

struct Spread {
  double mean = 0, deviation = 0, largest = 0;
};

Spread spreadOf(const std::vector<TrajectoryErrors>& errors, double TrajectoryErrors::*figure) {
  Spread spread;
  for (const auto& run : errors) {
    spread.mean += run.*figure / errors.size();
    spread.largest = std::max(spread.largest, run.*figure);
  }
  if (errors.size() < 2) return spread;
  for (const auto& run : errors) spread.deviation += std::pow(run.*figure - spread.mean, 2);
  spread.deviation = std::sqrt(spread.deviation / (errors.size() - 1));
  return spread;
}

bool isLargest(const char* name) {
  return std::string(name) == "pos_max";
}

Json inputs(const LocalizeFacts& facts) {
  const auto& job = facts.job;
  const auto& counts = facts.counts;
  Json json;
  json["program"] = "pole-localize";
  json["version"] = version();
  json["config"] = job.config.string();
  json["input"] = job.input.string();
  json["map"] = job.map.string();
  if (job.truth) json["truth"] = job.truth->string();
  json["scans"] = counts.scans;
  json["empty_scans"] = counts.emptyScans;
  json["invalid_points"] = counts.invalidPoints;
  json["truncated"] = counts.truncated;
  json["poles_per_scan"] = double(counts.poles) / counts.scans;
  json["map_poles"] = facts.mapPoles;
  json["particles"] = facts.filter.particles;
  json["seed"] = facts.runs.seed;
  const Pose2D& pose = *facts.start.pose;
  json["start"] = {{"x", pose.x},
                   {"y", pose.y},
                   {"yaw_deg", pose.yaw / degree},
                   {"radius_m", facts.start.radius},
                   {"heading_deg", facts.start.heading / degree}};
  return json;
}

Json runSummary(const LocalizeResult& result, std::size_t i) {
  const FilterRun& run = result.runs[i];
  Json json;
  json["trajectory"] = runName(i) + ".tum";
  json["seed"] = run.seed;
  if (!result.errors.empty()) {
    for (const auto& [name, figure] : figures) json[name] = result.errors[i].*figure;
    json["poses"] = result.errors[i].poses;
    json["unmatched"] = result.errors[i].unmatched;
  }
  const auto resampled = [](const StepReport& step) { return step.resampled; };
  json["resampled_scans"] = std::count_if(run.steps.begin(), run.steps.end(), resampled);
  return json;
}

}  // namespace

std::string runName(std::size_t run) {
  const std::string number = std::to_string(run);
  return "run_" + std::string(number.size() < 2 ? 2 - number.size() : 0, '0') + number;
}

Json makeSummary(const LocalizeFacts& facts, const LocalizeResult& result) {
  Json json = inputs(facts);
  if (!result.errors.empty()) {
    Json deviations;
    for (const auto& [name, figure] : figures) {
      const Spread spread = spreadOf(result.errors, figure);
      json[name] = isLargest(name) ? spread.largest : spread.mean;
      deviations[name] = spread.deviation;
    }
    json["poses"] = result.errors[0].poses;  // the scans are the same in every run
    json["unmatched"] = result.errors[0].unmatched;
    json["spread"] = deviations;
  }
  json["runs"] = Json::array();
  for (std::size_t i = 0; i < result.runs.size(); ++i)
    json["runs"].push_back(runSummary(result, i));
  return json;
}

void writeErrorsCsv(const std::filesystem::path& file, const FilterRun& run,
                    const TrajectoryErrors& errors) {
  io::AtomicFile output(file);
  output.stream() << "scan,timestamp,position_m,lateral_m,longitudinal_m,heading_deg,poles,"
                     "effective_share\n";
  std::size_t scan = 0;
  for (const PoseError& error : errors.errors) {
    while (run.trajectory[scan].time < error.time) ++scan;
    const StepReport& step = run.steps[scan];
    char line[200];
    std::snprintf(line, sizeof line, "%zu,%.9f,%.6f,%.6f,%.6f,%.6f,%zu,%.6f\n", scan, error.time,
                  error.position, error.lateral, error.longitudinal, error.heading / degree,
                  step.poles, step.effectiveShare);
    output.stream() << line;
  }
  output.commit();
}

void printTable(std::ostream& out, const LocalizeFacts& facts, const LocalizeResult& result) {
  const auto& counts = facts.counts;
  char line[200];
  std::snprintf(line, sizeof line,
                "%zu scans, %.1f poles per scan, map of %zu poles, %zu runs of %d particles\n",
                counts.scans, double(counts.poles) / counts.scans, facts.mapPoles,
                result.runs.size(), facts.filter.particles);
  out << line;
  if (counts.truncated) out << "the rawlog is truncated: only its readable part was used\n";
  if (counts.emptyScans) out << counts.emptyScans << " scans without a valid point\n";
  if (counts.invalidPoints) out << counts.invalidPoints << " invalid points left out\n";
  if (result.errors.empty()) return;
  out << "run       pos_mean  pos_rmse  lat_mean  lon_mean  ang_mean_deg  ang_rmse_deg  pos_max\n";
  const auto row = [&](const std::string& name, const auto& value) {
    std::snprintf(line, sizeof line, "%-8s  %8.4f  %8.4f  %8.4f  %8.4f  %12.4f  %12.4f  %7.3f\n",
                  name.c_str(), value(0), value(1), value(2), value(3), value(4), value(5),
                  value(6));
    out << line;
  };
  const auto spread = [&](int k) { return spreadOf(result.errors, figures[k].second); };
  for (std::size_t i = 0; i < result.errors.size(); ++i)
    row(runName(i), [&](int k) { return result.errors[i].*figures[k].second; });
  row("mean", [&](int k) { return spread(k).mean; });
  row("spread", [&](int k) { return spread(k).deviation; });
}

}  // namespace polemcl::apps
