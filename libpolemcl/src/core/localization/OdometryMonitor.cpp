#include "core/localization/OdometryMonitor.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/common/Transform.h"

namespace polemcl {
namespace {

constexpr double kScaleTolerance =
    0.05;                           // tolerated error of the odometry, as a share of the distance
constexpr double kTolerance = 0.1;  // tolerated error of any motion, m
constexpr double kTurnTolerance = 0.02;  // tolerated error of any turn, rad
constexpr double kSigmas = 5;    // least difference beyond that contradicts, standard deviations
constexpr double kMargin = 1.5;  // least lead of the poles' motion over the odometry's, in pairs
constexpr double kLeastChance = 1e-3;   // that none of the poles is seen again; less contradicts
constexpr double kForget = 0.98;        // weight of earlier scans in the share seen again
constexpr double kMostSeenAgain = 0.8;  // of that share: one bus hides several poles
constexpr double kSettle = 0.5;         // time of agreement until the odometry is believed again, s
constexpr double kHold = 5;  // time for which the last speed is kept without enough poles, s
constexpr double kTimeError = 0.04;   // of the time between two scans, s
constexpr double kLeastSigma = 0.02;  // of a motion by poles, m
constexpr double kLeastTurn = 0.002;  // rad
constexpr double kMostVariance = 1;   // m²; above it, the motion by poles is too uncertain
constexpr double kMostDoubt = 5;      // m

std::vector<PoleDetection> usable(const std::vector<PoleDetection>& poles) {
  std::vector<PoleDetection> result;
  for (const PoleDetection& pole : poles)
    if (std::isfinite(pole.x) && std::isfinite(pole.y) && pole.covariance.allFinite() &&
        pole.confidence > 0)
      result.push_back(pole);
  return result;
}

/// From one motion to another, in the frame that both begin in.
Eigen::Vector3d difference(const Pose2D& from, const Pose2D& to) {
  return {to.x - from.x, to.y - from.y, wrapAngle(to.yaw - from.yaw)};
}

Pose2D scaled(const Pose2D& motion, double factor) {
  return {factor * motion.x, factor * motion.y, factor * motion.yaw};
}

Pose2D middle(const Pose2D& a, const Pose2D& b) {
  return {0.5 * (a.x + b.x), 0.5 * (a.y + b.y), 0.5 * (a.yaw + b.yaw)};
}

/// Whether the pairs determine the motion.
bool isCertain(const Eigen::Matrix3d& covariance) {
  return covariance.allFinite() && covariance(0, 0) + covariance(1, 1) < kMostVariance &&
         covariance(2, 2) < kMostVariance / 100;
}

/// A share of the change between two motions, as a standard deviation; bounded like the motions of
/// the filter.
Eigen::Matrix3d doubt(const Pose2D& from, const Pose2D& to, double share) {
  Eigen::Vector3d change = difference(from, to);
  const double length = change.head<2>().norm();
  if (length > kMostDoubt) change.head<2>() *= kMostDoubt / length;
  change.z() = std::clamp(change.z(), -0.1 * kMostDoubt, 0.1 * kMostDoubt);
  return share * share * change * change.transpose();
}

/// How far `value` lies outside the tolerance around 0.
double outside(double value, double tolerance) {
  return value > tolerance ? value - tolerance : value < -tolerance ? value + tolerance : 0;
}

/// Distance of another motion from what the odometry allows, in standard deviations.
/// \param covariance Of their difference, in the frame that both begin in.
double beyondTolerance(const Pose2D& odometry, const Pose2D& other,
                       const Eigen::Matrix3d& covariance) {
  Eigen::Vector3d rest = difference(odometry, other);
  const double way = std::hypot(odometry.x, odometry.y);
  const double length = rest.head<2>().norm();
  const double left = outside(length, kTolerance + kScaleTolerance * way);
  rest.head<2>() *= length > 0 ? left / length : 0;
  rest.z() = outside(rest.z(), kTurnTolerance + kScaleTolerance * std::abs(odometry.yaw));
  return std::sqrt(std::max(0.0, rest.dot(covariance.inverse() * rest)));
}

}  // namespace

void OdometryMonitor::clear() {
  *this = OdometryMonitor(m_enabled);
}

MonitoredMotion OdometryMonitor::add(double time, const Pose2D& motion,
                                     const Eigen::Matrix3d& covariance,
                                     const std::vector<PoleDetection>& poles_robot) {
  MonitoredMotion result;
  result.motion = motion;
  result.covariance = covariance;
  if (!m_enabled) return result;
  while (!m_past.empty() && m_past.back().time >= time) m_past.pop_back();
  if (!m_past.empty() && time - m_past.back().time > kComparedTime) clear();
  Reference now;
  now.time = time;
  now.poles = usable(poles_robot);
  if (!m_past.empty()) {
    const Reference& last = m_past.back();
    now.odometry = compose(last.odometry, motion);
    now.used = compose(last.used, motion);
    now.seen = compose(last.seen, motion);
    now.spent = last.spent + covariance;
    result = m_state == State::contradicted ? replace(now, result) : watch(now, result);
    const bool isFirst = !m_isSpeedKnown;
    if (result.replaced)
      m_steps.beginStep();
    else
      learnSpeed(motion, time - last.time);
    if (m_chance == 1 || isFirst) m_speedSeen = m_speed;
  }
  m_past.push_back(now);
  // One scan older than the window stays, so that the window is full.
  while (m_past.size() > 2 && time - m_past[1].time >= kComparedTime) m_past.pop_front();
  return result;
}

/// Scans whose stamps are close together tell no speed.
void OdometryMonitor::learnSpeed(const Pose2D& motion, double seconds) {
  const auto step = m_steps.add(motion, seconds);
  if (!step) return;
  m_speed = scaled(step->motion, 1 / step->seconds);
  m_isSpeedKnown = true;
}

/// Indices of the scans to compare with, the latest first.
std::vector<std::size_t> OdometryMonitor::chosen(double time) const {
  std::vector<std::size_t> result;
  for (const double lag : kLags) {
    std::size_t i = m_past.size() - 1;
    while (i > 0 && time - m_past[i].time < lag * kComparedTime - 1e-6) --i;
    if (result.empty() || result.back() != i) result.push_back(i);
  }
  return result;
}

/// The motion that most poles support: near the motion used, near that of the poles from scan to
/// scan, or near the last speed; else searched.
ScanRegistration OdometryMonitor::align(const Reference& reference, const Reference& now,
                                        bool search) const {
  const Reference& last = m_past.back();
  const Pose2D coasted = compose(last.used, coast(now.time - last.time));
  ScanRegistration best =
      refineMotion(reference.poles, now.poles, relative(reference.used, now.used), {});
  const auto keep = [&](const ScanRegistration& other) {
    if (other.score > best.score + 0.5) best = other;
  };
  keep(refineMotion(reference.poles, now.poles, relative(reference.seen, now.seen), {}));
  const double possible =
      kMinShare * static_cast<double>(std::min(reference.poles.size(), now.poles.size()));
  const auto poor = [&] { return best.pairs < kMinPairs || best.score < possible; };
  if (poor()) keep(refineMotion(reference.poles, now.poles, relative(reference.used, coasted), {}));
  if (!search || !poor()) return best;
  keep(searchMotion(reference.poles, now.poles, relative(reference.used, coasted),
                    searchLimits(now.time - reference.time)));
  return best;
}

bool OdometryMonitor::suffices(const ScanRegistration& alignment, const Reference& reference,
                               const Reference& now) {
  const auto fewer = static_cast<double>(std::min(reference.poles.size(), now.poles.size()));
  return alignment.pairs >= kMinPairs && alignment.pairs >= kMinShare * fewer &&
         isCertain(alignment.covariance);
}

/// Distance of the poles' motion from what the odometry allows, in standard deviations.
double OdometryMonitor::beyondOdometry(const Reference& reference, const Reference& now,
                                       const ScanRegistration& found) {
  return beyondMotion(relative(reference.odometry, now.odometry), now.spent - reference.spent,
                      found);
}

/// The same for any motion. \param spent Its covariance.
double OdometryMonitor::beyondMotion(const Pose2D& motion, const Eigen::Matrix3d& spent,
                                     const ScanRegistration& found) {
  // Errors of the headings on the way move the end.
  const double carried = spent(2, 2) * (motion.x * motion.x + motion.y * motion.y) / 3;
  const Eigen::Vector3d least(kLeastSigma * kLeastSigma + carried,
                              kLeastSigma * kLeastSigma + carried, kLeastTurn * kLeastTurn);
  const Eigen::Matrix3d leastCovariance = least.asDiagonal();
  return beyondTolerance(motion, found.motion, found.covariance + spent + leastCovariance);
}

/// The odometry with the pairs that support it, corrected by them within its tolerance.
ScanRegistration OdometryMonitor::allowed(const Reference& reference, const Reference& now) {
  const Pose2D odometry = relative(reference.odometry, now.odometry);
  ScanRegistration corrected = refineMotion(reference.poles, now.poles, odometry, {});
  if (corrected.pairs >= 2 && beyondOdometry(reference, now, corrected) <= kSigmas)
    return corrected;
  return judgeMotion(reference.poles, now.poles, odometry, {});
}

OdometryMonitor::Finding OdometryMonitor::compare(const Reference& reference, const Reference& now,
                                                  bool search) const {
  Finding finding;
  finding.alignment = align(reference, now, search);
  const ScanRegistration& found = finding.alignment;
  if (!suffices(found, reference, now)) return finding;
  finding.verdict = OdometryVerdict::agrees;
  if (beyondOdometry(reference, now, found) <= kSigmas) return finding;
  const ScanRegistration stated = allowed(reference, now);
  finding.verdict = OdometryVerdict::contradicted;
  if (found.score >= stated.score + kMargin && isDistinct(reference, now, found, stated))
    return finding;
  finding.verdict = stated.pairs >= 2 ? OdometryVerdict::agrees : OdometryVerdict::unknown;
  finding.alignment = stated;
  return finding;
}

/// Whether the poles of a motion can be believed against the odometry. They cannot where alike
/// poles in a row fit both motions. Poles that stay where they are seen from the vehicle may move
/// along with it (a lorry beside it, its own parts): if it stands, nearly all of them stay, and it
/// was slow enough to stop. Any other change of speed that no vehicle makes needs more pairs.
bool OdometryMonitor::isDistinct(const Reference& reference, const Reference& now,
                                 const ScanRegistration& found,
                                 const ScanRegistration& stated) const {
  if (isShiftedRow(reference.poles, now.poles, found, stated.motion)) return false;
  const double seconds = now.time - reference.time;
  const Pose2D before = scaled(m_speedSeen, seconds);
  const double change = std::hypot(found.motion.x - before.x, found.motion.y - before.y);
  const bool isPossible = change <= kTolerance + kMostAcceleration * seconds * seconds;
  if (countNear(reference.poles, now.poles, Pose2D()) < found.pairs)
    return isPossible || found.pairs >= kSurePairs;
  const auto fewer = static_cast<double>(std::min(reference.poles.size(), now.poles.size()));
  return isPossible && stated.pairs < 2 && found.pairs >= kStandingShare * fewer;
}

/// Whether the motion of the poles is too uncertain to exclude that the speed before goes on. One
/// that was only judged, not estimated, always is: its covariance is 1 m².
bool OdometryMonitor::allowsLastSpeed(const Reference& reference, const Reference& now,
                                      const ScanRegistration& found) const {
  const Reference& last = m_past.back();
  const Pose2D on = compose(last.used, coast(now.time - last.time));
  return beyondMotion(relative(reference.used, on), now.spent - reference.spent, found) <= kSigmas;
}

/// One scan while the odometry is believed or suspected.
MonitoredMotion OdometryMonitor::watch(Reference& now, const MonitoredMotion& odometry) {
  MonitoredMotion result = odometry;
  const bool isImpossible = !isPossible(now, odometry.motion) &&
                            !m_steps.isOpen(odometry.motion, now.time - m_past.back().time);
  bool search = true;  // with the scan before only
  for (const std::size_t i : chosen(now.time)) {
    const Finding finding = compare(m_past[i], now, search);
    if (search && finding.verdict != OdometryVerdict::unknown)
      now.seen = compose(m_past[i].seen, finding.alignment.motion);
    search = false;
    if (finding.verdict == OdometryVerdict::contradicted)
      return contradict(now, m_past[i], finding.alignment, odometry);
    if (finding.verdict == OdometryVerdict::unknown) continue;
    if (isImpossible && allowsLastSpeed(m_past[i], now, finding.alignment)) continue;
    result.verdict = OdometryVerdict::agrees;
    result.pairs = std::max(result.pairs, finding.alignment.pairs);
  }
  m_state = State::believed;
  countSeenAgain(now, odometry.motion);
  if (result.verdict == OdometryVerdict::unknown) {
    const bool isUnseen = m_chance < kLeastChance;
    if ((isUnseen && m_hasChanged) || isImpossible) return coasted(now, odometry);
    if (isUnseen || !isPossible(now, odometry.motion)) {
      result.verdict = OdometryVerdict::contradicted;
      return result;
    }
  }
  m_possibleTime = now.time;
  return result;
}

/// Counts the poles of the scan before that are where the odometry expects them, within a metre.
/// Updates the chance that none of them is, as has been since the last one that was. After kHold
/// seconds of a small chance, poles are not expected to be seen again. When the chance becomes
/// small, either the odometry has changed, or the poles have: only the first is a reason to replace
/// it.
void OdometryMonitor::countSeenAgain(const Reference& now, const Pose2D& motion) {
  const Reference& last = m_past.back();
  const auto poles = static_cast<double>(std::min(last.poles.size(), now.poles.size()));
  RegistrationOptions near;
  near.sigma = near.reach;  // whatever the covariances
  const int seenAgain = judgeMotion(last.poles, now.poles, motion, near).pairs;
  const double share = std::min(kMostSeenAgain, m_seenAgain / m_counted);
  const bool wasSmall = m_chance < kLeastChance;
  m_chance = seenAgain > 0 ? 1 : m_chance * std::pow(1 - share, poles);
  if (m_chance < kLeastChance) {
    if (!wasSmall) m_hasChanged = hasChanged(motion, now.time - last.time);
    if (now.time - m_possibleTime <= kHold) return;
    m_chance = 1;
    m_seenAgain = 0;
  }
  m_seenAgain = kForget * m_seenAgain + seenAgain;
  m_counted = kForget * m_counted + poles;
}

/// Whether the odometry states another motion than at the speed when a pole was last seen again,
/// beyond the tolerances.
bool OdometryMonitor::hasChanged(const Pose2D& motion, double seconds) const {
  const TimedMotion step = m_steps.joined(motion, seconds);
  return !m_steps.isOpen(motion, seconds) &&
         beyondTolerance(step.motion, scaled(m_speedSeen, step.seconds),
                         Eigen::Matrix3d::Identity()) > 0;
}

/// Whether a vehicle can have this speed after the one before. After kHold seconds, any is
/// believed.
bool OdometryMonitor::isPossible(const Reference& now, const Pose2D& motion) const {
  if (!m_isSpeedKnown || m_past.size() < 2 || now.time - m_possibleTime > kHold) return true;
  const TimedMotion step = m_steps.joined(motion, now.time - m_past.back().time);
  const double seconds = step.seconds;
  const double way = std::hypot(step.motion.x, step.motion.y);
  const double expected = seconds * std::hypot(m_speed.x, m_speed.y);
  return std::abs(way - expected) <= kTolerance + kTimeError * std::max(way, expected) / seconds +
                                         kMostAcceleration * seconds * seconds;
}

/// Keeps the speed before. The covariance also covers the motion that the odometry states.
MonitoredMotion OdometryMonitor::coasted(Reference& now, const MonitoredMotion& odometry) {
  const Reference& last = m_past.back();
  if (m_chance < kLeastChance && m_hasChanged) m_speed = m_speedSeen;
  MonitoredMotion result = odometry;
  result.verdict = OdometryVerdict::contradicted;
  result.replaced = true;
  result.motion = coast(now.time - last.time);
  now.used = compose(last.used, result.motion);
  result.covariance += doubt(result.motion, odometry.motion, 0.5);
  return result;
}

/// The poles contradict the odometry. Many pairs, or a second scan in a row, decide.
MonitoredMotion OdometryMonitor::contradict(Reference& now, const Reference& reference,
                                            const ScanRegistration& alignment,
                                            const MonitoredMotion& odometry) {
  const bool decides = m_state == State::suspected || alignment.pairs >= kSurePairs;
  const Pose2D speedBefore = m_speed;
  MonitoredMotion result = take(now, reference, alignment);
  if (decides) {
    m_state = State::contradicted;
    m_chance = 1;
    m_knownTime = m_keyTime = now.time;
    // The filter may have corrected a part of this already, or the poles may be wrong.
    result.covariance += doubt(odometry.motion, result.motion, 0.5);
    return result;
  }
  m_state = State::suspected;
  m_speed = speedBefore;
  result.verdict = OdometryVerdict::unknown;
  result.covariance = odometry.covariance + doubt(odometry.motion, result.motion, 1);
  result.motion = odometry.motion;
  now.used = compose(m_past.back().used, odometry.motion);
  return result;
}

/// The motion from the scan before that ends where the alignment says.
MonitoredMotion OdometryMonitor::take(Reference& now, const Reference& reference,
                                      const ScanRegistration& alignment) {
  MonitoredMotion result;
  result.verdict = OdometryVerdict::contradicted;
  result.replaced = true;
  result.pairs = alignment.pairs;
  // The step to come may make up for earlier ones: the speed is that of the whole way. Smoothed,
  // since it is what is left where poles are missing.
  const double seconds = now.time - reference.time;
  if (m_steps.tellsSpeed({alignment.motion, seconds})) {
    const Pose2D speed = scaled(alignment.motion, 1 / seconds);
    m_speed = m_state == State::contradicted ? middle(m_speed, speed) : speed;
    m_isSpeedKnown = true;
  }
  now.used = compose(reference.used, alignment.motion);
  result.motion = relative(m_past.back().used, now.used);
  const double turn = relative(reference.used, m_past.back().used).yaw;
  const double c = std::cos(turn), s = std::sin(turn);
  Eigen::Matrix3d rotation;  // into the robot frame before this step
  rotation << c, s, 0, -s, c, 0, 0, 0, 1;
  const Eigen::Matrix3d turned = rotation * alignment.covariance * rotation.transpose();
  result.covariance = symmetrized(turned);
  result.covariance +=
      Eigen::Vector3d(kLeastSigma * kLeastSigma, kLeastSigma * kLeastSigma, kLeastTurn * kLeastTurn)
          .asDiagonal();
  return result;
}

/// One scan while the odometry is contradicted.
MonitoredMotion OdometryMonitor::replace(Reference& now, const MonitoredMotion& odometry) {
  const Reference& last = m_past.back();
  MonitoredMotion result;
  bool found = false;
  const std::size_t key = keyScan(), latest = m_past.size() - 1;
  for (const std::size_t i : {key, latest}) {
    Reference coasting = now;
    coasting.used = compose(last.used, coast(now.time - last.time));
    coasting.seen = compose(last.seen, coast(now.time - last.time));
    const ScanRegistration alignment = align(m_past[i], coasting, i == latest);
    if (!suffices(alignment, m_past[i], now)) continue;
    result = take(now, m_past[i], alignment);
    m_knownTime = now.time;
    const bool old = now.time - m_past[i].time >= kLags[1] * kComparedTime - 1e-6;
    m_keyTime = old ? now.time : m_past[i].time;
    found = true;
    break;
  }
  if (!found) {
    result = coasted(now, odometry);
    now.known = false;
  }
  now.seen = compose(last.seen, result.motion);
  if (hasSettled(now) || now.time - m_knownTime > kHold) {
    m_state = State::believed;
    // Earlier scans are not compared with any more: the odometry was wrong then.
    while (m_past.size() > 1 && now.time - m_past.front().time > kSettle) m_past.pop_front();
  }
  return result;
}

/// Index of the scan to align with, or of the next one if it is gone.
std::size_t OdometryMonitor::keyScan() const {
  std::size_t i = m_past.size() - 1;
  while (i > 0 && m_past[i - 1].time >= m_keyTime - 1e-6) --i;
  return i;
}

/// Whether odometry and poles have agreed for the settling time.
bool OdometryMonitor::hasSettled(const Reference& now) const {
  std::size_t i = m_past.size() - 1;
  while (i > 0 && now.time - m_past[i].time < kSettle - 1e-6) --i;
  if (!now.known || now.time - m_past[i].time < kSettle - 1e-6) return false;
  for (std::size_t k = i; k < m_past.size(); ++k)
    if (!m_past[k].known) return false;
  const Reference& then = m_past[i];
  const double sigma = 2 * RegistrationOptions().sigma;
  const Eigen::Matrix3d covariance =
      now.spent - then.spent +
      Eigen::Matrix3d(Eigen::Vector3d(sigma * sigma, sigma * sigma, 1e-4).asDiagonal());
  return beyondTolerance(relative(then.odometry, now.odometry), relative(then.used, now.used),
                         covariance) < 1;
}

Pose2D OdometryMonitor::coast(double seconds) const {
  return scaled(m_speed, seconds);
}

}  // namespace polemcl
