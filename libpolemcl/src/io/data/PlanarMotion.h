#pragma once
/// \file PlanarMotion.h
/// \brief Motions between scans: what odometry says, and how far it may be off.

#include <Eigen/Core>
#include <random>

#include "core/common/Types.h"

namespace polemcl::io {

/// \brief A planar motion in the robot frame before it.
struct PlanarMotion {
  Pose2D mean;  ///< m, m, rad
  /// Covariance of (x, y, yaw), m², m·rad, rad².
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// \brief `a`, then `b` (given in the robot frame after `a`), as one motion. The covariance is
/// carried over to first order, the two taken as independent.
PlanarMotion composeMotions(const PlanarMotion& a, const PlanarMotion& b);

/// \brief Least standard deviations of noisyMotion(), so that a standing vehicle has a positive
/// definite covariance too.
constexpr double motionFloorMetres = 1e-3, motionFloorRadians = 1e-4;

/// \brief The true motion as an odometer sees it: x, y and yaw each with Gaussian noise of standard
/// deviation K·|component|.
///
/// Draws exactly four numbers from the generator whatever the motion, and turns them into normal
/// deviates itself (Box-Muller; the standard library's distributions differ between compilers).
/// The covariance is diagonal: the variances of that noise plus those of the floors above, to
/// which no noise belongs.
/// \param k Relative noise, >= 0. \throws Error when it is negative or not finite.
PlanarMotion noisyMotion(const Pose2D& trueMotion, double k, std::mt19937_64& generator);

}  // namespace polemcl::io
