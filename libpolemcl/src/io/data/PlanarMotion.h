#pragma once
/// \file PlanarMotion.h
/// \brief Motions between scans as measured by odometry, with their uncertainty.

#include <Eigen/Core>
#include <optional>
#include <random>
#include <vector>

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

/// \brief Steps of odometry, one after the other, with independent errors.
class MotionSteps {
 public:
  /// \brief Adds a step from `begin` to `end`, s. Its times are not before those of the last one;
  /// there may be gaps.
  void add(double begin, double end, const PoseWithCovariance& motion);

  /// \brief Drops steps that ended by `time`, s.
  void forgetBefore(double time);

  /// \brief Covariance of (x, y, yaw) of the motion between two times: those of the steps,
  /// composed. A step that lies only partly in the interval contributes in proportion. Gaps count
  /// as the rest of the interval does. \return Nothing if steps cover less than half of the
  /// interval.
  std::optional<Eigen::Matrix3d> covarianceBetween(double begin, double end) const;

 private:
  struct Step {
    double begin = 0, end = 0;  ///< s
    PoseWithCovariance motion;
  };
  std::vector<Step> m_steps;
};

/// \brief Of a motion whose odometry states none. Standard deviations: this share of the way, along
/// it and across; of the heading this share of the turn, and of a degree for each metre. Own
/// choice.
Eigen::Matrix3d assumedCovariance(const Pose2D& motion, double share);

/// \brief The variances of motionFloorMetres and motionFloorRadians.
Eigen::Matrix3d floorCovariance();

}  // namespace polemcl::io
