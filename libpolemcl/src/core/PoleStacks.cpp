#include <polemcl/core/PoleStacks.h>

#include <algorithm>
#include <cmath>

namespace polemcl {

SliceStacker::SliceStacker(const SensorModel& sensor, const NativeOptions& options)
    : m_reach(static_cast<float>(options.stackReach)),
      m_gap(static_cast<float>(options.stackGap)),
      // Cells twice the reach wide: what lies within reach is in the nearest four.
      m_cellsPerMetre(0.5f / m_reach),
      m_cells(2 + 2 * static_cast<int>(std::ceil(options.maxRange * m_cellsPerMetre))),
      m_head(static_cast<std::size_t>(m_cells) * m_cells) {
  // Beams may be wider apart than the gap allowed: the next beam always counts as neighbour, and
  // one silent beam between is bridged.
  for (int row = 0; row < sensor.rows(); ++row)
    m_beamGap.push_back(2.2f * static_cast<float>(sensor.spacingAbove(row)));
}

/// Lower of the two cells (per axis) that a square of one reach around a coordinate can touch.
int SliceStacker::cell(float coordinate) const {
  const int c = static_cast<int>(std::floor(coordinate * m_cellsPerMetre - 0.5f)) + m_cells / 2;
  return std::clamp(c, 0, m_cells - 2);
}

std::uint32_t SliceStacker::nearestTip(const Slice& slice) const {
  const float gap = std::max(m_beamGap[slice.row] * slice.rho, m_gap);
  const int cx = cell(slice.x), cy = cell(slice.y);
  std::uint32_t best = kNone;
  float bestDistance = m_reach * m_reach;
  for (const int c : {cy * m_cells + cx, cy * m_cells + cx + 1, (cy + 1) * m_cells + cx,
                      (cy + 1) * m_cells + cx + 1}) {
    for (std::uint32_t n = m_head[c]; n != kNone; n = m_nodes[n].next) {
      const Tip& tip = m_tips[m_nodes[n].tip];
      if (tip.row == slice.row || tip.z - slice.z > gap) continue;
      const float dx = tip.x - slice.x, dy = tip.y - slice.y;
      const float distance = dx * dx + dy * dy;
      if (distance < bestDistance || (distance == bestDistance && m_nodes[n].tip < best)) {
        bestDistance = distance;
        best = m_nodes[n].tip;
      }
    }
  }
  return best;
}

void SliceStacker::enter(std::uint32_t tip, const Slice& slice) {
  const int c = cell(slice.y + m_reach) * m_cells + cell(slice.x + m_reach);
  if (m_head[c] != kNone && m_nodes[m_head[c]].tip == tip) return;
  m_nodes.push_back({tip, m_head[c]});
  m_head[c] = static_cast<std::uint32_t>(m_nodes.size()) - 1;
}

const std::vector<Stack>& SliceStacker::stack(const std::vector<Slice>& slices) {
  m_tips.clear();
  m_nodes.clear();
  std::fill(m_head.begin(), m_head.end(), kNone);
  m_below.assign(slices.size(), kNone);
  for (std::uint32_t i = 0; i < slices.size(); ++i) {
    const Slice& slice = slices[i];
    std::uint32_t t = nearestTip(slice);
    if (t == kNone) {
      t = static_cast<std::uint32_t>(m_tips.size());
      m_tips.push_back({slice.x, slice.y, slice.z, slice.row, i, i, 1});
    } else {
      Tip& tip = m_tips[t];
      m_below[tip.last] = i;
      tip = {slice.x, slice.y, slice.z, slice.row, tip.first, i, tip.count + 1};
    }
    enter(t, slice);
  }
  collect();
  return m_stacks;
}

/// Lays the chains of two slices and more out as lists.
void SliceStacker::collect() {
  m_members.clear();
  m_stacks.clear();
  m_members.reserve(m_below.size());  // so that the stacks' pointers stay good
  for (const Tip& tip : m_tips) {
    if (tip.count < 2) continue;
    m_stacks.push_back({m_members.data() + m_members.size(), tip.count});
    for (std::uint32_t i = tip.first; i != kNone; i = m_below[i]) m_members.push_back(i);
  }
}

}  // namespace polemcl
