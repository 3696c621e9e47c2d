#pragma once
/// \file ObservationClustering.h
/// \brief Which sightings show the same pole: by gated distance to its centre, one a view.
///
/// Overlapping boxes merged as connected components, as the first implementation does, run together
/// in chains. Here a sighting belongs to a pole by its distance to the pole's own centre, and two
/// of one scan are two poles.

#include <vector>

#include "core/mapping/LandmarkFusion.h"

namespace polemcl {

struct ClusteringOptions {
  double mergeDistance = 0.5;  ///< gate round the centre, m
  double apartShare = 0.25;    ///< see PoleMapOptions
};

/// \brief Groups of indices into `sightings`, sorted by their fused centre's x then y.
///
/// Groups grow from where sightings are densest; then each scan's sightings are dealt out to the
/// nearest centres, one each, until nothing changes; then groups with centres nearer than the gate
/// are merged unless they were seen together often enough to be two poles. In a group: all members
/// lie nearer than the gate to its fused centre, and no two are of one view. A sighting that no
/// group takes (a second one of the same pole in one scan) is left out.
/// Work grows with the number of sightings times the sightings of a pole. The result does not
/// depend on the order of the sightings.
std::vector<std::vector<std::uint32_t>> clusterObservations(
    const std::vector<LandmarkObservation>& sightings, const ClusteringOptions& options);

}  // namespace polemcl
