#include "mrpt/rawlog/OdometryTrack.h"

#include <cmath>
#include <iterator>

namespace polemcl {

void OdometryTrack::add(double time, const Pose2D& pose) {
  Pose2D joined = compose(m_origin, pose);
  if (isJump(time, joined)) {
    ++m_jumps;
    joined = goneOn(time);
    m_origin = compose(joined, relative(pose, {}));
  }
  m_readings[time] = joined;
}

/// Only of a reading later than all others: one that comes late has its neighbours already.
bool OdometryTrack::isJump(double time, const Pose2D& pose) const {
  if (m_readings.empty() || time < m_readings.rbegin()->first) return false;
  const auto& [last, before] = *m_readings.rbegin();
  const Pose2D step = relative(before, pose);
  const double dt = time - last;
  return std::hypot(step.x, step.y) > kNearestJump + kFastest * dt ||
         std::abs(step.yaw) > kLeastTurn + kFastestTurn * dt;
}

/// The pose at a time after the readings if the last motion goes on.
Pose2D OdometryTrack::goneOn(double time) const {
  const auto last = m_readings.rbegin(), before = std::next(last);
  if (before == m_readings.rend()) return last->second;
  const Pose2D step = relative(before->second, last->second);
  const double share = (time - last->first) / (last->first - before->first);
  return compose(last->second, {share * step.x, share * step.y, share * step.yaw});
}

std::optional<Pose2D> OdometryTrack::at(double time) const {
  const auto after = m_readings.lower_bound(time);  // at or after
  if (after == m_readings.end()) {
    if (m_readings.empty() || time - m_readings.rbegin()->first > kReach) return std::nullopt;
    return m_readings.rbegin()->second;
  }
  if (after->first == time) return after->second;
  if (after == m_readings.begin()) {
    if (after->first - time > kReach) return std::nullopt;
    return after->second;
  }
  const auto before = std::prev(after);
  const double share = (time - before->first) / (after->first - before->first);
  const Pose2D step = relative(before->second, after->second);
  return compose(before->second, {share * step.x, share * step.y, share * step.yaw});
}

void OdometryTrack::forgetBefore(double time) {
  const auto after = m_readings.upper_bound(time);
  if (after == m_readings.begin()) return;
  m_readings.erase(m_readings.begin(), std::prev(after));
}

}  // namespace polemcl
