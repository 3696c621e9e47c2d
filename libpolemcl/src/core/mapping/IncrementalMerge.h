#pragma once
/// \file IncrementalMerge.h
/// \brief Detections merged into a map, scan by scan.

#include <vector>

#include <polemcl/core/common/PoleIndex.h>
#include <polemcl/core/common/Types.h>

namespace polemcl {

/// \brief Merges the detections of one scan into a map, each pole with at most one of them: pairs
/// nearer than `mergeDistance` (m, > 0) are taken nearest first, ties by index; what is left
/// becomes new poles of count 1, in the order of the detections.
///
/// A merged pole has the mean of its detections as centre, radius and confidence, their lowest
/// bottom and highest top, and the covariance of that mean.
/// \param poles Map frame. \param index Index of exactly these poles.
/// \param detections_map Map frame.
void mergeScan(std::vector<MapPole>& poles, const PoleIndex& index,
               const std::vector<PoleDetection>& detections_map, double mergeDistance);

}  // namespace polemcl
