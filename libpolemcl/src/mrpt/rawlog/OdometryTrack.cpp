#include "mrpt/rawlog/OdometryTrack.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace polemcl {
namespace {

/// The pose at a time if the motion from one reading to another goes on after it.
template <class Reading>
Pose2D goneOn(const Reading& from, const Reading& to, double time) {
  const Pose2D step = relative(from.second, to.second);
  const double share = (time - to.first) / (to.first - from.first);
  return compose(to.second, {share * step.x, share * step.y, share * step.yaw});
}

}  // namespace

void OdometryTrack::add(double time, const Pose2D& pose) {
  const Pose2D joined = placed(time, pose);
  if (isBreak(time, pose)) {
    ++m_jumps;
    m_origin = compose(joined, relative(pose, {}));
  }
  m_readings[time] = joined;
}

Pose2D OdometryTrack::placed(double time, const Pose2D& pose) const {
  return isBreak(time, pose) ? afterLast(time) : compose(m_origin, pose);
}

/// Whether a reading does not go on from those before.
bool OdometryTrack::isBreak(double time, const Pose2D& pose) const {
  return jumpsTo(time, pose) || isRestart(time, pose);
}

/// Only of a reading later than all others: one that comes late has its neighbours already.
bool OdometryTrack::isJump(double time, const Pose2D& pose) const {
  if (m_readings.empty() || time < m_readings.rbegin()->first) return false;
  const auto& [last, before] = *m_readings.rbegin();
  return isTooFast(relative(before, pose), time - last);
}

bool OdometryTrack::isTooFast(const Pose2D& step, double seconds) {
  return std::hypot(step.x, step.y) > kNearestJump + kFastest * seconds ||
         std::abs(step.yaw) > kLeastTurn + kFastestTurn * seconds;
}

/// After a gap nearly all steps are possible. But one that leads just to the begin of the odometry,
/// where the vehicle was not on its way to, does not look driven.
bool OdometryTrack::isRestart(double time, const Pose2D& pose) const {
  if (m_readings.empty() || time - m_readings.rbegin()->first <= kLongestGap) return false;
  if (std::hypot(pose.x, pose.y) > kNearStart || std::abs(wrapAngle(pose.yaw)) > kTurnedAtStart)
    return false;
  const Pose2D off = relative(afterLast(time), compose(m_origin, pose));
  return std::hypot(off.x, off.y) > kFarFromStart;
}

Pose2D OdometryTrack::afterLast(double time) const {
  const auto last = std::prev(m_readings.end());
  const auto later = m_readings.upper_bound(last->first - kBaseline);
  return later == m_readings.begin() ? last->second : goneOn(*std::prev(later), *last, time);
}

std::optional<Pose2D> OdometryTrack::at(double time) const {
  if (m_readings.empty()) return std::nullopt;
  const auto first = m_readings.begin();
  const auto after = m_readings.lower_bound(time);  // at or after
  const auto nearest = after == m_readings.end() ? std::prev(after) : after;
  if (nearest->first == time) return nearest->second;
  const bool isOutside = after == first || after == m_readings.end();
  if (isOutside && std::abs(time - nearest->first) > kReach) return std::nullopt;
  if (after == first) {
    const auto later = m_readings.lower_bound(first->first + kBaseline);
    return later == m_readings.end() ? first->second : goneOn(*later, *first, time);
  }
  if (after == m_readings.end()) return afterLast(time);
  const auto before = std::prev(after);
  const double share = (time - before->first) / (after->first - before->first);
  const Pose2D step = relative(before->second, after->second);
  return compose(before->second, {share * step.x, share * step.y, share * step.yaw});
}

bool OdometryTrack::isNear(double time) const {
  const auto after = m_readings.lower_bound(time);
  if (after == m_readings.begin() || after == m_readings.end() || after->first == time)
    return at(time).has_value();
  return after->first - std::prev(after)->first <= kLongestGap;
}

void OdometryTrack::clear() {
  m_readings.clear();
  m_origin = {};
}

void OdometryTrack::forgetAfter(double time) {
  m_readings.erase(m_readings.upper_bound(time), m_readings.end());
}

void OdometryTrack::forgetBefore(double time) {
  if (m_readings.empty()) return;
  // What tells how the last motion goes on stays.
  const double oldest = std::min(time, m_readings.rbegin()->first) - kBaseline;
  const auto after = m_readings.upper_bound(oldest);
  if (after != m_readings.begin()) m_readings.erase(m_readings.begin(), std::prev(after));
}

}  // namespace polemcl
