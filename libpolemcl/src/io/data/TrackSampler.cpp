#include "io/data/TrackSampler.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/common/PoseInterpolation.h"
#include "io/file/TextFile.h"

namespace polemcl::io {

Eigen::Isometry3d interpolate(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b,
                              double share) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = a.translation() + share * (b.translation() - a.translation());
  const Eigen::Quaterniond from(a.linear()), to(b.linear());
  pose.linear() = from.slerp(share, to).normalized().toRotationMatrix();
  return pose;
}

TrackSampler::TrackSampler(std::vector<double> times, double maxGap)
    : m_times(std::move(times)), m_maxGap(maxGap), m_poses(m_times.size()) {}

bool TrackSampler::add(double time, const Eigen::Isometry3d& pose) {
  if (m_samples > 0 && !(time > m_lastTime)) return false;
  for (; m_next < m_times.size() && m_times[m_next] <= time + sampleTolerance; ++m_next) {
    const double wanted = m_times[m_next], gap = time - m_lastTime;
    if (std::abs(time - wanted) <= sampleTolerance) {
      m_poses[m_next] = pose;
    } else if (m_samples > 0 && gap <= m_maxGap) {
      m_poses[m_next] = interpolate(m_lastPose, pose, (wanted - m_lastTime) / gap);
    }
  }
  if (m_samples++ == 0) m_firstTime = time;
  m_lastTime = time;
  m_lastPose = pose;
  return true;
}

std::size_t TrackSampler::found() const {
  return static_cast<std::size_t>(
      std::count_if(m_poses.begin(), m_poses.end(), [](const auto& pose) { return !!pose; }));
}

std::string TrackSampler::span() const {
  if (m_samples == 0) return "none";
  return fixed(m_firstTime, 3) + " ... " + fixed(m_lastTime, 3) + " s";
}

}  // namespace polemcl::io
