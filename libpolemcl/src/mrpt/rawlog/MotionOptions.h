#pragma once
/// \file MotionOptions.h
/// \brief Uncertainty of odometry if the rawlog does not state it.

#include <Eigen/Core>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>
#include "core/common/Binder.h"

namespace polemcl {

/// \brief Noise of odometry. `[motion]` in INI files. The first six describe readings that come
/// without a covariance (`CObservationOdometry`); the last scales every covariance.
struct POLEMCL_EXPORT MotionOptions {
  double xyPerMetre = 0.05;     ///< σ of x and y per metre driven, m/m (`xy_per_m`)
  double xyPerRadian = 0.05;    ///< σ of x and y per radian turned, m/rad (`xy_per_rad`)
  double yawPerMetre = 0.0035;  ///< σ of the heading per metre driven, rad/m (`yaw_per_m_deg`)
  double yawPerRadian = 0.05;   ///< σ of the heading per radian turned, rad/rad (`yaw_per_rad`)
  double minXy = 0.005;         ///< added to σ of x and y for each motion, m; no setting
  double minYaw = 0.00087;      ///< added to σ of the heading for each motion, rad; no setting
  double covarianceFactor = 1;  ///< on all covariances, also those of the rawlog (paper, NCLT: 4)
};

/// \brief Diagonal covariance of (x, y, yaw), m, m, rad, for a motion without one: σ_xy = minXy +
/// xyPerMetre·d + xyPerRadian·|yaw|, σ_yaw in the same way, times covarianceFactor.
/// \param motion In the robot frame before the motion.
POLEMCL_EXPORT Eigen::Matrix3d motionCovariance(const Pose2D& motion, const MotionOptions& options);

POLEMCL_EXPORT void bind(Binder& binder, MotionOptions& options);  ///< `[motion]`

}  // namespace polemcl
