#include "eval/StartTrials.h"

#include <cmath>
#include <random>
#include <sstream>

#include "cli/JsonFile.h"
#include "core/common/Angles.h"
#include "io/file/TextFile.h"

namespace polemcl::apps {

namespace {

/// A pose of which the true one is as far as `[start]` allows.
StartOptions startNear(const Pose2D& truth, const StartOptions& settings, std::uint32_t seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  const double distance = settings.radius * std::sqrt(uniform(0, 1));
  const double direction = uniform(-M_PI, M_PI);
  StartOptions start = settings;
  start.pose = {truth.x + distance * std::cos(direction), truth.y + distance * std::sin(direction),
                wrapAngle(truth.yaw + uniform(-settings.heading, settings.heading))};
  return start;
}

StartTrial runStartTrial(const TrialDrive& drive, const std::vector<double>& driven,
                         std::size_t first, double metres, std::uint32_t seed) {
  StartTrial trial;
  trial.scan = first;
  LocalizationPipeline localization(drive.map, drive.settings.localization, seed);
  localization.start(startNear(drive.truth[first], drive.settings.start, seed));
  std::size_t i = first;
  double sum = 0;
  for (; i < drive.frames.size() && driven[i] - driven[first] <= metres; ++i) {
    const LocalizationUpdate update = localization.step(drive.frames[i]);
    // A start within a disc always leaves an estimate.
    const PlanarError error = errorOf(update.estimate.value().mean, drive.truth[i]);
    const bool right = isRight(error), ok = update.health.state == HealthState::ok;
    sum += error.metres;
    trial.endError = error.metres;
    if (!right) trial.rightMetres.reset();
    if (right && !trial.rightMetres) trial.rightMetres = driven[i] - driven[first];
    if (ok && !trial.okMetres) trial.okMetres = driven[i] - driven[first];
    trial.okWrong = trial.okWrong || (ok && !right);
  }
  trial.meanError = sum / static_cast<double>(i - first);
  return trial;
}

nlohmann::ordered_json startSummary(const std::vector<StartTrial>& trials,
                                    const TrialDrive& drive) {
  std::vector<double> right, ok, ends;
  double mean = 0;
  int okWrong = 0;
  for (const StartTrial& trial : trials) {
    if (trial.rightMetres) right.push_back(*trial.rightMetres);
    if (trial.okMetres) ok.push_back(*trial.okMetres);
    ends.push_back(trial.endError);
    mean += trial.meanError;
    okWrong += trial.okWrong;
  }
  const auto all = static_cast<double>(trials.size());
  return {{"trials", trials.size()},
          {"map_poles", drive.map.poles->poles().size()},
          {"right", right.size()},
          {"right_share", static_cast<double>(right.size()) / all},
          {"ok_wrong", okWrong},
          {"mean_m", mean / all},
          {"end_median_m", rankedValue(ends, 0.5)},
          {"right_metres_median", rankedValue(right, 0.5)},
          {"right_metres_p95", rankedValue(right, 0.95)},
          {"right_metres_max", rankedValue(right, 1)},
          {"ok_metres_median", rankedValue(ok, 0.5)}};
}

}  // namespace

std::vector<StartTrial> runStartTrials(const TrialDrive& drive,
                                       const RandomStartsOptions& options) {
  return runTrials(drive, options, runStartTrial);
}

std::string evalStarts(const RandomStartsOptions& options) {
  const TrialDrive drive = loadTrialDrive(options.files);
  const auto json = startSummary(runStartTrials(drive, options), drive);
  if (options.json) writeJson(*options.json, json);
  std::ostringstream out;
  out << json["trials"] << " starts known roughly, map of " << json["map_poles"] << " poles, "
      << io::fixed(options.metres, 0) << " m each\n"
      << "right at the end " << json["right"] << "; ok said of a wrong pose: " << json["ok_wrong"]
      << '\n'
      << "right for good after " << io::fixed(json["right_metres_median"], 1)
      << " m (95 %: " << io::fixed(json["right_metres_p95"], 1) << " m, at most "
      << io::fixed(json["right_metres_max"], 1) << " m), ok after "
      << io::fixed(json["ok_metres_median"], 1) << " m\n"
      << "mean error " << io::fixed(json["mean_m"], 4) << " m, at the end "
      << io::fixed(json["end_median_m"], 4) << " m (median)\n";
  return out.str();
}

}  // namespace polemcl::apps
