#include <algorithm>
#include <cmath>
#include <iterator>

#include <polemcl/core/localization/LocalizationHealth.h>
#include "core/common/Covariance.h"

namespace polemcl {
namespace {

constexpr double s_hopeless = 0.3;     // a new pose is not waited for below this part of its share
constexpr double s_hopelessAfter = 2;  // but for this distance, m
constexpr double s_viewpoint = 0.1;    // scans nearer to each other are of one viewpoint, m

}  // namespace

const char* name(HealthState state) {
  static constexpr const char* names[] = {"ok", "degraded", "lost"};
  return names[static_cast<int>(state)];
}

const char* name(HealthReason reason) {
  static constexpr const char* names[] = {"none",     "searching", "elsewhere",  "mismatch",
                                          "spread",   "ambiguous", "converging", "time_gap",
                                          "no_poles", "odometry",  "innovation"};
  return names[static_cast<int>(reason)];
}

HealthMonitor::HealthMonitor(const HealthOptions& options) : m_options(options) {
  checkOptions(options);
}

void HealthMonitor::reset() {
  *this = HealthMonitor(m_options);
}

void HealthMonitor::begin(bool found) {
  const double usual = m_usual, over = m_usualOver;
  reset();
  m_usual = usual;
  m_usualOver = over;
  m_begun = true;
  m_found = found;
}

Health HealthMonitor::update(const HealthInput& input) {
  if (!m_begun) return m_health;
  const bool first = m_viewpoints.empty();
  if (!first && input.time - m_time > m_options.maxGap)
    m_gapUntil = m_driven + input.metres + m_options.confirm;
  m_driven += input.metres;
  m_time = input.time;
  remember(input);
  sumUp();
  if (first || std::any_of(input.matches.begin(), input.matches.end(),
                           [](const PoleMatch& match) { return match.confidence > 0; })) {
    m_seenDriven = m_driven;
    m_seenTime = m_time;
  }
  m_health.effectiveParticles = input.effectiveParticles;
  m_health.modeShare = input.modeShare;
  m_health.spread = largestSigma(input.estimate.covariance.topLeftCorner<2, 2>());
  m_health.spreadHeading = std::sqrt(std::max(0.0, input.estimate.covariance(2, 2)));
  confirm(input);
  judge(input);
  return m_health;
}

/// A complete viewpoint whose poles match counts in what is usual: like all others at first, then
/// so that those `usualWithin` metres back have lost most of their weight.
void HealthMonitor::learnUsual() {
  if (m_viewpoints.empty()) return;
  const Viewpoint& last = m_viewpoints.back();
  if (last.seen <= 0 || last.matched < m_options.degradedShare * last.seen) return;
  const double metres = std::clamp(m_driven - last.driven, s_viewpoint, m_options.window);
  m_usualOver = std::min(m_usualOver + metres, m_options.usualWithin);
  m_usual += std::min(1.0, metres / m_usualOver) * (last.seen - m_usual);
}

void HealthMonitor::remember(const HealthInput& input) {
  if (m_viewpoints.empty() || m_driven - m_viewpoints.back().driven >= s_viewpoint) {
    learnUsual();
    m_viewpoints.emplace_back();
    m_viewpoints.back().driven = m_driven;
  }
  while (m_driven - m_viewpoints.front().driven > m_options.lostWindow) m_viewpoints.pop_front();
  Viewpoint scan;
  for (const PoleMatch& match : input.matches) {
    scan.seen += match.confidence;
    if (!match.matched) continue;
    scan.matched += match.confidence;
    scan.squared += match.squared;
    ++scan.matches;
  }
  Viewpoint& viewpoint = m_viewpoints.back();
  const double share = 1.0 / ++viewpoint.scans;
  viewpoint.seen += share * (scan.seen - viewpoint.seen);
  viewpoint.matched += share * (scan.matched - viewpoint.matched);
  viewpoint.squared += share * (scan.squared - viewpoint.squared);
  viewpoint.matches += share * (scan.matches - viewpoint.matches);
}

HealthMonitor::Window HealthMonitor::sumOver(double metres) const {
  Window sum;
  for (const Viewpoint& viewpoint : m_viewpoints) {
    if (m_driven - viewpoint.driven > metres) continue;
    sum.seen += viewpoint.seen;
    sum.matched += viewpoint.matched;
    sum.squared += viewpoint.squared;
    sum.matches += viewpoint.matches;
    ++sum.viewpoints;
  }
  return sum;
}

/// 1 while there is nothing to compare it with.
double HealthMonitor::shareOfUsual(const Window& window) const {
  const double mean = window.viewpoints > 0 ? window.seen / window.viewpoints : 0;
  if (m_usual > 0) return mean / m_usual;
  return mean > 0 ? 1 : 0;
}

void HealthMonitor::sumUp() {
  const Window window = sumOver(m_options.window), all = sumOver(m_options.lostWindow);
  m_health.seenShare = shareOfUsual(window);
  m_health.matchedShare = window.matchedShare();
  m_health.innovation = window.matches > 0 ? window.squared / (2 * window.matches) : 0;
  m_longShare = all.matchedShare();
  m_isEnough = window.seen >= m_options.minSightings;
  m_isEnoughLong = all.seen >= m_options.minSightings && shareOfUsual(all) >= m_options.lostSeen;
}

/// Confirms a new pose after enough metres of good matches.
void HealthMonitor::confirm(const HealthInput& input) {
  const HealthOptions& o = m_options;
  const Viewpoint& here = m_viewpoints.back();
  if (here.seen > 0 && here.matched >= o.degradedShare * here.seen) m_goodDriven += input.metres;
  const bool good = m_isEnough && m_health.matchedShare >= o.degradedShare &&
                    m_longShare >= o.confirmShare && m_health.spread < o.degradedSpread &&
                    m_health.spreadHeading < o.degradedHeading;
  if (good && m_goodDriven >= (m_found ? o.confirmFound : o.confirm)) m_confirmed = true;
}

void HealthMonitor::judge(const HealthInput& input) {
  const HealthOptions& o = m_options;
  const bool fewMatched = m_health.matchedShare < o.degradedShare;
  // A lost filter spreads until it meets chance matches; they are no reason to believe it again.
  const bool believed = m_confirmed && m_health.state != HealthState::lost;
  const double lostShare = believed ? o.lostShare : s_hopeless * o.confirmShare;
  const bool bare =
      m_isEnoughLong && m_driven >= s_hopelessAfter && m_longShare < lostShare && fewMatched;
  const bool unconfirmed =
      m_isEnough && !m_confirmed && m_driven >= o.confirmWithin && m_longShare < o.confirmShare;
  const bool wide =
      m_health.spread > o.degradedSpread || m_health.spreadHeading > o.degradedHeading;
  const bool severalModes = m_health.modeShare < o.modeShare;
  const bool blind =
      m_time - m_seenTime > o.blindSeconds || m_driven - m_seenDriven > o.blindMetres;

  using State = HealthState;
  using Reason = HealthReason;
  const struct {
    bool applies;
    HealthState state;
    HealthReason reason;
  } rules[] = {
      {bare || unconfirmed, State::lost, Reason::mismatch},
      {m_health.spread > o.lostSpread && !severalModes, State::lost, Reason::spread},
      {severalModes, State::degraded, Reason::ambiguous},
      {!m_confirmed, State::degraded, Reason::converging},
      {m_isEnough && fewMatched, State::degraded, Reason::mismatch},
      {wide, State::degraded, Reason::spread},
      {m_driven < m_gapUntil, State::degraded, Reason::timeGap},
      {blind, State::degraded, Reason::noPoles},
      {input.odometryContradicted, State::degraded, Reason::odometry},
      {m_isEnough && m_health.innovation > o.innovation, State::degraded, Reason::innovation},
      {true, State::ok, Reason::none},
  };
  const auto* rule =
      std::find_if(std::begin(rules), std::end(rules), [](const auto& r) { return r.applies; });
  m_health.state = rule->state;
  m_health.reason = rule->reason;
}

}  // namespace polemcl
