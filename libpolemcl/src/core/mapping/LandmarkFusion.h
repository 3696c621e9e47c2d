#pragma once
/// \file LandmarkFusion.h
/// \brief Several sightings of one pole -> one pole.

#include <vector>

#include <polemcl/core/common/Types.h>

namespace polemcl {

/// \brief One detection in the map frame.
struct LandmarkObservation {
  PoleDetection pole;      ///< x, y and covariance in the map frame, the scan's pose error included
  std::uint32_t view = 0;  ///< the scan; a pole has at most one sighting of each
};

/// \brief Centre of the sightings: mean by inverse covariance times confidence, without outliers.
///
/// From the median on, sightings beyond the 99 % ellipse of their covariance are left out, all
/// ellipses widened where the scatter says that covariances promise too much.
/// \param members Indices into `sightings`, at least one.
/// \param covariance If given: of the mean, widened by the scatter likewise; m².
/// \param kept If given: the members that were not left out, in the order of `members`.
Eigen::Vector2d fusedCentre(const std::vector<LandmarkObservation>& sightings,
                            const std::vector<std::uint32_t>& members,
                            Eigen::Matrix2d* covariance = nullptr,
                            std::vector<std::uint32_t>* kept = nullptr);

/// \brief The pole: fused centre and covariance; radius the mean over the same sightings; bottom
/// and top the 10 % and 90 % quantiles (the rare far too high one is a branch, the low one a hidden
/// foot); confidence the mean; count the number of sightings.
MapPole fuse(const std::vector<LandmarkObservation>& sightings,
             const std::vector<std::uint32_t>& members);

}  // namespace polemcl
