#include "mrpt/filter/MotionAction.h"

#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "core/common/Covariance.h"
#include "core/common/DetectionCheck.h"
#include "core/common/PoleIndex.h"

namespace polemcl {

namespace {

bool isFinite(const PoseWithCovariance& motion) {
  return std::isfinite(motion.mean.x) && std::isfinite(motion.mean.y) &&
         std::isfinite(motion.mean.yaw) && motion.covariance.allFinite();
}

double metresOf(const PoseWithCovariance& motion) {
  return std::hypot(motion.mean.x, motion.mean.y);
}

/// Standard deviations of a motion, m and rad.
struct Sigmas {
  explicit Sigmas(const Eigen::Matrix3d& covariance)
      : metres(std::sqrt(std::max({0.0, covariance(0, 0), covariance(1, 1)}))),
        radians(std::sqrt(std::max(0.0, covariance(2, 2)))) {}
  bool areAllowed() const { return metres <= kMaxMotionMetres && radians <= kMaxMotionRadians; }
  double metres, radians;
};

void requireFinite(const PoseWithCovariance& motion) {
  if (!isFinite(motion)) throw Error("the motion is not finite: check the odometry");
  std::ostringstream text;
  if (!(metresOf(motion) <= kMaxMotionStep))
    text << "the motion is " << metresOf(motion) << " m long; at most " << kMaxMotionStep << " m";
  else if (!(std::abs(motion.mean.yaw) <= kMaxMotionTurn))
    text << "the motion turns by " << motion.mean.yaw << " rad; at most " << kMaxMotionTurn
         << " rad";
  else
    return;
  text << " from one scan to the next are allowed: check the odometry";
  throw Error(text.str());
}

void requireVelocity(const Velocity& velocity, const std::vector<PoleDetection>& poles,
                     const std::string& where) {
  if (!(std::abs(velocity.x) <= kMaxVelocity && std::abs(velocity.y) <= kMaxVelocity &&
        std::abs(velocity.yaw) <= kMaxVelocity))
    throw Error(where +
                ": the velocity is not finite, or above 1e9 m/s or rad/s: check the odometry");
  const double speed = std::hypot(velocity.x, velocity.y);
  for (std::size_t i = 0; i < poles.size(); ++i)
    if (speed * std::abs(poles[i].timeOffset) > PoleIndex::farthest)
      throw Error(where + ": the velocity moves pole " + std::to_string(i) +
                  " by more than 1e9 m: check the odometry");
}

bool isUsable(const Pose2D& pose) {
  return std::abs(pose.x) <= PoleIndex::farthest && std::abs(pose.y) <= PoleIndex::farthest &&
         std::isfinite(pose.yaw);
}

void requireCovariance(const Eigen::Matrix3d& covariance) {
  if (!isCovariance(covariance))
    throw Error(
        "the covariance of the motion is not symmetric or has a negative eigenvalue: check the "
        "odometry");
}

void requireCertain(const Eigen::Matrix3d& covariance) {
  const Sigmas sigmas(covariance);
  if (sigmas.areAllowed()) return;
  std::ostringstream text;
  text << "the motion is too uncertain, with standard deviations of " << sigmas.metres << " m and "
       << sigmas.radians << " rad; at most " << kMaxMotionMetres << " m and " << kMaxMotionRadians
       << " rad are allowed: check the odometry, or [motion]";
  throw Error(text.str());
}

void requireMotion(const PoseWithCovariance& motion) {
  requireFinite(motion);
  requireCovariance(motion.covariance);
  requireCertain(motion.covariance);
}

}  // namespace

bool isBeyondLimits(const PoseWithCovariance& motion) {
  if (!isFinite(motion) || !isCovariance(motion.covariance)) return false;
  return metresOf(motion) > kMaxMotionStep || !Sigmas(motion.covariance).areAllowed();
}

mrpt::obs::CActionCollection::Ptr makeMotionAction(const PoseWithCovariance& motion,
                                                   const FilterOptions& options) {
  requireMotion(motion);
  // The floor of 1 µm and 1 µrad keeps rounding errors from making eigenvalues negative.
  const double xy = options.extraSigma * options.extraSigma + 1e-12;
  const double yaw = options.extraSigmaYaw * options.extraSigmaYaw + 1e-12;
  const Eigen::Matrix3d extra = Eigen::Vector3d(xy, xy, yaw).asDiagonal();
  mrpt::obs::CActionRobotMovement2D movement;
  movement.estimationMethod = mrpt::obs::CActionRobotMovement2D::emScan2DMatching;
  movement.poseChange = mrpt::poses::CPosePDFGaussian::Create(
      mrpt::poses::CPose2D(motion.mean.x, motion.mean.y, motion.mean.yaw),
      mrpt::math::CMatrixDouble33(Eigen::Matrix3d(motion.covariance + extra)));
  auto action = mrpt::obs::CActionCollection::Create();
  action->insert(movement);
  return action;
}

void requireStep(const PoleScan& scan, std::optional<double> before) {
  const std::string when = std::to_string(scan.time) + " s";
  if (!isTimeInSeconds(scan.time)) throw Error("a scan at " + when + ": " + kTimeAllowed);
  const double last = before.value_or(-std::numeric_limits<double>::infinity());
  if (scan.time <= last)
    throw Error("time does not increase: a scan at " + when + " comes after one at " +
                std::to_string(last) + " s");
  for (std::size_t i = 0; i < scan.poles_robot.size(); ++i)
    if (const char* fault = faultOf(scan.poles_robot[i]))
      throw Error("scan at " + when + ": pole " + std::to_string(i) + " has " + fault);
  if (scan.velocity) requireVelocity(*scan.velocity, scan.poles_robot, "scan at " + when);
  if (!isUsable(scan.pose_robot_sensor))
    throw Error("scan at " + when + ": the sensor pose is not finite, or more than 1e9 m away");
  if (!before) return;
  if (!scan.motion)
    throw Error("no motion leads to the scan at " + when +
                ": the filter needs odometry; was "
                "there any when the scans were recorded or imported?");
  try {
    requireMotion(*scan.motion);
  } catch (const Error& error) {
    throw Error("scan at " + when + ": " + error.what());
  }
}

}  // namespace polemcl
