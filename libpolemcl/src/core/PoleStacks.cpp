#include <polemcl/core/PoleStacks.h>

#include <algorithm>
#include <cmath>

namespace polemcl {

SliceStacker::SliceStacker(const SensorModel& sensor, const NativeOptions& options)
    : m_sensor(sensor), m_options(options), m_head(kBins) {}

int SliceStacker::bin(float azimuth) const {
  const int b = static_cast<int>(
      std::floor((azimuth + static_cast<float>(M_PI)) * static_cast<float>(kBins / (2 * M_PI))));
  return ((b % kBins) + kBins) % kBins;
}

Stack& SliceStacker::open() {
  if (m_used == m_stacks.size()) m_stacks.emplace_back();
  Stack& stack = m_stacks[m_used++];
  stack.slices.clear();
  return stack;
}

void SliceStacker::enter(std::uint32_t stack, float azimuth) {
  const int b = bin(azimuth);
  if (m_head[b] >= 0 && m_nodes[m_head[b]].stack == stack) return;
  m_nodes.push_back({stack, m_head[b]});
  m_head[b] = static_cast<std::int32_t>(m_nodes.size()) - 1;
}

std::int32_t SliceStacker::nearestStack(const std::vector<Slice>& slices,
                                        const Slice& slice) const {
  const float reach = static_cast<float>(m_options.stackReach);
  const float middle = 0.5f * (slice.azimuthBegin + slice.azimuthEnd);
  const int spread =
      1 + static_cast<int>(reach / slice.rho * static_cast<float>(kBins / (2 * M_PI)));
  const int center = bin(middle);
  std::int32_t best = -1;
  float bestDistance = reach;
  for (int k = -spread; k <= spread; ++k) {
    for (std::int32_t n = m_head[(center + k + kBins) % kBins]; n >= 0; n = m_nodes[n].next) {
      const std::uint32_t candidate = m_nodes[n].stack;
      const Slice& above = slices[m_stacks[candidate].slices.back()];
      if (above.row == slice.row) continue;
      // Beams may be wider apart than the gap allowed: the next beam always counts as neighbour.
      const float beams = 2.2f * static_cast<float>(m_sensor.spacingAbove(slice.row)) * slice.rho;
      if (above.z - slice.z > std::max(beams, static_cast<float>(m_options.stackGap))) continue;
      const float distance = std::hypot(above.x - slice.x, above.y - slice.y);
      if (distance < bestDistance ||
          (distance == bestDistance && static_cast<std::int32_t>(candidate) < best)) {
        bestDistance = distance;
        best = static_cast<std::int32_t>(candidate);
      }
    }
  }
  return best;
}

std::size_t SliceStacker::stack(const std::vector<Slice>& slices) {
  m_used = 0;
  m_nodes.clear();
  std::fill(m_head.begin(), m_head.end(), -1);
  for (std::uint32_t i = 0; i < slices.size(); ++i) {
    std::int32_t s = nearestStack(slices, slices[i]);
    if (s < 0) {
      s = static_cast<std::int32_t>(m_used);
      open();
    }
    m_stacks[s].slices.push_back(i);
    enter(static_cast<std::uint32_t>(s), 0.5f * (slices[i].azimuthBegin + slices[i].azimuthEnd));
  }
  m_kept.clear();
  for (std::uint32_t s = 0; s < m_used; ++s)
    if (m_stacks[s].slices.size() >= 2) m_kept.push_back(s);
  return m_kept.size();
}

}  // namespace polemcl
