#pragma once
/// \file MotionSteps.h
/// \brief Covariances of motions, from the steps that odometry measured.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "io/data/PlanarMotion.h"

namespace polemcl::io {

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
