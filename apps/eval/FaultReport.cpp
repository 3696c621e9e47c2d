#include <algorithm>
#include <cstdio>
#include <sstream>

#include "cli/JsonFile.h"
#include "eval/FaultTrials.h"
#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace {

Json delays(const std::vector<FaultTrial>& trials, std::optional<Delay> FaultTrial::*which) {
  std::vector<double> seconds, metres;
  for (const FaultTrial& trial : trials) {
    if (!(trial.*which)) continue;
    seconds.push_back((trial.*which)->seconds);
    metres.push_back((trial.*which)->metres);
  }
  return {{"trials", seconds.size()},
          {"median_s", rankedValue(seconds, 0.5)},
          {"p95_s", rankedValue(seconds, 0.95)},
          {"max_s", rankedValue(seconds, 1)},
          {"median_m", rankedValue(metres, 0.5)},
          {"p95_m", rankedValue(metres, 0.95)},
          {"max_m", rankedValue(metres, 1)}};
}

Json delayOf(const std::optional<Delay>& delay) {
  if (!delay) return nullptr;
  return {{"s", delay->seconds}, {"m", delay->metres}};
}

Json failed(const std::vector<FaultTrial>& trials) {
  Json list = Json::array();
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const FaultTrial& trial = trials[i];
    if (trial.passed) continue;
    list.push_back({{"trial", i},
                    {"scan", trial.scan},
                    {"jump_m", trial.jump},
                    {"ok_before", trial.okBefore},
                    {"degraded", delayOf(trial.degraded)},
                    {"lost", delayOf(trial.lost)},
                    {"right", delayOf(trial.right)},
                    {"ok", delayOf(trial.ok)},
                    {"ok_wrong_m", trial.okWrongMetres}});
  }
  return list;
}

Json summary(const std::vector<FaultTrial>& trials, const FaultTrialsOptions& options) {
  std::vector<double> errors, wrong, largest;
  std::size_t passed = 0, okBefore = 0;
  for (const FaultTrial& trial : trials) {
    passed += trial.passed;
    okBefore += trial.okBefore;
    if (trial.ok) errors.push_back(trial.errorAfter);
    wrong.push_back(trial.okWrongMetres);
    largest.push_back(trial.errorMax);
  }
  Json json{{"fault", name(options.fault.fault)},
            {"trials", trials.size()},
            {"seed", options.seed},
            {"passed", passed},
            {"passed_share", static_cast<double>(passed) / static_cast<double>(trials.size())},
            {"ok_before", okBefore}};
  json["degraded"] = delays(trials, &FaultTrial::degraded);
  json["lost"] = delays(trials, &FaultTrial::lost);
  json["right"] = delays(trials, &FaultTrial::right);
  json["ok"] = delays(trials, &FaultTrial::ok);
  json["error_after_median_m"] = rankedValue(errors, 0.5);
  json["error_after_max_m"] = rankedValue(errors, 1);
  json["error_largest_median_m"] = rankedValue(largest, 0.5);
  json["ok_wrong_median_m"] = rankedValue(wrong, 0.5);
  json["ok_wrong_max_m"] = rankedValue(wrong, 1);
  std::map<std::string, int> reasons;
  for (const FaultTrial& trial : trials)
    if (trial.lost) ++reasons[trial.lostReason];
  json["lost_reasons"] = reasons;
  json["failed"] = failed(trials);
  return json;
}

std::string shown(const Json& json, const char* what) {
  char line[200];
  const auto number = [&](const char* key) { return json[key].get<double>(); };
  std::snprintf(line, sizeof line, "%-9s %6zu %8.1f %8.1f %8.1f %8.1f %8.1f %8.1f\n", what,
                json["trials"].get<std::size_t>(), number("median_s"), number("p95_s"),
                number("max_s"), number("median_m"), number("p95_m"), number("max_m"));
  return line;
}

