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
constexpr double kLogOdds = -1.4;    // at the start, that the odometry has errors that stay: 0.2
constexpr double kLeastLogOdds = -4, kMostLogOdds = 12;  // errors that begin later are noticed

Eigen::Vector3d asVector(const Pose2D& pose) {
  return {pose.x, pose.y, pose.yaw};
}

Pose2D corrected(const Pose2D& motion, double scale, double yaw) {
  return {(1 + scale) * motion.x, (1 + scale) * motion.y, motion.yaw + yaw * motion.x};
}

/// Logarithm of a normal density, but for a constant.
double logDensity(const Eigen::Vector3d& deviation, const Eigen::Matrix3d& covariance) {
  return -0.5 *
         (deviation.dot(covariance.inverse() * deviation) + std::log(covariance.determinant()));
}

/// Covariance of a motion by what is not known of the odometry's errors.
Eigen::Matrix3d covarianceBy(const Eigen::Matrix2d& errors, const Pose2D& motion) {
  Eigen::Matrix<double, 3, 2> byErrors;
  byErrors << motion.x, 0, motion.y, 0, 0, motion.x;
  return symmetrized<3>(byErrors * errors * byErrors.transpose());
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

OdometryCalibration::OdometryCalibration(bool enabled, bool doubted)
    : m_enabled(enabled),
      m_leastLogOdds(doubted ? kLeastLogOdds : kMostLogOdds),
      m_logOdds(doubted ? kLogOdds : kMostLogOdds) {
  m_errors.covariance = Eigen::Vector2d(scaleSigma, yawSigma).cwiseAbs2().asDiagonal();
}

OdometryErrors OdometryCalibration::errors() const {
  const double probability = 1 / (1 + std::exp(-m_logOdds));
  const Eigen::Vector2d all(m_errors.scale, m_errors.yaw);
  OdometryErrors result = m_errors;
  result.scale *= probability;
  result.yaw *= probability;
  result.covariance += probability * (1 - probability) * all * all.transpose();
  return result;
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
  return {corrected(motion, known.scale, known.yaw),
          covariance + share * covarianceBy(known.covariance, motion)};
}

Eigen::Matrix3d OdometryCalibration::unseenCovariance(const Pose2D& motion, double unseen) const {
  const double metres = std::hypot(motion.x, motion.y);
  // Shares that grow as twice the distance add up to its square.
  const double together = 2 * unseen + metres;
  if (!m_enabled || !(metres > 0) || together <= kTogether) return Eigen::Matrix3d::Zero();
  // Only what stays adds up like this: without what the errors may have changed by since then.
  Eigen::Matrix2d stays = errors().covariance;
  stays(0, 0) = std::max(0.0, stays(0, 0) - unseen * kScaleWalk * kScaleWalk);
  stays(1, 1) = std::max(0.0, stays(1, 1) - unseen * kYawWalk * kYawWalk);
  return (together - std::max(metres, kTogether)) / metres * covarianceBy(stays, motion);
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

/// How far the motion from m_begin to `estimate` is from that of the steps with these errors.
Eigen::Vector3d OdometryCalibration::innovation(const PoseWithCovariance& estimate, double scale,
                                                double yaw) const {
  Eigen::Vector3d result =
      asVector(relative(m_begin.mean, estimate.mean)) - asVector(chain(scale, yaw));
  result.z() = wrapAngle(result.z());
  return result;
}

/// Kalman update with the motion from m_begin to `estimate`. What it says of odometry without such
/// errors is weighed against what the Kalman filter expected.
void OdometryCalibration::compare(const PoseWithCovariance& estimate) {
  const Eigen::Vector3d found = innovation(estimate, m_errors.scale, m_errors.yaw);
  constexpr double small = 1e-6;
  Eigen::Matrix<double, 3, 2> H;
  H.col(0) = (found - innovation(estimate, m_errors.scale + small, m_errors.yaw)) / small;
  H.col(1) = (found - innovation(estimate, m_errors.scale, m_errors.yaw + small)) / small;
  const Eigen::Matrix3d R = motionCovariance(m_begin, estimate) + walkedCovariance();
  const Eigen::Matrix3d S = H * m_errors.covariance * H.transpose() + R;
  const Eigen::Matrix3d inverse = S.inverse();
  if (!(found.dot(inverse * found) < kFurthest * kFurthest)) return;
  const double evidence = logDensity(found, S) - logDensity(innovation(estimate, 0, 0), R);
  if (std::isfinite(evidence))  // covariances may be zero
    m_logOdds = std::clamp(m_logOdds + evidence, m_leastLogOdds, kMostLogOdds);
  const Eigen::Matrix<double, 2, 3> gain = m_errors.covariance * H.transpose() * inverse;
  const Eigen::Vector2d change = gain * found;
  m_errors.scale += change.x();
  m_errors.yaw += change.y();
  m_errors.covariance =
      symmetrized<2>((Eigen::Matrix2d::Identity() - gain * H) * m_errors.covariance);
}

}  // namespace polemcl
