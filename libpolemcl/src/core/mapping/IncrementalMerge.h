#pragma once
/// \file IncrementalMerge.h
/// \brief Detections merged into a map, scan by scan.

#include <cstdint>
#include <unordered_map>
#include <vector>

#include <polemcl/core/common/Types.h>

namespace polemcl {

/// \brief Inserts scans into one map. Its cells of the plane follow the poles, so a scan costs as
/// much in a large map as in a small one.
class IncrementalMerge {
 public:
  /// \param poles The map so far. \param mergeDistance > 0, m.
  IncrementalMerge(const std::vector<MapPole>& poles, double mergeDistance);

  double mergeDistance() const { return m_mergeDistance; }

  /// \brief Merges the detections of one scan, each pole with at most one of them: pairs nearer
  /// than the merge distance are taken nearest first, ties by index. The detections that are left
  /// become new poles of count 1, in their order.
  ///
  /// A merged pole has the mean of its detections as centre, radius and confidence, their lowest
  /// bottom and highest top, and the covariance of that mean.
  /// \param poles The same map as before, changed by this function only.
  /// \param detections_map Finite, map frame.
  void insertScan(std::vector<MapPole>& poles, const std::vector<PoleDetection>& detections_map);

 private:
  /// Number of the square, as wide as the merge distance, in which a place lies, or of a neighbour.
  template <class Place>
  std::uint64_t cellOf(const Place& place, int columns = 0, int rows = 0) const;

  double m_mergeDistance;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> m_cells;  ///< indices of poles
};

}  // namespace polemcl
