#include <polemcl/mrpt/MotionOptions.h>

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

}  // namespace polemcl
