#include "core/extraction/scan_line/SegmentClustering.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace polemcl {
namespace {

constexpr float kFree = std::numeric_limits<float>::infinity();

constexpr TipBlock emptyBlock() {
  return {{}, {}, {kFree, kFree, kFree, kFree}, {}, {}, 0, 0};
}

}  // namespace

SegmentClustering::SegmentClustering(const SensorModel& sensor, const ScanLineOptions& options)
    : m_reach(static_cast<float>(options.stackReach)),
      m_gap(static_cast<float>(options.stackGap)),
      // Cells twice the reach wide: what lies within reach is in the nearest four.
      m_cellsPerMetre(0.5f / m_reach),
      m_middle(std::ceil(static_cast<float>(options.maxRange) * m_cellsPerMetre) + 1),
      m_cells(2 * static_cast<std::uint32_t>(m_middle)),
      m_block(static_cast<std::size_t>(m_cells) * m_cells) {
  // Beams may be wider apart than the gap allowed: the next beam always counts as neighbour, and
  // one silent beam between is bridged.
  for (int row = 0; row < sensor.beamCount(); ++row)
    m_beamGap.push_back(2.2f * static_cast<float>(sensor.spacingAbove(row)));
}

/// \param x,y In cells from the grid's corner; positive, so that cutting off rounds down.
std::uint32_t SegmentClustering::cell(float x, float y) const {
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(y)) * m_cells +
         static_cast<std::uint32_t>(static_cast<std::int32_t>(x));
}

std::uint32_t SegmentClustering::nearest(const ScanLineSegment& segment, float gap,
                                         NearestTip nearestTip) const {
  const std::uint32_t corner = cell(segment.x * m_cellsPerMetre + m_middle - 0.5f,
                                    segment.y * m_cellsPerMetre + m_middle - 0.5f);
  const std::uint32_t* lower = &m_block[corner];
  return nearestTip(m_blocks.data(), lower, lower + m_cells,
                    {segment.x, segment.y, segment.z, segment.row, gap, m_reach * m_reach});
}

std::uint32_t SegmentClustering::freeBlock(std::uint32_t cell) {
  m_blocks.push_back(emptyBlock());
  m_blocks.back().cell = cell;
  m_blocks.back().next = m_block[cell];
  return m_block[cell] = static_cast<std::uint32_t>(m_blocks.size()) - 1;
}

/// Enters the tip of a cluster where its last segment is. Its slot is a free one, or that of a tip
/// that lies too far above to be joined any more.
void SegmentClustering::enter(std::uint32_t cluster, const ScanLineSegment& segment, float gap) {
  const std::uint32_t c =
      cell(segment.x * m_cellsPerMetre + m_middle, segment.y * m_cellsPerMetre + m_middle);
  const float gone = segment.z + 3 * gap;
  std::uint32_t block = m_block[c], slot = TipBlock::kSlots;
  for (; block != 0; block = m_blocks[block].next) {
    const float* z = m_blocks[block].z;
    slot = static_cast<std::uint32_t>(
        std::find_if(z, z + TipBlock::kSlots, [&](float h) { return h > gone; }) - z);
    if (slot < TipBlock::kSlots) break;
  }
  if (block == 0) {
    block = freeBlock(c);
    slot = 0;
  }
  TipBlock& tips = m_blocks[block];
  tips.x[slot] = segment.x;
  tips.y[slot] = segment.y;
  tips.z[slot] = segment.z;
  tips.row[slot] = segment.row;
  tips.cluster[slot] = cluster;
  m_growing[cluster].block = block;
  m_growing[cluster].slot = slot;
}

void SegmentClustering::moveTip(std::uint32_t cluster, const ScanLineSegment& segment, float gap) {
  TipBlock& tips = m_blocks[m_growing[cluster].block];
  const std::uint32_t slot = m_growing[cluster].slot;
  if (tips.cell !=
      cell(segment.x * m_cellsPerMetre + m_middle, segment.y * m_cellsPerMetre + m_middle)) {
    tips.z[slot] = kFree;
    enter(cluster, segment, gap);
    return;
  }
  tips.x[slot] = segment.x;
  tips.y[slot] = segment.y;
  tips.z[slot] = segment.z;
  tips.row[slot] = segment.row;
}

const std::vector<SegmentCluster>& SegmentClustering::cluster(
    const std::vector<ScanLineSegment>& segments) {
  const NearestTip nearestTip = polemcl::nearestTip();
  m_growing.clear();
  std::fill(m_block.begin(), m_block.end(), 0u);
  m_blocks.clear();
  m_blocks.push_back(emptyBlock());
  m_below.assign(segments.size(), kNone);
  for (std::uint32_t i = 0; i < segments.size(); ++i) {
    const ScanLineSegment& segment = segments[i];
    const float gap = std::max(m_beamGap[segment.row] * segment.rho, m_gap);
    const std::uint32_t c = nearest(segment, gap, nearestTip);
    if (c == kNoCluster) {
      m_growing.push_back({i, i, 1, 0, 0});
      enter(static_cast<std::uint32_t>(m_growing.size()) - 1, segment, gap);
    } else {
      m_below[m_growing[c].last] = i;
      m_growing[c].last = i;
      ++m_growing[c].count;
      moveTip(c, segment, gap);
    }
  }
  collect();
  return m_clusters;
}

/// Lays the chains of two segments and more out as lists.
void SegmentClustering::collect() {
  m_members.clear();
  m_clusters.clear();
  m_members.reserve(m_below.size());  // so that the clusters' pointers stay good
  for (const Growing& chain : m_growing) {
    if (chain.count < 2) continue;
    m_clusters.push_back({m_members.data() + m_members.size(), chain.count});
    for (std::uint32_t i = chain.first; i != kNone; i = m_below[i]) m_members.push_back(i);
  }
}

}  // namespace polemcl
