#include "io/data/MotionSteps.h"

#include <algorithm>
#include <cmath>

#include "core/common/Angles.h"

namespace polemcl::io {
namespace {

PoseWithCovariance shareOf(const PoseWithCovariance& motion, double share) {
  return {{share * motion.mean.x, share * motion.mean.y, share * motion.mean.yaw},
          share * motion.covariance};
}

}  // namespace

void MotionSteps::add(double begin, double end, const PoseWithCovariance& motion) {
  m_steps.push_back({begin, end, motion});
}

void MotionSteps::forgetBefore(double time) {
  const auto kept = std::find_if(m_steps.begin(), m_steps.end(),
                                 [time](const Step& step) { return step.end > time; });
  m_steps.erase(m_steps.begin(), kept);
}

std::optional<Eigen::Matrix3d> MotionSteps::covarianceBetween(double begin, double end) const {
  auto step = std::upper_bound(m_steps.begin(), m_steps.end(), begin,
                               [](double time, const Step& s) { return time < s.end; });
  PoseWithCovariance sum;
  double covered = 0;
  for (; step != m_steps.end() && step->begin < end; ++step) {
    const double between = std::min(end, step->end) - std::max(begin, step->begin);
    sum = composeMotions(sum, shareOf(step->motion, between / (step->end - step->begin)));
    covered += between;
  }
  if (covered < (end - begin) / 2) return std::nullopt;
  return sum.covariance * ((end - begin) / covered);
}

Eigen::Matrix3d assumedCovariance(const Pose2D& motion, double share) {
  const double way = std::hypot(motion.x, motion.y);
  const Eigen::Array3d turning(0, 0, way * degree);
  const Eigen::Array3d moving(way, way, motion.yaw);
  return (share * share * (moving.square() + turning.square())).matrix().asDiagonal();
}

Eigen::Matrix3d floorCovariance() {
  const Eigen::Vector3d floor(motionFloorMetres, motionFloorMetres, motionFloorRadians);
  return floor.cwiseAbs2().asDiagonal();
}

}  // namespace polemcl::io
