#include "eval/FaultTrials.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace polemcl::apps {
namespace {

constexpr double s_stays = 5;    // path over which a pose must be right to count as found, m
constexpr double s_judged = 20;  // metres after `ok` whose error is averaged, m
constexpr double s_withinSeconds = 5, s_withinMetres = 20;

/// One scan of a trial.
struct Judged {
  double time, driven, error;
  HealthState state;
  HealthReason reason;
  bool right;
};

LocalizationPipeline started(const TrialDrive& drive, const LocalizationMap& map,
                             const Pose2D& pose, std::uint32_t seed) {
  LocalizationPipeline localization(map, drive.settings.localization, seed);
  StartOptions start = drive.settings.start;
  start.anywhere = false;
  start.pose = pose;
  localization.start(start);
  return localization;
}

Judged judge(const LocalizationUpdate& update, const Pose2D& truth, double driven) {
  Judged judged{update.time, driven, INFINITY, update.health.state, update.health.reason, false};
  if (!update.estimate) return judged;
  const PlanarError error = errorOf(update.estimate->mean, truth);
  judged.error = error.metres;
  judged.right = isRight(error);
  return judged;
}

template <class Holds>
std::optional<Delay> firstSince(const std::vector<Judged>& scans, std::size_t from,
                                const Holds& holds) {
  for (std::size_t i = from; i < scans.size(); ++i)
    if (holds(i))
      return Delay{scans[i].time - scans[from].time, scans[i].driven - scans[from].driven};
  return std::nullopt;
}

/// From scan i on the pose is right over the metres that make it found, or to the end.
bool staysRight(const std::vector<Judged>& scans, std::size_t i) {
  for (std::size_t k = i; k < scans.size() && scans[k].driven - scans[i].driven <= s_stays; ++k)
    if (!scans[k].right) return false;
  return true;
}

double meanError(const std::vector<Judged>& scans, double from, double to) {
  double sum = 0;
  std::size_t count = 0;
  for (const Judged& scan : scans) {
    if (scan.driven < from || scan.driven > to) continue;
    sum += scan.error;
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

FaultTrial summarize(const std::vector<Judged>& scans, const FaultyDrive& faulty) {
  FaultTrial trial;
  trial.scan = faulty.origin;
  trial.jump = faulty.jump;
  const std::size_t begin = faulty.begin, end = faulty.end;
  trial.okBefore = begin > 0 && scans[begin - 1].state == HealthState::ok;
  using State = HealthState;
  trial.degraded =
      firstSince(scans, begin, [&](std::size_t i) { return scans[i].state != State::ok; });
  trial.lost =
      firstSince(scans, begin, [&](std::size_t i) { return scans[i].state == State::lost; });
  trial.right = firstSince(scans, end, [&](std::size_t i) { return staysRight(scans, i); });
  trial.ok = firstSince(
      scans, end, [&](std::size_t i) { return scans[i].state == State::ok && scans[i].right; });
  for (std::size_t i = begin; i < scans.size() && trial.lostReason.empty(); ++i)
    if (scans[i].state == State::lost) trial.lostReason = name(scans[i].reason);
  for (std::size_t i = begin; i < scans.size(); ++i) {
    if (std::isfinite(scans[i].error)) trial.errorMax = std::max(trial.errorMax, scans[i].error);
    if (i > begin && scans[i].state == State::ok && !scans[i].right)
      trial.okWrongMetres += scans[i].driven - scans[i - 1].driven;
  }
  if (trial.ok) {
    const double since = scans[end].driven + trial.ok->metres;
    trial.errorAfter = meanError(scans, since, since + s_judged);
  }
  return trial;
}

FaultTrial runTrial(const TrialDrive& drive, const LocalizationMap& map,
                    const FaultTrialsOptions& options, std::uint32_t index) {
  std::mt19937_64 random((static_cast<std::uint64_t>(options.seed) << 32) + index);
  const FaultyDrive faulty = injectFault(drive, options.fault, random);
  LocalizationPipeline localization = started(drive, map, faulty.truth[0], options.seed + index);
  std::vector<Judged> scans;
  scans.reserve(faulty.frames.size());
  for (std::size_t i = 0; i < faulty.frames.size(); ++i)
    scans.push_back(judge(localization.step(faulty.frames[i]), faulty.truth[i], faulty.driven[i]));
  FaultTrial trial = summarize(scans, faulty);
  trial.passed = passes(options.fault.fault, trial);
  return trial;
}

class HealthyCounter {
 public:
  void add(const LocalizationUpdate& update, const Pose2D& truth, double metres) {
    const HealthState state = update.health.state;
    if (!m_begun && state != HealthState::ok) {
      run.lostBefore += state == HealthState::lost;
      return;
    }
    const Judged scan = judge(update, truth, 0);
    if (m_begun) {
      run.seconds += update.time - m_time;
      run.metres += metres;
    }
    m_begun = true;
    m_time = update.time;
    ++run.scans;
    run.errorSum += scan.error;
    run.errorMax = std::max(run.errorMax, scan.error);
    run.relocalized += update.relocalized;
    if (state == HealthState::ok) {
      ++run.ok;
      run.wrongOk += !scan.right;
      m_okTime = update.time;
    } else {
      ++run.reasons[name(update.health.reason)];
      run.longestSeconds = std::max(run.longestSeconds, update.time - m_okTime);
    }
    run.lost += state == HealthState::lost;
    run.degraded += state == HealthState::degraded;
    run.lostTimes += state == HealthState::lost && m_last != HealthState::lost;
    run.degradedTimes += state == HealthState::degraded && m_last == HealthState::ok;
    m_last = state;
  }
  bool begun() const { return m_begun; }
  HealthyRun run;

 private:
  bool m_begun = false;
  double m_time = 0, m_okTime = 0;
  HealthState m_last = HealthState::ok;
};

}  // namespace

bool passes(Fault fault, const FaultTrial& trial) {
  switch (fault) {
    case Fault::kidnap:
      return trial.lost &&
             (trial.lost->seconds <= s_withinSeconds || trial.lost->metres <= s_withinMetres);
    case Fault::wrongMap:
      return trial.lost && trial.lost->metres <= s_withinMetres;
    case Fault::none:
      return !trial.lost;
    default:
      return trial.degraded && trial.degraded->seconds <= s_withinSeconds && trial.ok &&
             trial.ok->metres <= s_withinMetres;
  }
}

std::vector<FaultTrial> runFaultTrials(const TrialDrive& drive, const FaultTrialsOptions& options) {
  if (options.trials < 1) throw Error("at least 1 trial is needed");
  LocalizationMap map = drive.map;
  if (options.fault.fault == Fault::none)
    throw Error("a drive without fault has no trials: runHealthy() drives it");
  if (options.fault.fault == Fault::wrongMap) {
    if (!options.otherMap) throw Error("--fault wrong-map needs --other-map, the wrong one");
    map = LocalizationMap(loadPoleMap(*options.otherMap, drive.settings.likelihood));
  }
  std::vector<FaultTrial> trials(options.trials);
  tbb::parallel_for(0, options.trials, [&](int i) {
    trials[i] = runTrial(drive, map, options, static_cast<std::uint32_t>(i));
    if (options.progress) options.progress();
  });
  return trials;
}

std::vector<HealthyRun> runHealthy(const TrialDrive& drive, const FaultTrialsOptions& options) {
  if (options.trials < 1) throw Error("at least 1 trial is needed");
  std::vector<HealthyRun> runs(options.trials);
  tbb::parallel_for(0, options.trials, [&](int i) {
    LocalizationPipeline localization =
        started(drive, drive.map, drive.truth[0], options.seed + static_cast<std::uint32_t>(i));
    HealthyCounter counter;
    for (std::size_t k = 0; k < drive.frames.size(); ++k)
      counter.add(localization.step(drive.frames[k]), drive.truth[k],
                  k > 0 ? errorOf(drive.truth[k], drive.truth[k - 1]).metres : 0);
    if (!counter.begun())
      throw Error("run " + std::to_string(i) + " was never ok in " +
                  std::to_string(drive.frames.size()) + " scans");
    runs[i] = counter.run;
    if (options.progress) options.progress();
  });
  return runs;
}

}  // namespace polemcl::apps
