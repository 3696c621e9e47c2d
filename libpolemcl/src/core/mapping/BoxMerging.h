#pragma once
/// \file BoxMerging.h
/// \brief Groups of observations whose boxes overlap, as in the authors' program.

#include <cstdint>
#include <vector>

#include "core/mapping/LandmarkFusion.h"

namespace polemcl {

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
