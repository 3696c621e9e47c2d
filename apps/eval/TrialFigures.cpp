#include <algorithm>
#include <functional>

#include "core/common/Statistics.h"
#include "eval/Trials.h"

namespace polemcl::apps {
namespace {

constexpr double kWithinSeconds = 5, kWithinMetres = 20;  // demanded of a fault
constexpr double kJumpWithinSeconds = 0.5;
constexpr double kBeyondSeconds = 1;  // longest time allowed `ok` beyond five standard deviations

using Outcomes = std::vector<TrialOutcome>;
using Numbers = std::vector<double>;

/// The value below which this share of them lies, at the nearest rank; 0 without values.
double ranked(const Numbers& values, double share) {
  return values.empty() ? 0 : nearestRank(values, share);
}

/// What `value`, a member or a function that may have none, says of the outcomes.
template <class Value>
Numbers collected(const Outcomes& outcomes, const Value& value) {
  Numbers numbers;
  for (const TrialOutcome& outcome : outcomes)
    if (const std::optional<double> number = std::invoke(value, outcome))
      numbers.push_back(*number);
  return numbers;
}
/// The metres, or seconds, of a delay.
Numbers collected(const Outcomes& outcomes, std::optional<Delay> TrialOutcome::*delay,
                  double Delay::*part) {
  return collected(outcomes, [&](const TrialOutcome& outcome) {
    return outcome.*delay ? std::optional(*(outcome.*delay).*part) : std::nullopt;
  });
}
template <class Holds>
std::size_t countOf(const Outcomes& outcomes, const Holds& holds) {
  return static_cast<std::size_t>(
      std::count_if(outcomes.begin(), outcomes.end(),
                    [&](const TrialOutcome& outcome) { return std::invoke(holds, outcome); }));
}
double shareOf(std::size_t part, std::size_t all) {
  return static_cast<double>(part) / static_cast<double>(all);
}

/// Timings lie apart, so that the figures are the same bytes each time.
void writeTimings(const std::filesystem::path& figures, const Json& times) {
  const std::string beside = figures.stem().string() + "_timings" + figures.extension().string();
  writeJson(figures.parent_path() / beside, times);
}

Json delaysJson(const Outcomes& outcomes, std::optional<Delay> TrialOutcome::*delay) {
  const Numbers seconds = collected(outcomes, delay, &Delay::seconds);
  const Numbers metres = collected(outcomes, delay, &Delay::metres);
  return {{"trials", seconds.size()},        {"median_s", ranked(seconds, 0.5)},
          {"p95_s", ranked(seconds, 0.95)},  {"max_s", ranked(seconds, 1)},
          {"median_m", ranked(metres, 0.5)}, {"p95_m", ranked(metres, 0.95)},
          {"max_m", ranked(metres, 1)}};
}

Json delayJson(const std::optional<Delay>& delay) {
  if (!delay) return nullptr;
  return {{"s", delay->seconds}, {"m", delay->metres}};
}

Json failedJson(const Outcomes& outcomes, Fault fault) {
  Json list = Json::array();
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const TrialOutcome& outcome = outcomes[i];
    if (passes(fault, outcome)) continue;
    list.push_back({{"trial", i},
                    {"scan", outcome.scan},
                    {"jump_m", outcome.jump},
                    {"ok_before", outcome.okBefore},
                    {"degraded", delayJson(outcome.degraded)},
                    {"lost", delayJson(outcome.lost)},
                    {"right", delayJson(outcome.right)},
                    {"ok", delayJson(outcome.ok)},
                    {"ok_wrong_m", outcome.okWrongMetres},
                    {"ok_beyond_5_sigma_s", outcome.okBeyondSeconds}});
  }
  return list;
}

Json faultJson(const TrialOptions& options, const Outcomes& outcomes) {
  const Fault fault = options.fault.fault;
  const Numbers after = collected(outcomes, &TrialOutcome::errorAfter);
  const Numbers largest = collected(outcomes, &TrialOutcome::errorMax);
  const Numbers wrong = collected(outcomes, &TrialOutcome::okWrongMetres);
  const Numbers beyond = collected(outcomes, &TrialOutcome::okBeyondSeconds);
  const std::size_t passed =
      countOf(outcomes, [&](const auto& outcome) { return passes(fault, outcome); });
  std::map<std::string, int> reasons;
  for (const TrialOutcome& outcome : outcomes)
    if (outcome.lost) ++reasons[outcome.lostReason];
  return {{"fault", name(fault)},
          {"trials", outcomes.size()},
          {"seed", options.seed},
          {"passed", passed},
          {"passed_share", shareOf(passed, outcomes.size())},
          {"ok_before", countOf(outcomes, &TrialOutcome::okBefore)},
          {"degraded", delaysJson(outcomes, &TrialOutcome::degraded)},
          {"lost", delaysJson(outcomes, &TrialOutcome::lost)},
          {"right", delaysJson(outcomes, &TrialOutcome::right)},
          {"ok", delaysJson(outcomes, &TrialOutcome::ok)},
          {"error_after_median_m", ranked(after, 0.5)},
          {"error_after_max_m", ranked(after, 1)},
          {"error_largest_median_m", ranked(largest, 0.5)},
          {"ok_wrong_median_m", ranked(wrong, 0.5)},
          {"ok_wrong_max_m", ranked(wrong, 1)},
          {"ok_beyond_5_sigma_max_s", ranked(beyond, 1)},
          {"lost_reasons", reasons},
          {"failed", failedJson(outcomes, fault)}};
}

Json healthJson(const HealthCounts& all, std::size_t runs, std::uint32_t seed) {
  const auto scans = static_cast<double>(all.scans);
  return {{"fault", "none"},
          {"runs", runs},
          {"seed", seed},
          {"hours", all.seconds / 3600},
          {"kilometres", all.metres / 1000},
          {"scans", all.scans},
          {"ok_share", shareOf(all.ok, all.scans)},
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
          {"error_max_m", all.errorMax},
          {"ok_beyond_5_sigma_max_s", all.okBeyondSeconds}};
}

Figures healthFigures(const TrialDrive& drive, const TrialOptions& options,
                      const Outcomes& outcomes) {
  HealthCounts all;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    if (outcomes[i].health.scans == 0)
      throw Error("run " + std::to_string(i) + " was never ok in " +
                  std::to_string(drive.frames.size()) + " scans");
    all.add(outcomes[i].health);
  }
  const Json json = healthJson(all, outcomes.size(), options.seed);
  return {json,
          filled("no fault: {runs} runs, {hours:2} h, {kilometres:1} km, {scans} scans since the "
                 "first ok\n"
                 "lost {lost_times} times ({lost_scans} scans), degraded {degraded_times} times "
                 "({degraded_scans} scans), ok {ok_share:3*100} %, longest not ok "
                 "{longest_not_ok_s:1} s\n"
                 "reasons {reasons}, relocalized {relocalized}, ok with a wrong pose "
                 "{ok_with_wrong_pose} scans\n"
                 "position error mean {error_mean_m:4}, greatest {error_max_m:3} m; beyond five of "
                 "its sigmas for {ok_beyond_5_sigma_max_s:1} s at most\n",
                 json)};
}

}  // namespace

