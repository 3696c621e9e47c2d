#pragma once
/// \file PoseEstimate.h
/// \brief One pose from weighted particles: weighted mean, or mean of the best 10 % (the paper).

#include <polemcl/core/Types.h>

#include <Eigen/Core>
#include <vector>

namespace polemcl {

struct PoseWithCovariance {
  Pose2D mean;
  /// Covariance of (x, y, yaw) about the mean, m, m, rad; heading differences wrapped.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// \brief Weighted mean; headings averaged on the circle.
/// \param logWeights Natural logarithms, any offset. \throws Error on empty or mismatched input.
PoseWithCovariance weightedMean(const std::vector<Pose2D>& particles,
                                const std::vector<double>& logWeights);
/// \brief Weighted mean of the best `share` (in (0,1]) of the particles by weight (paper: 0.1),
/// at least one; ties go to the lower index.
PoseWithCovariance bestShareMean(const std::vector<Pose2D>& particles,
                                 const std::vector<double>& logWeights, double share);
/// \brief Effective sample size over the number of particles, in (0, 1].
double effectiveShare(const std::vector<double>& logWeights);

}  // namespace polemcl
