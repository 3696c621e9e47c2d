#include "mrpt/rawlog/OdometryTrack.h"

#include <iterator>

namespace polemcl {

std::optional<Pose2D> OdometryTrack::at(double time) const {
  const auto after = m_readings.lower_bound(time);  // at or after
  if (after == m_readings.end()) {
    if (m_readings.empty() || time - m_readings.rbegin()->first > reach) return std::nullopt;
    return m_readings.rbegin()->second;
  }
  if (after->first == time) return after->second;
  if (after == m_readings.begin()) {
    if (after->first - time > reach) return std::nullopt;
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