std::string table(const Json& json) {
  const auto number = [&](const char* key, int decimals) {
    return io::fixed(json[key].get<double>(), decimals);
  };
  std::ostringstream out;
  out << "fault " << json["fault"].get<std::string>() << ": " << json["passed"] << " of "
      << json["trials"] << " as demanded; ok before the fault: " << json["ok_before"] << '\n'
      << "          trials median s    95 %s    max s median m    95 %m    max m\n"
      << shown(json["degraded"], "degraded") << shown(json["lost"], "lost")
      << shown(json["right"], "right") << shown(json["ok"], "ok")
      << "degraded and lost since the fault began, right and ok since it ended; lost first for "
      << json["lost_reasons"].dump() << '\n'
      << "mean error over 20 m after ok: median " << number("error_after_median_m", 3)
      << " m, worst " << number("error_after_max_m", 3) << " m; ok said of a wrong pose over "
      << number("ok_wrong_median_m", 1) << " m in the median, " << number("ok_wrong_max_m", 1)
      << " m at most\n";
  return out.str();
}

Json summary(const std::vector<HealthyRun>& runs, const FaultTrialsOptions& options) {
  HealthyRun all;
  for (const HealthyRun& run : runs) {
    all.seconds += run.seconds;
    all.metres += run.metres;
    all.scans += run.scans;
    all.ok += run.ok;
    all.degraded += run.degraded;
    all.lost += run.lost;
    all.lostTimes += run.lostTimes;
    all.degradedTimes += run.degradedTimes;
    all.longestSeconds = std::max(all.longestSeconds, run.longestSeconds);
    for (const auto& [reason, scans] : run.reasons) all.reasons[reason] += scans;
    all.errorSum += run.errorSum;
    all.errorMax = std::max(all.errorMax, run.errorMax);
    all.wrongOk += run.wrongOk;
    all.relocalized += run.relocalized;
    all.lostBefore += run.lostBefore;
  }
  const auto scans = static_cast<double>(all.scans);
  return {{"fault", "none"},
          {"runs", runs.size()},
          {"seed", options.seed},
          {"hours", all.seconds / 3600},
          {"kilometres", all.metres / 1000},
          {"scans", all.scans},
          {"ok_share", static_cast<double>(all.ok) / scans},
          {"lost_times", all.lostTimes},
          {"lost_scans", all.lost},
          {"lost_scans_before_ok", all.lostBefore},
          {"degraded_times", all.degradedTimes},
          {"degraded_scans", all.degraded},
          {"longest_not_ok_s", all.longestSeconds},
          {"reasons", all.reasons},
          {"relocalized", all.relocalized},
          {"ok_with_wrong_pose", all.wrongOk},
          {"error_mean_m", all.errorSum / scans},
          {"error_max_m", all.errorMax}};
}

std::string healthyTable(const Json& json) {
  std::ostringstream out;
  out << "no fault: " << json["runs"] << " runs, " << io::fixed(json["hours"], 2) << " h, "
      << io::fixed(json["kilometres"], 1) << " km, " << json["scans"]
      << " scans since the first ok\n"
      << "lost " << json["lost_times"] << " times (" << json["lost_scans"] << " scans), degraded "
      << json["degraded_times"] << " times (" << json["degraded_scans"] << " scans), ok "
      << io::fixed(100 * json["ok_share"].get<double>(), 3) << " %, longest not ok "
      << io::fixed(json["longest_not_ok_s"], 1) << " s\n"
      << "reasons " << json["reasons"].dump() << ", relocalized " << json["relocalized"]
      << ", ok with a wrong pose " << json["ok_with_wrong_pose"] << " scans\n"
      << "position error mean " << io::fixed(json["error_mean_m"], 4) << ", greatest "
      << io::fixed(json["error_max_m"], 3) << " m\n";
  return out.str();
}

}  // namespace

std::string evalFaults(const FaultTrialsOptions& options) {
  const TrialDrive drive = loadTrialDrive(options.files);
  const bool healthy = options.fault.fault == Fault::none;
  const Json json = healthy ? summary(runHealthy(drive, options), options)
                            : summary(runFaultTrials(drive, options), options);
  if (options.json) writeJson(*options.json, json);
  return healthy ? healthyTable(json) : table(json);
}

}  // namespace polemcl::apps
