#include "core/extraction/scan_line/SegmentClustering.h"

#include <algorithm>
#include <cmath>

namespace polemcl {

SegmentClustering::SegmentClustering(const SensorModel& sensor, const ScanLineOptions& options)
    : m_reach(static_cast<float>(options.stackReach)),
      m_gap(static_cast<float>(options.stackGap)),
      // Cells twice the reach wide: what lies within reach is in the nearest four.
      m_cellsPerMetre(0.5f / m_reach),
      m_middle(std::ceil(static_cast<float>(options.maxRange) * m_cellsPerMetre) + 1),
      m_cells(2 * static_cast<std::int32_t>(m_middle)),
      m_head(static_cast<std::size_t>(m_cells) * m_cells) {
  // Beams may be wider apart than the gap allowed: the next beam always counts as neighbour, and
  // one silent beam between is bridged.
  for (int row = 0; row < sensor.rows(); ++row)
    m_beamGap.push_back(2.2f * static_cast<float>(sensor.spacingAbove(row)));
}

/// \param x,y In cells from the grid's corner; positive, so that cutting off rounds down.
std::int32_t SegmentClustering::cell(float x, float y) const {
  return static_cast<std::int32_t>(y) * m_cells + static_cast<std::int32_t>(x);
}

/// Forgets, on its way, the tips that lie too far above to be joined any more.
std::uint32_t SegmentClustering::nearestTip(const ScanLineSegment& segment) {
  const float gap = std::max(m_beamGap[segment.row] * segment.rho, m_gap);
  const std::int32_t corner = cell(segment.x * m_cellsPerMetre + m_middle - 0.5f,
                                   segment.y * m_cellsPerMetre + m_middle - 0.5f);
  std::uint32_t best = kNone;
  float bestDistance = m_reach * m_reach;
  for (std::int32_t k = 0; k < 4; ++k) {
    std::uint32_t* link = &m_head[corner + (k & 1) + (k >> 1) * m_cells];
    while (*link != kNone) {
      const std::uint32_t t = *link;
      Tip& tip = m_tips[t];
      const float above = tip.z - segment.z;
      if (above > 3 * gap) {
        *link = tip.next;
        continue;
      }
      link = &tip.next;
      const float dx = tip.x - segment.x, dy = tip.y - segment.y;
      const float distance = dx * dx + dy * dy;
      if (distance > bestDistance || tip.row == segment.row || above > gap) continue;
      if (distance == bestDistance && t > best) continue;
      bestDistance = distance;
      best = t;
    }
  }
  return best;
}

void SegmentClustering::enter(std::uint32_t t) {
  Tip& tip = m_tips[t];
  tip.cell = cell(tip.x * m_cellsPerMetre + m_middle, tip.y * m_cellsPerMetre + m_middle);
  tip.next = m_head[tip.cell];
  m_head[tip.cell] = t;
}

/// Enters a tip where it stands now.
void SegmentClustering::move(std::uint32_t t) {
  Tip& tip = m_tips[t];
  if (tip.cell == cell(tip.x * m_cellsPerMetre + m_middle, tip.y * m_cellsPerMetre + m_middle))
    return;
  std::uint32_t* link = &m_head[tip.cell];
  while (*link != t) link = &m_tips[*link].next;
  *link = tip.next;
  enter(t);
}

const std::vector<SegmentCluster>& SegmentClustering::cluster(
    const std::vector<ScanLineSegment>& segments) {
  m_tips.clear();
  std::fill(m_head.begin(), m_head.end(), kNone);
  m_below.assign(segments.size(), kNone);
  for (std::uint32_t i = 0; i < segments.size(); ++i) {
    const ScanLineSegment& segment = segments[i];
    const std::uint32_t t = nearestTip(segment);
    if (t == kNone) {
      m_tips.push_back({segment.x, segment.y, segment.z, segment.row, i, i, 1, -1, kNone});
      enter(static_cast<std::uint32_t>(m_tips.size()) - 1);
    } else {
      Tip& tip = m_tips[t];
      m_below[tip.last] = i;
      tip = {segment.x, segment.y,     segment.z, segment.row, tip.first,
             i,         tip.count + 1, tip.cell,  tip.next};
      move(t);
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
  for (const Tip& tip : m_tips) {
    if (tip.count < 2) continue;
    m_clusters.push_back({m_members.data() + m_members.size(), tip.count});
    for (std::uint32_t i = tip.first; i != kNone; i = m_below[i]) m_members.push_back(i);
  }
}

}  // namespace polemcl
