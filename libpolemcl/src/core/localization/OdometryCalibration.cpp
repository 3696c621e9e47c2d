#include "core/localization/OdometryCalibration.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/common/Transform.h"

namespace polemcl {
namespace {

constexpr double kLength = 8;  // distance over which motions are compared, m
constexpr double kScaleWalk =
    0.0005;  // growth of the scale's standard deviation, per root of a metre
constexpr double kYawWalk = 1.7e-5;  // growth of the yaw bias's, rad/m per root of a metre
constexpr double kRest = 0.001;      // m, rad: smaller motions are those of a vehicle that stands
constexpr double kTogether = 3;      // distance over which errors of motions add up, m
constexpr double kFurthest = 4;      // greatest innovation that is used, standard deviations
constexpr double kNone = 0.8;        // probability that the odometry has no such error

Eigen::Vector3d asVector(const Pose2D& pose) {
  return {pose.x, pose.y, pose.yaw};
}

Pose2D corrected(const Pose2D& motion, double scale, double yaw) {
  return {(1 + scale) * motion.x, (1 + scale) * motion.y, motion.yaw + yaw * motion.x};
}

/// Probability that the odometry has an error, from the density at zero before and after the
/// comparisons (Dickey 1971).
double probabilityOfError(double value, double variance, double sigmaBefore) {
  const double densities =
      sigmaBefore / std::sqrt(variance) * std::exp(-value * value / (2 * variance));
  return (1 - kNone) / (1 - kNone + kNone * densities);
}

/// Covariance of a pose's own error, in the frame of that pose.
Eigen::Matrix3d inOwnFrame(const PoseWithCovariance& pose) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = rotationOf(-pose.mean.yaw);
  return turn * pose.covariance * turn.transpose();
}

/// Covariance of the motion between two poses with independent errors, in the frame of the first.
Eigen::Matrix3d motionCovariance(const PoseWithCovariance& from, const PoseWithCovariance& to) {
  const Pose2D motion = relative(from.mean, to.mean);
  Eigen::Matrix3d carried = Eigen::Matrix3d::Identity(), turn = Eigen::Matrix3d::Identity();
  carried(0, 2) = -motion.y;
  carried(1, 2) = motion.x;
  turn.topLeftCorner<2, 2>() = rotationOf(motion.yaw);
  return carried * inOwnFrame(from) * carried.transpose() +
         turn * inOwnFrame(to) * turn.transpose();
}

}  // namespace

OdometryCalibration::OdometryCalibration(bool enabled) : m_enabled(enabled) {
  m_errors.covariance = Eigen::Vector2d(scaleSigma, yawSigma).cwiseAbs2().asDiagonal();
}

OdometryErrors OdometryCalibration::errors() const {
  OdometryErrors result = m_errors;
  const double scale = probabilityOfError(m_errors.scale, m_errors.covariance(0, 0), scaleSigma),
               yaw = probabilityOfError(m_errors.yaw, m_errors.covariance(1, 1), yawSigma);
  result.scale *= scale;
  result.yaw *= yaw;
  result.covariance(0, 0) += scale * (1 - scale) * m_errors.scale * m_errors.scale;
  result.covariance(1, 1) += yaw * (1 - yaw) * m_errors.yaw * m_errors.yaw;
  return result;
}

/// Covariance of a motion by what is not known of the errors.
Eigen::Matrix3d OdometryCalibration::unknownOf(const Pose2D& motion) const {
  Eigen::Matrix<double, 3, 2> byErrors;
  byErrors << motion.x, 0, motion.y, 0, 0, motion.x;
  return symmetrized<3>(byErrors * errors().covariance * byErrors.transpose());
}

CorrectedMotion OdometryCalibration::correct(const Pose2D& motion,
                                             const Eigen::Matrix3d& covariance) const {
  if (!m_enabled) return {motion, covariance};
  // The errors of successive motions are the same ones: over a distance they add up as they are,
  // not as their squares. A filter takes motions for independent, so each gets its share of the
  // sum.
  const double metres = std::hypot(motion.x, motion.y);
  const double share = metres > 0 ? std::max(1.0, kTogether / metres) : 1;
  const OdometryErrors known = errors();
  return {corrected(motion, known.scale, known.yaw), covariance + share * unknownOf(motion)};
}

