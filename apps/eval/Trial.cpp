#include "eval/Trial.h"

#include <algorithm>
#include <cmath>

#include "cli/Progress.h"
#include "core/common/Angles.h"
#include "core/evaluation/Consistency.h"
#include "eval/DriveTruth.h"
#include "localize/LocalizeApp.h"

namespace polemcl::apps {
namespace {

constexpr double kStays = 5;    // path over which a pose must be right to count as found, m
constexpr double kJudged = 20;  // path after `ok` over which the error is averaged, m

using Scans = std::vector<TrialScan>;

bool isOk(const TrialScan& scan) {
  return scan.state == HealthState::ok;
}
bool isLost(const TrialScan& scan) {
  return scan.state == HealthState::lost;
}
bool isSaid(const TrialScan& scan) {
  return !isLost(scan) && scan.reason != HealthReason::ambiguous &&
         std::isfinite(scan.error.metres);
}

/// The first scan from `from` on of which something holds; the number of scans without one.
template <class Holds>
std::size_t firstScan(const Scans& scans, std::size_t from, const Holds& holds) {
  return static_cast<std::size_t>(
      std::find_if(scans.begin() + static_cast<std::ptrdiff_t>(std::min(from, scans.size())),
                   scans.end(), holds) -
      scans.begin());
}

std::optional<Delay> delayOf(const Scans& scans, std::size_t from, std::size_t to) {
  if (to >= scans.size()) return std::nullopt;
  return Delay{scans[to].time - scans[from].time, scans[to].driven - scans[from].driven};
}

template <class Holds>
std::optional<Delay> delayUntil(const Scans& scans, std::size_t from, const Holds& holds) {
  return delayOf(scans, from, firstScan(scans, from, holds));
}

/// The pose is right over a distance from a scan on, or to the end.
bool staysRight(const Scans& scans, const TrialScan& scan, double metres) {
  for (const TrialScan* next = &scan; next <= &scans.back() && next->driven - scan.driven <= metres;
       ++next)
    if (!next->error.isRight()) return false;
  return true;
}

/// The first scan from `from` on after which the pose is never wrong.
std::size_t firstOfRightEnd(const Scans& scans, std::size_t from) {
  std::size_t first = scans.size();
  while (first > from && scans[first - 1].error.isRight()) --first;
  return first;
}

double meanError(const Scans& scans, double from, double to) {
  double sum = 0;
  std::size_t count = 0;
  for (const TrialScan& scan : scans) {
    if (scan.driven < from || scan.driven > to) continue;
    sum += scan.error.metres;
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

/// Longest time in a row `ok` beyond five standard deviations, s.
double longestBeyond(const Scans& scans, std::size_t from) {
  LongestTime longest;
  for (std::size_t i = from; i < scans.size(); ++i)
    longest.add(scans[i].time, isOk(scans[i]) && !(scans[i].sigmas <= 5));
  return longest.seconds();
}

HealthCounts countHealth(const Trial& trial, const Scans& scans) {
  HealthCounts run;
  const std::size_t first = firstScan(scans, 0, isOk);
  run.lostBefore = static_cast<std::size_t>(
      std::count_if(scans.begin(), scans.begin() + static_cast<std::ptrdiff_t>(first), isLost));
  run.okBeyondSeconds = longestBeyond(scans, first);
  double okTime = 0;
  HealthState last = HealthState::ok;
  for (std::size_t i = first; i < scans.size(); ++i) {
    const TrialScan& scan = scans[i];
    if (i > first) {
      run.seconds += scan.time - scans[i - 1].time;
      run.metres += errorOf(trial.truth[i], trial.truth[i - 1]).metres;
    }
    ++run.scans;
    run.errorSum += scan.error.metres;
    run.errorMax = std::max(run.errorMax, scan.error.metres);
    run.relocalized += scan.relocalized;
    if (isOk(scan)) {
      ++run.ok;
      run.wrongOk += !scan.error.isRight();
      okTime = scan.time;
    } else {
      ++run.reasons[name(scan.reason)];
      run.longestSeconds = std::max(run.longestSeconds, scan.time - okTime);
    }
    run.lost += isLost(scan);
    run.degraded += scan.state == HealthState::degraded;
    run.lostTimes += isLost(scan) && last != HealthState::lost;
    run.degradedTimes += scan.state == HealthState::degraded && last == HealthState::ok;
    last = scan.state;
  }
  return run;
}

void judgeSinceBegin(const Scans& scans, std::size_t begin, TrialOutcome& outcome) {
  const auto notOk = [](const TrialScan& scan) { return !isOk(scan); };
  outcome.okBefore = begin > 0 && isOk(scans[begin - 1]);
  outcome.degraded = delayUntil(scans, begin, notOk);
  const std::size_t lost = firstScan(scans, begin, isLost);
  outcome.lost = delayOf(scans, begin, lost);
  if (outcome.lost) outcome.lostReason = name(scans[lost].reason);
  const std::size_t said = firstScan(scans, begin, isSaid);
  outcome.said = delayOf(scans, begin, said);
  if (outcome.said) outcome.saidError = scans[said].error;
  outcome.saidOk = delayUntil(scans, begin, isOk);
  for (std::size_t i = begin; i < scans.size(); ++i) {
    const TrialScan& scan = scans[i];
    if (std::isfinite(scan.error.metres))
      outcome.errorMax = std::max(outcome.errorMax, scan.error.metres);
    if (!isOk(scan) || scan.error.isRight()) continue;
    outcome.okWrong = true;
    if (i > begin) outcome.okWrongMetres += scan.driven - scans[i - 1].driven;
  }
  outcome.okBeyondSeconds = longestBeyond(scans, begin);
}

void judgeSinceEnd(const Scans& scans, std::size_t end, TrialOutcome& outcome) {
  outcome.right = delayUntil(
      scans, end, [&](const TrialScan& scan) { return staysRight(scans, scan, kStays); });
  outcome.rightForGood = delayOf(scans, end, firstOfRightEnd(scans, end));
  outcome.ok = delayUntil(scans, end,
                          [](const TrialScan& scan) { return isOk(scan) && scan.error.isRight(); });
  if (!outcome.ok) return;
  const double since = scans[end].driven + outcome.ok->metres;
  outcome.errorAfter = meanError(scans, since, since + kJudged);
}

}  // namespace

TrialDrive loadTrialDrive(const TrialDriveFiles& files) {
  const AllSettings settings = loadSettings(files.config.string(), files.set);
  TrialDrive drive{settings,
                   LocalizationMap(loadPoleMap(files.map, settings.likelihood)),
                   readPoleSequence(files.input.string(), settings.reading()).frames,
                   {},
                   {}};
  const DriveTruth truth(files.truth, files.input);
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    const PoleScan& frame = drive.frames[i];
    if (i > 0 && !frame.motion)
      throw Error(files.input.string() + ": no odometry before scan " + std::to_string(i) +
                  ": the filter needs it");
    drive.truth.push_back(truth.at(frame.time, i));
    drive.driven.push_back(
        i > 0 ? drive.driven[i - 1] + errorOf(drive.truth[i], drive.truth[i - 1]).metres : 0);
  }
  return drive;
}

bool PlanarError::isRight() const {
  return metres <= 0.5 && radians <= 2 * degree;
}

PlanarError errorOf(const Pose2D& estimate, const Pose2D& truth) {
  return {std::hypot(estimate.x - truth.x, estimate.y - truth.y),
          std::abs(wrapAngle(estimate.yaw - truth.yaw))};
}

Trial stretchOf(const TrialDrive& drive, std::size_t first, std::size_t end) {
  Trial trial;
  trial.origin = first;
  for (std::size_t i = first; i < end; ++i) {
    trial.frames.push_back(drive.frames[i]);
    trial.truth.push_back(drive.truth[i]);
    trial.driven.push_back(drive.driven[i] - drive.driven[first]);
  }
  return trial;
}

std::vector<TrialScan> record(const Trial& trial, const Settings& settings,
                              const LocalizationMap& map, std::uint32_t seed) {
  Localizer localizer(settings, map, seed);
  if (trial.start)
    localizer.start(*trial.start);
  else
    localizer.startAnywhere();
  Scans scans;
  std::size_t searches = 0;
  for (std::size_t i = 0; i < trial.frames.size(); ++i) {
    const auto begin = ScanClock::now();
    const LocalizationUpdate update = localizer.step(trial.frames[i]);
    const double seconds = secondsSince(begin);
    TrialScan scan{update.time,         trial.driven[i],      {INFINITY, INFINITY}, INFINITY,
                   update.health.state, update.health.reason, update.relocalized,   std::nullopt};
    if (update.estimate) {
      scan.error = errorOf(update.estimate->mean, trial.truth[i]);
      scan.sigmas = sigmasOfPosition(*update.estimate, trial.truth[i]);
    }
    if (localizer.pipeline().searches() > searches) scan.searchSeconds = seconds;
    searches = localizer.pipeline().searches();
    scans.push_back(scan);
  }
  return scans;
}

void HealthCounts::add(const HealthCounts& run) {
  seconds += run.seconds;
  metres += run.metres;
  scans += run.scans;
  ok += run.ok;
  degraded += run.degraded;
  lost += run.lost;
  lostTimes += run.lostTimes;
  degradedTimes += run.degradedTimes;
  longestSeconds = std::max(longestSeconds, run.longestSeconds);
  for (const auto& [reason, count] : run.reasons) reasons[reason] += count;
  errorSum += run.errorSum;
  errorMax = std::max(errorMax, run.errorMax);
  wrongOk += run.wrongOk;
  relocalized += run.relocalized;
  lostBefore += run.lostBefore;
  okBeyondSeconds = std::max(okBeyondSeconds, run.okBeyondSeconds);
}

TrialOutcome outcomeOf(const Trial& trial, const std::vector<TrialScan>& scans) {
  TrialOutcome outcome;
  outcome.scan = trial.origin;
  outcome.jump = trial.jump;
  judgeSinceBegin(scans, trial.begin, outcome);
  judgeSinceEnd(scans, trial.end, outcome);
  double sum = 0;
  for (const TrialScan& scan : scans) {
    sum += scan.error.metres;
    if (scan.searchSeconds) outcome.searchSeconds.push_back(*scan.searchSeconds);
  }
  outcome.meanError = sum / static_cast<double>(scans.size());
  outcome.endError = scans.back().error.metres;
  outcome.health = countHealth(trial, scans);
  return outcome;
}

}  // namespace polemcl::apps
