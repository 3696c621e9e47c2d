#include "mrpt/rawlog/MotionOptions.h"

#include <cmath>

namespace polemcl {

void MotionOptions::validate() const {
  const auto notNegative = [](const char* name, double value) {
    if (!(std::isfinite(value) && value >= 0))
      throw Error(std::string(name) + " is " + std::to_string(value) + "; allowed is >= 0");
  };
  notNegative("xy_per_m", xyPerMetre);
  notNegative("xy_per_rad", xyPerRadian);
  notNegative("yaw_per_m_deg", yawPerMetre);
  notNegative("yaw_per_rad", yawPerRadian);
  notNegative("min_xy_m", minXy);
  notNegative("min_yaw_deg", minYaw);
  if (!(std::isfinite(covarianceFactor) && covarianceFactor > 0))
    throw Error("covariance_factor is " + std::to_string(covarianceFactor) + "; allowed is > 0");
}

Eigen::Matrix3d motionCovariance(const Pose2D& motion, const MotionOptions& options) {
  const double distance = std::hypot(motion.x, motion.y);
  const double turn = std::abs(motion.yaw);
  const double xy = options.minXy + options.xyPerMetre * distance + options.xyPerRadian * turn;
  const double yaw = options.minYaw + options.yawPerMetre * distance + options.yawPerRadian * turn;
  return options.covarianceFactor * Eigen::Vector3d(xy * xy, xy * xy, yaw * yaw).asDiagonal();
}

void bind(Binder& b, MotionOptions& o) {
  b.section("motion", "Noise of odometry that comes without a covariance");
  b.number("xy_per_m", o.xyPerMetre, Range::atLeast(0), "m/m", "sigma of x, y per metre driven");
  b.number("xy_per_rad", o.xyPerRadian, Range::atLeast(0), "m/rad",
           "sigma of x, y per radian turned");
  b.angleDeg("yaw_per_m_deg", o.yawPerMetre, Range::atLeast(0),
             "sigma of the heading per metre driven");
  b.number("yaw_per_rad", o.yawPerRadian, Range::atLeast(0), "rad/rad",
           "the same per radian turned");
  b.number("min_xy_m", o.minXy, Range::atLeast(0), "m", "added to sigma of x, y each time");
  b.angleDeg("min_yaw_deg", o.minYaw, Range::atLeast(0), "added to sigma of the heading each time");
  b.number("covariance_factor", o.covarianceFactor, Range::above(0), "",
           "on all covariances, stored too");
  b.check(o);
}

}  // namespace polemcl
