#pragma once
/// \file ObservationClustering.h
/// \brief Groups observations of the same pole: by gated distance to its centre, one per scan.
///
/// Overlapping boxes merged as connected components, as the authors' program does, run together
/// in chains. Here an observation belongs to a pole by its distance to the pole's own centre, and
/// two of one scan are two poles.

#include <cstdint>
#include <vector>

#include "core/mapping/LandmarkFusion.h"

namespace polemcl {

struct ClusteringOptions {
  double mergeDistance = 0.5;  ///< gate round the centre, m
  double apartShare = 0.25;    ///< see PoleMapOptions
};

/// \brief Groups of indices into `observations`, sorted by their fused centre's x then y.
///
/// Groups grow from where observations are densest; then each scan's observations are dealt out to
/// the nearest centres, one each, until nothing changes; then groups with centres nearer than the
/// gate are merged unless they were seen together often enough to be two poles. In a group: all
/// members lie nearer than the gate to its fused centre, and no two are of one scan. An observation
/// that no group takes (a second one of the same pole in one scan) is left out. Work grows with the
/// number of observations times the observations of a pole. The result does not depend on the order
/// of the observations.
std::vector<std::vector<std::uint32_t>> clusterObservations(
    const std::vector<LandmarkObservation>& observations, const ClusteringOptions& options);

/// \brief Connected components of overlapping boxes. A box is the square round an observation's
/// centre that reaches one radius to each side; boxes that touch overlap. Chains are one component,
/// and one scan may have several members. \return Groups of indices into `observations`, each
/// ascending, ordered by their first index. Work
///         grows with the number of observations times those within a pole's width.
std::vector<std::vector<std::uint32_t>> joinOverlappingBoxes(
    const std::vector<LandmarkObservation>& observations);

/// \brief The pole of a group: plain means of centre, radius, bottom, top and confidence; count the
/// number of members; covariance that of the mean of independent observations.
MapPole plainMean(const std::vector<LandmarkObservation>& observations,
                  const std::vector<std::uint32_t>& members);

}  // namespace polemcl
