#pragma once
/// \file SegmentClustering.h
/// \brief Step B2, scan-line method: segments of several beams, one above the other, make a
/// candidate.

#include <cstdint>
#include <vector>

#include "core/extraction/scan_line/ScanKernels.h"
#include "core/extraction/scan_line/ScanLineSegmenter.h"

namespace polemcl {

/// \brief Segments that stand above one another: indices into the segments, topmost first.
/// Borrowed.
struct SegmentCluster {
  const std::uint32_t* first = nullptr;
  std::size_t count = 0;
  const std::uint32_t* begin() const { return first; }
  const std::uint32_t* end() const { return first + count; }
  std::uint32_t top() const { return first[0]; }
  std::uint32_t bottom() const { return first[count - 1]; }
};

/// \brief Clusters the segments from the top row down; every segment joins the nearest cluster
/// above it whose last segment lies within reach, or starts its own. Keeps its buffers between
/// scans.
class SegmentClustering {
 public:
  SegmentClustering(const SensorModel& sensor, const ScanLineOptions& options);
  /// \brief Clusters of at least two segments, in the order of their topmost segments.
  /// \param segments As ScanLineSegmenter gives them: rows ascending.
  /// \return Valid until the next call.
  const std::vector<SegmentCluster>& cluster(const std::vector<ScanLineSegment>& segments);

 private:
  static constexpr std::uint32_t kNone = ~0u;
  /// A growing cluster: its segments, and where its lower end, its tip, is kept.
  struct Growing {
    std::uint32_t first = 0, last = 0, count = 0;
    std::uint32_t block = 0, slot = 0;
  };
  std::uint32_t cell(float x, float y) const;
  void findTips(const ScanLineSegment* segments, std::size_t count);
  TipGrid grid() const;
  bool isGone(std::uint32_t cluster, std::int32_t row) const;
  void add(std::uint32_t i, const ScanLineSegment& segment, float gap, std::uint32_t cluster);
  void enter(std::uint32_t cluster, const ScanLineSegment& segment, float gap);
  void moveTip(std::uint32_t cluster, const ScanLineSegment& segment, float gap);
  std::uint32_t freeBlock(std::uint32_t cell);
  void collect();

  float m_reach, m_gap, m_cellsPerMetre, m_middle;
  std::uint32_t m_cells;               ///< of the square grid, per side
  std::vector<float> m_beamGap;        ///< per row: two beams apart, as a share of range
  std::vector<TipQuery> m_queries;     ///< of the segments of one row
  std::vector<std::uint32_t> m_found;  ///< the cluster of each query
  std::vector<Growing> m_growing;
  std::vector<TipBlock> m_blocks;      ///< number 0 stays empty
  std::vector<std::uint32_t> m_block;  ///< per cell of the plane: its first block, or 0
  std::vector<std::uint32_t> m_below;  ///< per segment: the next one down its cluster
  std::vector<std::uint32_t> m_members;
  std::vector<SegmentCluster> m_clusters;
};

}  // namespace polemcl
