#include "core/localization/LocalizationHealth.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/common/Covariance.h"

namespace polemcl {
namespace {

/// Scans over this distance are judged together, m. Scans from one viewpoint count as one: a
/// vehicle that stands beside something odd is not lost.
constexpr double kWindow = 8;
/// But at least this number of scans, where they are farther apart: up to this distance, m.
constexpr std::size_t kLeastViewpoints = 3;
constexpr double kLongestWindow = 36;
/// Lost: scans over this longer distance agree, m. Where most poles are gone or new, few known
/// poles are seen for some metres.
constexpr double kLostWindow = 18;
/// Least number of sightings in a window that says anything: sum of the confidences of all poles
/// from all viewpoints.
constexpr double kMinSightings = 8;
/// Lost: least number of poles a scan in the longer window, as a share of what is usual on this
/// drive. It means the same for a LiDAR that sees 3 poles and for one that sees 28. Where the poles
/// of the map are gone, the few new ones prove nothing.
constexpr double kLostSeen = 0.15;
/// What is usual is the mean of scans whose poles match; it forgets over this distance, m.
constexpr double kUsualWithin = 200;
/// Lost: a smaller share of the observed poles is on the map. A pose that has gone wrong was known
/// well before, so matches by chance are rare: 0.002 for 20 cm round each pole.
constexpr double kLostShare = 0.03;
/// The vehicle has left the map: the map has fewer poles near it than this share of those that are
/// seen, and at least this share of these few is found. Unmatched poles then say nothing.
constexpr double kUnmapped = 0.5, kFound = 0.5;
constexpr double kDegradedShare = 0.4;  // degraded: a smaller share of them is on the map
/// Degraded: the log-likelihood ratio of a wrong place against the right one is above kDoubt. At a
/// right and at a wrong place, these shares of the poles match. A few poles suffice if none
/// matches.
constexpr double kDoubt = 4, kRightShare = 0.7, kWrongShare = 0.1;
constexpr double kFullDoubt = 2 * kDoubt;  // the greatest that is remembered
/// Scans nearer to each other than this see the same poles, m. They count less, by their distance.
constexpr double kSamePoles = 3;
/// Doubt grows as at this speed at least, m/s: a vehicle that is moved while its wheels stand is
/// noticed. One that stands beside something odd is `degraded`, not lost.
constexpr double kLeastSpeed = 0.6;
/// Degraded: greater doubt by poles without a match that fit another pose nearby, see
/// doubtByRivals(). It grows by one for each pole beyond these few over kSamePoles.
constexpr double kRivalDoubt = 1;
constexpr std::size_t kFewRivals = 2;   // poles that may fit another pose by chance
constexpr double kRivalForgotten = 12;  // distance over which this doubt falls by one, m
/// Rivals nearer to each other than this are the same, m and rad.
constexpr double kSameRival = 0.2, kSameRivalTurn = 0.02;
constexpr double kLostSpread = 5;           // lost: greater σ of the position, m
constexpr double kDegradedSpread = 0.2;     // degraded: greater σ of the position, m
constexpr double kDegradedHeading = 0.052;  // degraded: greater σ of the heading, rad
constexpr double kFewParticles = 30;        // degraded: fewer effective ones tell no spread
constexpr double kInnovation = 4;    // degraded: greater mean m² per degree of freedom of matches
constexpr double kModeShare = 0.95;  // degraded: smaller share of the weight at the estimate
constexpr double kBlindSeconds = 2;  // degraded: no pole for a longer time, s
constexpr double kBlindMetres = 20;  // degraded: no pole over a longer distance, m
constexpr double kConfirm = 5;       // distance with good matches until a new pose is ok, m
constexpr double kConfirmFound = 2;  // the same for a pose that a search found, m
constexpr double kConfirmNear = 8;   // the same, near a pose that was believed, m
constexpr double kNearlyAll = 0.85;  // but not where a greater share of the poles matches
/// Least number of poles of the map that confirm a pose that was lost. Two or three fit a wrong
/// one, too: the particles spread until they do.
constexpr std::size_t kReturnPoles = 4;
/// Share of matched poles that confirms a new pose. Particles drawn over metres find matches by
/// chance.
constexpr double kConfirmShare = 0.5;
constexpr double kConfirmWithin = 15;  // lost: a new pose is not confirmed within this distance, m
constexpr double kHopelessShare = 0.15;  // lost: a new pose has a smaller share of matches
constexpr double kHopelessAfter = 2;     // but only after this distance, m
constexpr double kViewpoint = 0.1;       // scans nearer to each other are of one viewpoint, m

bool isSame(const Pose2D& a, const Pose2D& b) {
  return std::hypot(a.x - b.x, a.y - b.y) < kSameRival && std::abs(a.yaw - b.yaw) < kSameRivalTurn;
}

/// Removes the poles that last counted before a number of driven metres.
void forgetPoles(std::map<std::size_t, double>& poles, double before) {
  for (auto pole = poles.begin(); pole != poles.end();)
    pole = pole->second < before ? poles.erase(pole) : std::next(pole);
}

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

void HealthMonitor::reset() {
  *this = HealthMonitor(m_maxGap);
}

void HealthMonitor::begin(PoseSource source) {
  const double usual = m_usual, over = m_usualOver;
  const bool believed = m_confirmed || m_source == PoseSource::foundNear;
  reset();
  m_usual = usual;
  m_usualOver = over;
  m_begun = true;
  m_source = source == PoseSource::foundNear && !believed ? PoseSource::found : source;
}

Health HealthMonitor::update(const HealthInput& input) {
  if (!m_begun) return m_health;
  const bool first = m_viewpoints.empty();
  const bool isGap = !first && input.time - m_time > m_maxGap;
  m_driven += input.metres;
  const double seconds = first ? 0 : std::max(0.0, input.time - m_time);
  m_time = input.time;
  remember(input, std::max(input.metres, kLeastSpeed * seconds));
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
  confirmReturn(input);
  if (isGap) m_gapUntil = m_goodDriven + kConfirm;
  judge(input);
  return m_health;
}

template <class Step>
void HealthMonitor::Figures::combine(const Figures& other, const Step& step) {
  step(seen, other.seen);
  step(matched, other.matched);
  step(squared, other.squared);
  step(matches, other.matches);
  step(near.seen, other.near.seen);
  step(near.matched, other.near.matched);
  step(near.expected, other.near.expected);
}

/// A complete viewpoint whose poles match counts in what is usual: a mean over the drive, which
/// forgets viewpoints more than kUsualWithin metres back.
void HealthMonitor::learnUsual() {
  if (m_viewpoints.empty()) return;
  const Viewpoint& last = m_viewpoints.back();
  if (last.seen <= 0 || last.matched < kDegradedShare * last.seen) return;
  const double metres = std::clamp(m_driven - last.driven, kViewpoint, kWindow);
  m_usualOver = std::min(m_usualOver + metres, kUsualWithin);
  m_usual += std::min(1.0, metres / m_usualOver) * (last.seen - m_usual);
}

/// \param metres By which doubt grows.
void HealthMonitor::remember(const HealthInput& input, double metres) {
  if (m_viewpoints.empty() || m_driven - m_viewpoints.back().driven >= kViewpoint) {
    learnUsual();
    m_viewpoints.emplace_back();
    m_viewpoints.back().driven = m_driven;
  }
  while (m_driven - m_viewpoints.front().driven >
         (m_viewpoints.size() > kLeastViewpoints ? kLostWindow : kLongestWindow))
    m_viewpoints.pop_front();
  Figures scan;
  scan.near = input.near;
  for (const PoleMatch& match : input.matches) {
    scan.seen += match.confidence;
    if (!match.matched) continue;
    scan.matched += match.confidence;
    scan.squared += match.squared;
    ++scan.matches;
  }
  if (!m_leftMap) doubt(scan, metres);
  doubtByRivals(input);
  Viewpoint& viewpoint = m_viewpoints.back();
  const double share = 1.0 / ++viewpoint.scans;
  viewpoint.combine(scan, [&](double& mean, double value) { mean += share * (value - mean); });
}

/// The cumulative sum test of Page (1954): earlier matches do not outweigh the latest scans.
void HealthMonitor::doubt(const Figures& scan, double metres) {
  const double wrong =
      (scan.seen - scan.matched) * std::log((1 - kWrongShare) / (1 - kRightShare)) -
      scan.matched * std::log(kRightShare / kWrongShare);
  m_doubt += std::min(1.0, metres / kSamePoles) * wrong;
  m_doubt = std::clamp(m_doubt, 0.0, kFullDoubt);
}

bool HealthMonitor::isInFullDoubt() const {
  return m_doubt >= kFullDoubt;
}

/// The doubt grows with the number of map poles that have fitted the same rival pose over the last
/// metres; a few do so by chance and do not count. It falls slowly, and more slowly where few poles
/// are seen, since the LiDAR that moved may have seen all of them.
void HealthMonitor::doubtByRivals(const HealthInput& input) {
  forgetPoles(m_rivalPoles, m_driven - kRivalForgotten);
  std::size_t count = 0;
  if (!input.rival.poles.empty()) {
    if (!isSame(input.rival.motion, m_lastRival)) m_rivalPoles.clear();
    m_lastRival = input.rival.motion;
    for (const std::size_t pole : input.rival.poles) m_rivalPoles[pole] = m_driven;
    count = m_rivalPoles.size();
  }
  if (count > kFewRivals)
    m_rivalDoubt +=
        std::min(1.0, input.metres / kSamePoles) * static_cast<double>(count - kFewRivals);
  else
    m_rivalDoubt -= input.metres / ((input.matches.size() > 2 ? 1 : 3) * kRivalForgotten);
  m_rivalDoubt = std::clamp(m_rivalDoubt, 0.0, 2 * kRivalDoubt);
}

HealthMonitor::Window HealthMonitor::sumOver(double metres) const {
  Window sum;
  std::size_t left = m_viewpoints.size();
  for (const Viewpoint& viewpoint : m_viewpoints) {
    if (left-- > kLeastViewpoints && m_driven - viewpoint.driven > metres) continue;
    sum.combine(viewpoint, [](double& total, double value) { total += value; });
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

/// Only a pose that was confirmed tells which poles of the map to expect. It may get lost on the
/// way (spread), but a lost one tells nothing.
bool HealthMonitor::leftMap(const Window& window) const {
  return m_confirmed && (m_leftMap || m_health.state != HealthState::lost) &&
         window.near.expected < kUnmapped * window.near.seen &&
         window.near.matched >= kFound * window.near.expected;
}

void HealthMonitor::sumUp() {
  const Window window = sumOver(kWindow), all = sumOver(kLostWindow);
  m_health.seenShare = shareOfUsual(window);
  m_health.matchedShare = window.matchedShare();
  m_health.innovation = window.matches > 0 ? window.squared / (2 * window.matches) : 0;
  m_longShare = all.matchedShare();
  m_leftMap = leftMap(all);
  m_isEnough = window.seen >= kMinSightings;
  m_isEnoughLong = all.seen >= kMinSightings && shareOfUsual(all) >= kLostSeen;
}

double HealthMonitor::metresToConfirm() const {
  if (m_source == PoseSource::given) return kConfirm;
  const bool doubtful = m_source == PoseSource::foundNear && m_health.matchedShare < kNearlyAll;
  return doubtful ? kConfirmNear : kConfirmFound;
}

/// Confirms a new pose after enough metres of good matches.
void HealthMonitor::confirm(const HealthInput& input) {
  const Viewpoint& here = m_viewpoints.back();
  if (here.seen > 0 && here.matched >= kDegradedShare * here.seen) m_goodDriven += input.metres;
  const bool good = m_isEnough && m_health.matchedShare >= kDegradedShare &&
                    m_longShare >= kConfirmShare && m_health.spread < kDegradedSpread &&
                    m_health.spreadHeading < kDegradedHeading;
  if (m_confirmed || !good || m_goodDriven < metresToConfirm()) return;
  m_confirmed = true;
  m_rivalDoubt = 0;  // it was of a pose that was not known yet
}

/// Confirms a pose that was lost and that no search has replaced.
void HealthMonitor::confirmReturn(const HealthInput& input) {
  if (m_confirmed && m_health.state == HealthState::lost) {
    // The scan that ends `lost` does not count: it may match by chance.
    m_isReturning = true;
    m_lostUntil = m_goodDriven + kConfirmFound;
    m_returnPoles.clear();
    return;
  }
  if (!m_isReturning) return;
  for (const PoleMatch& match : input.matches)
    if (match.matched) m_returnPoles[match.pole] = m_driven;
  forgetPoles(m_returnPoles, m_driven - kLostWindow);
  m_isReturning = m_goodDriven < m_lostUntil || m_returnPoles.size() < kReturnPoles;
}

void HealthMonitor::judge(const HealthInput& input) {
  const bool fewMatched = m_health.matchedShare < kDegradedShare;
  // A lost filter spreads until it meets chance matches; they are no reason to believe it again.
  const bool believed = m_confirmed && m_health.state != HealthState::lost;
  const double lostShare = believed ? kLostShare : kHopelessShare;
  const bool bare = !m_leftMap && m_isEnoughLong && m_driven >= kHopelessAfter &&
                    m_longShare < lostShare && fewMatched;
  const bool unconfirmed =
      m_isEnough && !m_confirmed && m_driven >= kConfirmWithin && m_longShare < kConfirmShare;
  const bool wide = m_health.spread > kDegradedSpread ||
                    m_health.spreadHeading > kDegradedHeading ||
                    m_health.effectiveParticles < kFewParticles;
  const bool severalModes = m_health.modeShare < kModeShare;
  const bool blind = m_time - m_seenTime > kBlindSeconds || m_driven - m_seenDriven > kBlindMetres;

  using State = HealthState;
  using Reason = HealthReason;
  const struct {
    bool applies;
    HealthState state;
    HealthReason reason;
  } rules[] = {
      {bare || unconfirmed, State::lost, Reason::mismatch},
      {m_health.spread > kLostSpread && !severalModes, State::lost, Reason::spread},
      {severalModes, State::degraded, Reason::ambiguous},
      {!m_confirmed, State::degraded, Reason::converging},
      {((m_isEnough && fewMatched) || m_doubt > kDoubt) && !m_leftMap, State::degraded,
       Reason::mismatch},
      {wide, State::degraded, Reason::spread},
      {m_isReturning, State::degraded, Reason::converging},
      {m_goodDriven < m_gapUntil, State::degraded, Reason::timeGap},
      {blind || (m_leftMap && fewMatched), State::degraded, Reason::noPoles},
      {input.odometryContradicted, State::degraded, Reason::odometry},
      {(m_isEnough && m_health.innovation > kInnovation) || m_rivalDoubt > kRivalDoubt,
       State::degraded, Reason::innovation},
      {true, State::ok, Reason::none},
  };
  const auto* rule =
      std::find_if(std::begin(rules), std::end(rules), [](const auto& r) { return r.applies; });
  m_health.state = rule->state;
  m_health.reason = rule->reason;
}

}  // namespace polemcl
