#include "core/extraction/scan_line/SegmentClustering.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace polemcl {
namespace {

constexpr float kFree = std::numeric_limits<float>::infinity();

constexpr TipBlock kEmptyBlock = {{}, {}, {kFree, kFree, kFree, kFree}, {}, {kNoCluster}, 0, 0};

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

/// Finds the nearest tip above each of some segments of one row.
void SegmentClustering::findTips(const ScanLineSegment* segments, std::size_t count) {
  m_queries.resize(count);
  m_found.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const ScanLineSegment& s = segments[i];
    m_queries[i] = {
        s.x,
        s.y,
        s.z,
        s.row,
        std::max(m_beamGap[s.row] * s.rho, m_gap),
        cell(s.x * m_cellsPerMetre + m_middle - 0.5f, s.y * m_cellsPerMetre + m_middle - 0.5f)};
  }
  findNearestTips(grid(), m_queries.data(), count, m_found.data());
}

TipGrid SegmentClustering::grid() const {
  return {m_blocks.data(), m_block.data(), m_cells, m_reach * m_reach};
}

/// Whether a tip that was found is no longer there, as another segment of the row has joined it or
/// taken its slot.
bool SegmentClustering::isGone(std::uint32_t cluster, std::int32_t row) const {
  const Growing& growing = m_growing[cluster];
  const TipBlock& tips = m_blocks[growing.block];
  return tips.row[growing.slot] == row || tips.cluster[growing.slot] != cluster;
}

std::uint32_t SegmentClustering::freeBlock(std::uint32_t cell) {
  m_blocks.push_back(kEmptyBlock);
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

void SegmentClustering::add(std::uint32_t i, const ScanLineSegment& segment, float gap,
                            std::uint32_t cluster) {
  if (cluster == kNoCluster) {
    Growing& growing = m_growing.emplace_back();
    growing.first = growing.last = i;
    growing.count = 1;
    enter(static_cast<std::uint32_t>(m_growing.size()) - 1, segment, gap);
  } else {
    m_below[m_growing[cluster].last] = i;
    m_growing[cluster].last = i;
    ++m_growing[cluster].count;
    moveTip(cluster, segment, gap);
  }
}

const std::vector<SegmentCluster>& SegmentClustering::cluster(
    const std::vector<ScanLineSegment>& segments) {
  m_growing.clear();
  std::fill(m_block.begin(), m_block.end(), 0u);
  m_blocks.clear();
  m_blocks.push_back(kEmptyBlock);
  m_below.assign(segments.size(), kNone);
  for (std::size_t i = 0, end; i < segments.size(); i = end) {
    end = i;
    while (end < segments.size() && segments[end].row == segments[i].row) ++end;
    // Segments of a row do not join one another, so all can look first.
    findTips(&segments[i], end - i);
    for (std::size_t k = i; k < end; ++k) {
      const TipQuery& query = m_queries[k - i];
      std::uint32_t& found = m_found[k - i];
      if (found != kNoCluster && isGone(found, query.row))
        findNearestTips(grid(), &query, 1, &found);
      add(static_cast<std::uint32_t>(k), segments[k], query.gap, found);
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
    SegmentCluster& cluster = m_clusters.emplace_back();
    cluster.first = m_members.data() + m_members.size();
    cluster.count = chain.count;
    for (std::uint32_t i = chain.first; i != kNone; i = m_below[i]) m_members.push_back(i);
  }
}

}  // namespace polemcl