bool passes(Fault fault, const TrialOutcome& outcome) {
  const auto within = [](const std::optional<Delay>& delay, double seconds, double metres) {
    return delay && (delay->seconds <= seconds || delay->metres <= metres);
  };
  if (outcome.okBeyondSeconds > kBeyondSeconds) return false;
  switch (fault) {
    case Fault::kidnap:
      return within(outcome.lost, kWithinSeconds, kWithinMetres);
    case Fault::wrongMap:
      return within(outcome.lost, -1, kWithinMetres);
    case Fault::none:
      return !outcome.lost;
    case Fault::jump:
      return within(outcome.degraded, kJumpWithinSeconds, -1) &&
             within(outcome.ok, -1, kWithinMetres);
    case Fault::clock:
    case Fault::moved:
    case Fault::late:
      return within(outcome.ok, -1, kWithinMetres);
    case Fault::halfGone:
    case Fault::snow:
      return !outcome.lost && within(outcome.ok, -1, kWithinMetres);
    default:
      return within(outcome.degraded, kWithinSeconds, -1) && within(outcome.ok, -1, kWithinMetres);
  }
}

Figures globalFigures(const TrialDrive& drive, const TrialOptions& options,
                      const std::vector<TrialOutcome>& outcomes) {
  Numbers metres, errors, searches;
  for (const TrialOutcome& outcome : outcomes) {
    searches.insert(searches.end(), outcome.searchSeconds.begin(), outcome.searchSeconds.end());
    if (!outcome.said || !outcome.saidError.isRight()) continue;
    metres.push_back(outcome.said->metres);
    errors.push_back(outcome.saidError.metres);
  }
  const std::size_t said = collected(outcomes, &TrialOutcome::said, &Delay::metres).size();
  const std::size_t wrong = said - metres.size();
  const Json json{{"trials", outcomes.size()},
                  {"map_poles", drive.map.poles->poles().size()},
                  {"right", metres.size()},
                  {"wrong", wrong},
                  {"undecided", outcomes.size() - said},
                  {"right_share", shareOf(metres.size(), outcomes.size())},
                  {"wrong_share", shareOf(wrong, outcomes.size())},
                  {"ok_wrong", countOf(outcomes, &TrialOutcome::okWrong)},
                  {"metres_median", ranked(metres, 0.5)},
                  {"metres_p95", ranked(metres, 0.95)},
                  {"metres_max", ranked(metres, 1)},
                  {"error_median_m", ranked(errors, 0.5)},
                  {"error_max_m", ranked(errors, 1)}};
  const Json times{{"query_median_ms", 1e3 * ranked(searches, 0.5)},
                   {"query_max_ms", 1e3 * ranked(searches, 1)}};
  if (options.json) writeTimings(*options.json, times);
  return {json,
          filled("{trials} random starts, map of {map_poles} poles, ", json) +
              filled("{metres:0} m each\n", {{"metres", options.metres}}) +
              filled("right {right}, wrong {wrong}, undecided {undecided}; ok said of a wrong "
                     "pose: {ok_wrong}\n"
                     "found after {metres_median:1} m (95 %: {metres_p95:1} m), error then "
                     "{error_median_m:3} m, at most {error_max_m:3} m\n",
                     json) +
              filled("a step with a search: {query_median_ms:1} ms, at most {query_max_ms:1} ms\n",
                     times)};
}

