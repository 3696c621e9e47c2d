#pragma once
/// \file SegmentClustering.h
/// \brief Step B2, native: slices of several beams, one above the other, make a candidate.

#include <cstdint>
#include <vector>

#include "core/extraction/scan_line/ScanLineSegmenter.h"

namespace polemcl {

/// \brief Slices that stand above one another: indices into the slices, topmost first. Borrowed.
struct SegmentCluster {
  const std::uint32_t* first = nullptr;
  std::size_t count = 0;
  const std::uint32_t* begin() const { return first; }
  const std::uint32_t* end() const { return first + count; }
  std::uint32_t top() const { return first[0]; }
  std::uint32_t bottom() const { return first[count - 1]; }
};

/// \brief Stacks the slices from the top row down; every slice joins the nearest stack above it
/// whose last slice lies within reach, or starts its own. Keeps its buffers between scans.
class SegmentClustering {
 public:
  SegmentClustering(const SensorModel& sensor, const ScanLineOptions& options);
  /// \brief Stacks of at least two slices, in the order of their topmost slices.
  /// \param slices As ScanLineSegmenter gives them: rows ascending.
  /// \return Valid until the next call.
  const std::vector<SegmentCluster>& stack(const std::vector<ScanLineSegment>& slices);

 private:
  static constexpr std::uint32_t kNone = ~0u;
  /// The lower end of a growing stack.
  struct Tip {
    float x, y, z;
    std::int32_t row;
    std::uint32_t first, last, count;  ///< slices
    std::int32_t cell;
    std::uint32_t next;  ///< tip in the same cell
  };
  std::int32_t cell(float x, float y) const;
  std::uint32_t nearestTip(const ScanLineSegment& slice);
  void enter(std::uint32_t tip);
  void move(std::uint32_t tip);
  void collect();

  float m_reach, m_gap, m_cellsPerMetre, m_middle;
  std::int32_t m_cells;          ///< of the square grid, per side
  std::vector<float> m_beamGap;  ///< per row: two beams apart, as a share of range
  std::vector<Tip> m_tips;
  std::vector<std::uint32_t> m_head;   ///< per cell of the plane: the tip that entered last
  std::vector<std::uint32_t> m_below;  ///< per slice: the next one down its stack
  std::vector<std::uint32_t> m_members;
  std::vector<SegmentCluster> m_stacks;
};

}  // namespace polemcl
