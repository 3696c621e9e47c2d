#include "mrpt/rawlog/MotionOptions.h"

#include <cmath>

#include "core/common/Binder.h"

namespace polemcl {

Eigen::Matrix3d motionCovariance(const Pose2D& motion, const MotionOptions& options) {
  const double distance = std::hypot(motion.x, motion.y);
  const double turn = std::abs(motion.yaw);
  const double xy = options.minXy + options.xyPerMetre * distance + options.xyPerRadian * turn;
  const double yaw = options.minYaw + options.yawPerMetre * distance + options.yawPerRadian * turn;
  return options.covarianceFactor * Eigen::Vector3d(xy * xy, xy * xy, yaw * yaw).asDiagonal();
}

void bind(Binder& b, MotionOptions& o) {
  const Range notNegative = Range::atLeast(0);
  b.section("motion", "Noise of odometry that comes without a covariance", Tier::sensor);
  b.number("covariance_factor", o.covarianceFactor, Range::above(0), "",
           "factor on all covariances of motions, also on those of the rawlog");
  b.tier(Tier::tuning);
  b.number("xy_per_m", o.xyPerMetre, notNegative, "m/m",
           "standard deviation of x and y per metre travelled");
  b.number("xy_per_rad", o.xyPerRadian, notNegative, "m/rad",
           "standard deviation of x and y per radian turned");
  b.angleDeg("yaw_per_m_deg", o.yawPerMetre, notNegative,
             "standard deviation of the heading per metre travelled");
  b.number("yaw_per_rad", o.yawPerRadian, notNegative, "rad/rad",
           "standard deviation of the heading per radian turned");
}

}  // namespace polemcl
