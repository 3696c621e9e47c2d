#pragma once
/// \file PoseEstimate.h
/// \brief One pose from weighted particles: weighted mean, or mean of the best 10 % (the paper).

#include <Eigen/Core>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>

namespace polemcl {

/// \brief Weighted mean; headings averaged on the circle, and where they cancel out exactly that of
/// the heaviest particle (lower index of equals).
/// \param particles Finite poses, map frame.
/// \param logWeights Natural logarithms, any offset; -infinity is a weight of zero.
/// \throws Error on empty or mismatched input, on a weight that is NaN or +infinity, or when all
///         weights are zero.
POLEMCL_EXPORT PoseWithCovariance weightedMean(const std::vector<Pose2D>& particles,
                                               const std::vector<double>& logWeights);
/// \brief Weighted mean of the best `share` of the particles by weight (paper: 0.1), at least one;
/// ties go to the lower index. The covariance is that of *all* particles about this mean: the
/// spread of the chosen particles alone would be too small. Call it before
/// resampling, which makes all weights equal. \throws Error as weightedMean, or when `share` is
/// outside (0, 1].
POLEMCL_EXPORT PoseWithCovariance bestShareMean(const std::vector<Pose2D>& particles,
                                                const std::vector<double>& logWeights,
                                                double share);
/// \brief Covariance of all particles about a pose, m, m, rad; heading differences wrapped.
/// \throws Error as weightedMean.
POLEMCL_EXPORT Eigen::Matrix3d covarianceAbout(const Pose2D& pose,
                                               const std::vector<Pose2D>& particles,
                                               const std::vector<double>& logWeights);
/// \brief Effective sample size (Σw)²/Σw² over the number of particles, in (0, 1].
/// \throws Error on weights as weightedMean.
POLEMCL_EXPORT double effectiveShare(const std::vector<double>& logWeights);

}  // namespace polemcl