Figures startFigures(const TrialDrive& drive, const TrialOptions& options,
                     const std::vector<TrialOutcome>& outcomes) {
  const Numbers right = collected(outcomes, &TrialOutcome::rightForGood, &Delay::metres);
  const Numbers ok = collected(outcomes, &TrialOutcome::saidOk, &Delay::metres);
  const Numbers ends = collected(outcomes, &TrialOutcome::endError);
  double mean = 0;
  for (const TrialOutcome& outcome : outcomes) mean += outcome.meanError;
  const Json json{{"trials", outcomes.size()},
                  {"map_poles", drive.map.poles->poles().size()},
                  {"right", right.size()},
                  {"right_share", shareOf(right.size(), outcomes.size())},
                  {"ok_wrong", countOf(outcomes, &TrialOutcome::okWrong)},
                  {"mean_m", mean / static_cast<double>(outcomes.size())},
                  {"end_median_m", ranked(ends, 0.5)},
                  {"right_metres_median", ranked(right, 0.5)},
                  {"right_metres_p95", ranked(right, 0.95)},
                  {"right_metres_max", ranked(right, 1)},
                  {"ok_metres_median", ranked(ok, 0.5)}};
  return {json,
          filled("{trials} starts known roughly, map of {map_poles} poles, ", json) +
              filled("{metres:0} m each\n", {{"metres", options.metres}}) +
              filled("right at the end {right}; ok said of a wrong pose: {ok_wrong}\n"
                     "right for good after {right_metres_median:1} m (95 %: {right_metres_p95:1} "
                     "m, at most {right_metres_max:1} m), ok after {ok_metres_median:1} m\n"
                     "mean error {mean_m:4} m, at the end {end_median_m:4} m (median)\n",
                     json)};
}

Figures faultFigures(const TrialDrive& drive, const TrialOptions& options,
                     const std::vector<TrialOutcome>& outcomes) {
  if (options.fault.fault == Fault::none) return healthFigures(drive, options, outcomes);
  const Json json = faultJson(options, outcomes);
  std::string delays;
  for (const char* what : {"degraded ", "lost     ", "right    ", "ok       "})
    delays += what + filled(
                         " {trials:6.0} {median_s:8.1} {p95_s:8.1} {max_s:8.1} {median_m:8.1} "
                         "{p95_m:8.1} {max_m:8.1}\n",
                         json.at(std::string(what, std::string(what).find(' '))));
  return {json,
          filled("fault {fault}: {passed} of {trials} as demanded; ok before the fault: "
                 "{ok_before}\n"
                 "          trials median s    95 %s    max s median m    95 %m    max m\n",
                 json) +
              delays +
              filled("degraded and lost since the fault began, right and ok since it ended; lost "
                     "first for {lost_reasons}\n"
                     "mean error over 20 m after ok: median {error_after_median_m:3} m, worst "
                     "{error_after_max_m:3} m; ok said of a wrong pose over {ok_wrong_median_m:1} "
                     "m in the median, {ok_wrong_max_m:1} m at most; beyond five of its sigmas for "
                     "{ok_beyond_5_sigma_max_s:1} s at most\n",
                     json)};
}

}  // namespace polemcl::apps
