#pragma once
/// \file ObservationClustering.h
/// \brief Groups observations of the same pole: by gated distance to its centre, one per scan.
///
/// Overlapping boxes merged as connected components, as the authors' program does, run together
/// in chains. Here an observation belongs to a pole by its distance to the pole's own centre, and
/// two of one scan are two poles.

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

}  // namespace polemcl
