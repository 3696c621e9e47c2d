#include "eval/GlobalTrials.h"

#include <sstream>

#include "cli/JsonFile.h"
#include "cli/Progress.h"
#include "io/file/TextFile.h"

namespace polemcl::apps {

namespace {

using Outcome = GlobalTrial::Outcome;

GlobalTrial runGlobalTrial(const TrialDrive& drive, const std::vector<double>& driven,
                           std::size_t first, double metres, std::uint32_t seed) {
  GlobalTrial trial;
  trial.scan = first;
  LocalizationPipeline localization(drive.map, drive.settings.localization, seed);
  localization.initializeGlobally();
  std::size_t searches = 0;
  for (std::size_t i = first; i < drive.frames.size() && driven[i] - driven[first] <= metres; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    const LocalizationUpdate update = localization.step(drive.frames[i]);
    const double seconds = secondsSince(begin);
    if (localization.searches() > searches) trial.querySeconds.push_back(seconds);
    searches = localization.searches();
    if (!update.estimate || update.health.state == HealthState::lost) continue;
    const PlanarError error = errorOf(update.estimate->mean, drive.truth[i]);
    if (trial.outcome == Outcome::undecided && update.health.reason != HealthReason::ambiguous) {
      trial.outcome = isRight(error) ? Outcome::right : Outcome::wrong;
      trial.metres = driven[i] - driven[first];
      trial.error = error;
    }
    if (update.health.state != HealthState::ok) continue;
    if (!trial.okMetres) trial.okMetres = driven[i] - driven[first];
    trial.okWrong = trial.okWrong || !isRight(error);
  }
  return trial;
}

nlohmann::ordered_json globalSummary(const std::vector<GlobalTrial>& trials,
                                     const TrialDrive& drive) {
  std::vector<double> metres, errors;
  int counts[3] = {}, okWrong = 0;
  for (const GlobalTrial& trial : trials) {
    ++counts[static_cast<int>(trial.outcome)];
    okWrong += trial.okWrong;
    if (trial.outcome != Outcome::right) continue;
    metres.push_back(trial.metres);
    errors.push_back(trial.error.metres);
  }
  const auto all = static_cast<double>(trials.size());
  return {{"trials", trials.size()},
          {"map_poles", drive.map.poles->poles().size()},
          {"right", counts[0]},
          {"wrong", counts[1]},
          {"undecided", counts[2]},
          {"right_share", counts[0] / all},
          {"wrong_share", counts[1] / all},
          {"ok_wrong", okWrong},
          {"metres_median", rankedValue(metres, 0.5)},
          {"metres_p95", rankedValue(metres, 0.95)},
          {"metres_max", rankedValue(metres, 1)},
          {"error_median_m", rankedValue(errors, 0.5)},
          {"error_max_m", rankedValue(errors, 1)}};
}

nlohmann::ordered_json timings(const std::vector<GlobalTrial>& trials) {
  std::vector<double> seconds;
  for (const GlobalTrial& trial : trials)
    seconds.insert(seconds.end(), trial.querySeconds.begin(), trial.querySeconds.end());
  return {{"query_median_ms", 1e3 * rankedValue(seconds, 0.5)},
          {"query_max_ms", 1e3 * rankedValue(seconds, 1)}};
}

/// Timings lie apart, so that the figures are the same bytes each time.
void writeFigures(const std::filesystem::path& file, const nlohmann::ordered_json& figures,
                  const nlohmann::ordered_json& times) {
  writeJson(file, figures);
  const std::string beside = file.stem().string() + "_timings" + file.extension().string();
  writeJson(file.parent_path() / beside, times);
}

}  // namespace

std::vector<GlobalTrial> runGlobalTrials(const TrialDrive& drive,
                                         const RandomStartsOptions& options) {
  return runTrials(drive, options, runGlobalTrial);
}

std::string evalGlobal(const RandomStartsOptions& options) {
  const TrialDrive drive = loadTrialDrive(options.files);
  const auto trials = runGlobalTrials(drive, options);
  const auto json = globalSummary(trials, drive), times = timings(trials);
  if (options.json) writeFigures(*options.json, json, times);
  std::ostringstream out;
  out << trials.size() << " random starts, map of " << json["map_poles"] << " poles, "
      << io::fixed(options.metres, 0) << " m each\n"
      << "right " << json["right"] << ", wrong " << json["wrong"] << ", undecided "
      << json["undecided"] << "; ok said of a wrong pose: " << json["ok_wrong"] << '\n'
      << "found after " << io::fixed(json["metres_median"], 1)
      << " m (95 %: " << io::fixed(json["metres_p95"], 1) << " m), error then "
      << io::fixed(json["error_median_m"], 3) << " m, at most " << io::fixed(json["error_max_m"], 3)
      << " m\n"
      << "a step with a search: " << io::fixed(times["query_median_ms"], 1) << " ms, at most "
      << io::fixed(times["query_max_ms"], 1) << " ms\n";
  return out.str();
}

}  // namespace polemcl::apps
