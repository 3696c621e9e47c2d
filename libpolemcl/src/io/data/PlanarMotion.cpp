#include "io/data/PlanarMotion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/common/Angles.h"
#include "io/file/TextFile.h"

namespace polemcl::io {

PoseWithCovariance composeMotions(const PoseWithCovariance& a, const PoseWithCovariance& b) {
  const double c = std::cos(a.mean.yaw), s = std::sin(a.mean.yaw);
  const double x = b.mean.x, y = b.mean.y;
  // Derivatives of a ⊕ b with respect to a and to b.
  Eigen::Matrix3d byA, byB;
  byA << 1, 0, -s * x - c * y,  //
      0, 1, c * x - s * y,      //
      0, 0, 1;
  byB << c, -s, 0,  //
      s, c, 0,      //
      0, 0, 1;
  PoseWithCovariance result;
  result.mean = compose(a.mean, b.mean);
  const Eigen::Matrix3d sum =
      byA * a.covariance * byA.transpose() + byB * b.covariance * byB.transpose();
  // Rounding errors leave the matrix slightly asymmetric.
  result.covariance = 0.5 * (sum + sum.transpose());
  return result;
}

namespace {

/// Two independent standard normal deviates from two draws (Box and Muller 1958).
std::array<double, 2> normalPair(std::mt19937_64& generator) {
  const auto uniform = [&] { return static_cast<double>(generator() >> 11) * 0x1p-53; };
  const double radius = std::sqrt(-2 * std::log(1 - uniform()));  // 1 - u is in (0, 1]
  const double angle = 2 * M_PI * uniform();
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

PoseWithCovariance shareOf(const PoseWithCovariance& motion, double share) {
  return {{share * motion.mean.x, share * motion.mean.y, share * motion.mean.yaw},
          share * motion.covariance};
}

}  // namespace

PoseWithCovariance noisyMotion(const Pose2D& trueMotion, double k, std::mt19937_64& generator) {
  if (!(k >= 0) || !std::isfinite(k)) {
    throw Error("odometry noise " + significant(k, 6) +
                " is not allowed: a relative standard deviation >= 0 is (0.02 for 2 %)");
  }
  const auto [n0, n1] = normalPair(generator);
  const auto [n2, unused] = normalPair(generator);
  static_cast<void>(unused);
  const Eigen::Vector3d sigma =
      k * Eigen::Vector3d(trueMotion.x, trueMotion.y, trueMotion.yaw).cwiseAbs();
  PoseWithCovariance motion;
  motion.mean = {trueMotion.x + sigma[0] * n0, trueMotion.y + sigma[1] * n1,
                 wrapAngle(trueMotion.yaw + sigma[2] * n2)};
  motion.covariance = floorCovariance();
  motion.covariance.diagonal() += sigma.cwiseAbs2();
  return motion;
}

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
