#pragma once
/// \file PlanarMotion.h
/// \brief Motions between scans as measured by odometry, with their uncertainty.

#include <Eigen/Core>
#include <random>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>

namespace polemcl::io {

/// \brief Composes two motions: `a`, then `b` (given in the robot frame after `a`).
/// The covariance is propagated to first order; `a` and `b` are assumed independent.
POLEMCL_EXPORT PoseWithCovariance composeMotions(const PoseWithCovariance& a,
                                                 const PoseWithCovariance& b);

/// \brief Minimum standard deviations of noisyMotion(). They keep the covariance of a standing
/// vehicle positive definite.
constexpr double motionFloorMetres = 1e-3, motionFloorRadians = 1e-4;

/// \brief Odometry measurement of a true motion: x, y and yaw each get Gaussian noise with standard
/// deviation K·|component|.
///
/// The function draws exactly four numbers from the generator, for any motion. It converts them to
/// normal deviates itself (Box-Muller), because the standard library's distributions differ between
/// compilers.
/// The covariance is diagonal: the variances of the noise plus the variances of the minimum
/// standard deviations above. No noise is drawn for those minimums.
/// \param k Relative noise, >= 0. \throws Error when it is negative or not finite.
POLEMCL_EXPORT PoseWithCovariance noisyMotion(const Pose2D& trueMotion, double k,
                                              std::mt19937_64& generator);

}  // namespace polemcl::io