Eigen::Matrix3d OdometryCalibration::unseenCovariance(const Pose2D& motion, double unseen) const {
  const double metres = std::hypot(motion.x, motion.y);
  // Shares that grow as twice the distance add up to its square.
  const double together = 2 * unseen + metres;
  if (!m_enabled || !(metres > 0) || together <= kTogether) return Eigen::Matrix3d::Zero();
  return (together - std::max(metres, kTogether)) / metres * unknownOf(motion);
}

void OdometryCalibration::add(const Pose2D& motion, const Eigen::Matrix3d& covariance,
                              const PoseWithCovariance* estimate) {
  if (!m_enabled) return;
  const double metres = std::hypot(motion.x, motion.y);
  m_errors.covariance(0, 0) += metres * kScaleWalk * kScaleWalk;
  m_errors.covariance(1, 1) += metres * kYawWalk * kYawWalk;
  if (!estimate) {
    m_begun = false;
    return;
  }
  if (m_begun) {
    const bool rests = metres < kRest && std::abs(motion.yaw) < kRest;
    if (rests && !m_steps.empty())
      addRest(motion, covariance);
    else
      m_steps.push_back({motion, covariance});
    m_driven += metres;
    if (m_driven < kLength) return;
    compare(*estimate);
  }
  m_begin = *estimate;
  m_begun = true;
  m_steps.clear();
  m_driven = 0;
}

/// A step at rest becomes part of the one before: a vehicle may be parked for days.
void OdometryCalibration::addRest(const Pose2D& motion, const Eigen::Matrix3d& covariance) {
  Step& last = m_steps.back();
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = rotationOf(last.motion.yaw);
  last.motion = compose(last.motion, motion);
  last.covariance += turn * covariance * turn.transpose();
}

/// The motion of all steps, corrected.
Pose2D OdometryCalibration::chain(double scale, double yaw) const {
  Pose2D pose;
  for (const Step& step : m_steps) pose = compose(pose, corrected(step.motion, scale, yaw));
  return pose;
}

/// Covariance of the motion of all steps by their own, in the frame of the first.
Eigen::Matrix3d OdometryCalibration::walkedCovariance() const {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  Pose2D pose;
  for (const Step& step : m_steps) {
    const Pose2D next = compose(pose, corrected(step.motion, m_errors.scale, m_errors.yaw));
    Eigen::Matrix3d carried = Eigen::Matrix3d::Identity(), turn = Eigen::Matrix3d::Identity();
    carried(0, 2) = pose.y - next.y;
    carried(1, 2) = next.x - pose.x;
    turn.topLeftCorner<2, 2>() = rotationOf(pose.yaw);
    covariance =
        carried * covariance * carried.transpose() + turn * step.covariance * turn.transpose();
    pose = next;
  }
  return covariance;
}

/// Kalman update with the motion from m_begin to `estimate`.
void OdometryCalibration::compare(const PoseWithCovariance& estimate) {
  const Pose2D expected = chain(m_errors.scale, m_errors.yaw);
  constexpr double small = 1e-6;
  Eigen::Matrix<double, 3, 2> H;
  const auto derivative = [&](const Pose2D& changed) {
    Eigen::Vector3d change = asVector(changed) - asVector(expected);
    change.z() = wrapAngle(change.z());
    return Eigen::Vector3d(change / small);
  };
  H.col(0) = derivative(chain(m_errors.scale + small, m_errors.yaw));
  H.col(1) = derivative(chain(m_errors.scale, m_errors.yaw + small));
  Eigen::Matrix3d R = motionCovariance(m_begin, estimate);
  R += walkedCovariance();
  Eigen::Vector3d innovation = asVector(relative(m_begin.mean, estimate.mean)) - asVector(expected);
  innovation.z() = wrapAngle(innovation.z());
  const Eigen::Matrix3d S = H * m_errors.covariance * H.transpose() + R;
  const Eigen::Matrix3d inverse = S.inverse();
  if (!(innovation.dot(inverse * innovation) < kFurthest * kFurthest)) return;
  const Eigen::Matrix<double, 2, 3> gain = m_errors.covariance * H.transpose() * inverse;
  const Eigen::Vector2d change = gain * innovation;
  m_errors.scale += change.x();
  m_errors.yaw += change.y();
  m_errors.covariance =
      symmetrized<2>((Eigen::Matrix2d::Identity() - gain * H) * m_errors.covariance);
}

}  // namespace polemcl
