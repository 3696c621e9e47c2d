#include "localize/LocalizeReport.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "cli/JsonFile.h"
#include "cli/SensorCounts.h"
#include "cli/Version.h"
#include "core/common/Angles.h"

namespace polemcl::apps {

namespace {

struct Spread {
  double mean = 0, deviation = 0, largest = 0;
};

/// The runs that found their pose.
std::vector<TrajectoryErrors> known(const LocalizeResult& result) {
  std::vector<TrajectoryErrors> errors;
  for (const auto& run : result.errors)
    if (run) errors.push_back(*run);
  return errors;
}

Spread spreadOf(const std::vector<TrajectoryErrors>& errors, double TrajectoryErrors::*figure) {
  Spread spread;
  for (const auto& run : errors) {
    spread.mean += run.*figure / static_cast<double>(errors.size());
    spread.largest = std::max(spread.largest, run.*figure);
  }
  if (errors.size() < 2) return spread;
  for (const auto& run : errors) spread.deviation += std::pow(run.*figure - spread.mean, 2);
  spread.deviation = std::sqrt(spread.deviation / static_cast<double>(errors.size() - 1));
  return spread;
}

/// How many scans were in each state, and from when on the pose was known.
Json healthSummary(const FilterRun& run) {
  Json json;
  for (const auto state : {HealthState::ok, HealthState::degraded, HealthState::lost})
    json[name(state)] = run.states[static_cast<int>(state)];
  json["first_pose_scan"] = run.firstPose;
  json["relocalizations"] = run.relocalizations;
  return json;
}

void printHealth(std::ostream& out, const LocalizeResult& result) {
  std::size_t all = 0, counts[3] = {}, unknown = 0;
  std::map<HealthReason, std::size_t> why;
  for (const auto& run : result.runs) {
    all += run.scans;
    unknown += !run.firstPose;
    for (int state = 0; state < 3; ++state) counts[state] += run.states[state];
    for (const auto& [reason, scans] : run.reasons) why[reason] += scans;
  }
  const auto percent = [all](std::size_t count) {
    return 100.0 * static_cast<double>(count) / static_cast<double>(all);
  };
  char line[200];
  std::snprintf(line, sizeof line, "health: %.1f %% ok, %.1f %% degraded, %.1f %% lost",
                percent(counts[0]), percent(counts[1]), percent(counts[2]));
  out << line;
  const char* before = " (";
  for (const auto& [reason, scans] : why) {
    std::snprintf(line, sizeof line, "%s%s %.1f %%", before, name(reason), percent(scans));
    out << line;
    before = ", ";
  }
  out << (why.empty() ? "\n" : ")\n");
  if (unknown > 0) out << unknown << " of " << result.runs.size() << " runs never found a pose\n";
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
  json["input"] = job.source().string();
  json["map"] = job.map.string();
  if (job.truth) json["truth"] = job.truth->string();
  json["scans"] = counts.scans;
  json["empty_scans"] = counts.emptyScans;
  json["invalid_points"] = counts.invalidPoints;
  json["truncated"] = counts.truncated;
  if (job.isLive()) {
    json["dropped_scans"] = counts.dropped;
    json["lost_packets"] = counts.lostPackets;
    json["ignored_packets"] = counts.ignoredPackets;
    json["scans_without_odometry"] = counts.unknownMotions;
  }
  json["odometry_jumps"] = counts.odometryJumps;
  if (!counts.lidars.empty()) json["lidars"] = lidarsJson(counts);
  json["poles_per_scan"] = static_cast<double>(counts.poles) / static_cast<double>(counts.scans);
  json["map_poles"] = facts.mapPoles;
  json["particles"] = facts.settings.localization.filter.particles;
  json["seed"] = facts.settings.runs.seed;
  if (const auto& area = facts.settings.start.area) {
    json["start"] = {
        {"x", area->centre_map.x()}, {"y", area->centre_map.y()}, {"radius_m", area->radius}};
  } else if (facts.settings.start.anywhere) {
    json["start"] = "anywhere";
  } else {
    const Pose2D& pose = *facts.settings.start.pose;
    json["start"] = {{"x", pose.x},
                     {"y", pose.y},
                     {"yaw_deg", pose.yaw / degree},
                     {"radius_m", facts.settings.start.radius},
                     {"heading_deg", facts.settings.start.heading / degree}};
  }
  json["start_source"] = facts.startSource;
  return json;
}

Json runSummary(const LocalizeResult& result, std::size_t i) {
  const FilterRun& run = result.runs[i];
  Json json;
  json["trajectory"] = runName(i) + ".tum";
  json["seed"] = run.seed;
  if (!result.errors.empty() && result.errors[i]) json.update(errorsJson(*result.errors[i]));
  json["resampled_scans"] = run.resampled;
  json["health"] = healthSummary(run);
  return json;
}

}  // namespace

std::string runName(std::size_t run) {
  const std::string number = std::to_string(run);
  return "run_" + std::string(number.size() < 2 ? 2 - number.size() : 0, '0') + number;
}

Json errorsJson(const TrajectoryErrors& errors) {
  Json json;
  for (const auto& [name, metric] : trajectoryMetrics) json[name] = errors.*metric;
  json["poses"] = errors.poses;
  json["unmatched"] = errors.unmatched;
  return json;
}

Json makeSummary(const LocalizeFacts& facts, const LocalizeResult& result) {
  Json json = inputs(facts);
  const std::vector<TrajectoryErrors> errors = known(result);
  if (!errors.empty()) {
    Json deviations;
    for (const auto& [name, metric] : trajectoryMetrics) {
      const Spread spread = spreadOf(errors, metric);
      json[name] = isLargest(name) ? spread.largest : spread.mean;
      deviations[name] = spread.deviation;
    }
    json["poses"] = errors[0].poses;  // the scans are the same in every run with a start pose
    json["unmatched"] = errors[0].unmatched;
    json["spread"] = deviations;
    json["ok_beyond_spread"] = result.spreadCheck.beyond;
  }
  json["runs_without_pose"] = std::count_if(result.runs.begin(), result.runs.end(),
                                            [](const FilterRun& run) { return !run.firstPose; });
  json["runs"] = Json::array();
  for (std::size_t i = 0; i < result.runs.size(); ++i)
    json["runs"].push_back(runSummary(result, i));
  return json;
}

void printTable(std::ostream& out, const LocalizeFacts& facts, const LocalizeResult& result) {
  const auto& counts = facts.counts;
  char line[200];
  std::snprintf(line, sizeof line,
                "%zu scans, %.1f poles per scan, map of %zu poles, %zu runs of %d particles\n",
                counts.scans, static_cast<double>(counts.poles) / static_cast<double>(counts.scans),
                facts.mapPoles, result.runs.size(), facts.settings.localization.filter.particles);
  out << line;
  if (counts.truncated) out << "the rawlog is truncated: only its readable part was used\n";
  if (facts.job.isLive())
    out << counts.dropped << " scans dropped, " << counts.unknownMotions
        << " left out without odometry, " << counts.lostPackets << " packets lost\n";
  if (counts.odometryJumps)
    out << counts.odometryJumps << " jumps of the odometry, bridged by the motion before\n";
  if (counts.emptyScans) out << counts.emptyScans << " scans without a valid point\n";
  if (counts.invalidPoints) out << counts.invalidPoints << " invalid points left out\n";
  printSensors(out, counts);
  printHealth(out, result);
  const std::vector<TrajectoryErrors> errors = known(result);
  if (errors.empty()) return;
  out << "run       pos_mean  pos_rmse  lat_mean  lon_mean  ang_mean_deg  ang_rmse_deg  pos_max\n";
  const auto row = [&](const std::string& name, const auto& value) {
    std::snprintf(line, sizeof line, "%-8s  %8.4f  %8.4f  %8.4f  %8.4f  %12.4f  %12.4f  %7.3f\n",
                  name.c_str(), value(0), value(1), value(2), value(3), value(4), value(5),
                  value(6));
    out << line;
  };
  const auto spread = [&](int k) { return spreadOf(errors, trajectoryMetrics[k].second); };
  for (std::size_t i = 0; i < result.errors.size(); ++i)
    if (result.errors[i])
      row(runName(i), [&](int k) { return (*result.errors[i]).*trajectoryMetrics[k].second; });
  if (errors.size() < 2) return;
  row("mean", [&](int k) { return spread(k).mean; });
  row("spread", [&](int k) { return spread(k).deviation; });
}

}  // namespace polemcl::apps
