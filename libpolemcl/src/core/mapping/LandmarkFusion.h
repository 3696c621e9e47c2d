#pragma once
/// \file LandmarkFusion.h
/// \brief Several observations of one pole -> one pole.

#include <vector>

#include <polemcl/core/common/Types.h>

namespace polemcl {

/// \brief One detection in the map frame.
struct LandmarkObservation {
  PoleDetection pole;      ///< x, y and covariance in the map frame, the scan's pose error included
  std::uint32_t scan = 0;  ///< number of the scan; a pole has at most one observation of each
};

/// \brief Centre of the observations: mean by inverse covariance times confidence, without
/// outliers.
///
/// Observations beyond the 99 % ellipse of their covariance are left out, starting from the median.
/// All ellipses are widened where the scatter is larger than the covariances say.
/// \param members Indices into `observations`, at least one.
/// \param covariance If given: covariance of the mean, also widened by the scatter; m².
/// \param inliers If given: the members that were not left out, in the order of `members`.
Eigen::Vector2d fusedCentre(const std::vector<LandmarkObservation>& observations,
                            const std::vector<std::uint32_t>& members,
                            Eigen::Matrix2d* covariance = nullptr,
                            std::vector<std::uint32_t>* inliers = nullptr);

/// \brief The pole: fused centre and covariance; radius the mean over the same observations; bottom
/// and top the 10 % and 90 % quantiles, because rare extremes are branches or hidden feet;
/// confidence the mean; count the number of observations.
MapPole fuse(const std::vector<LandmarkObservation>& observations,
             const std::vector<std::uint32_t>& members);

}  // namespace polemcl
