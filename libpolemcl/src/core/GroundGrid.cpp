#include <polemcl/core/GroundGrid.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace polemcl {

int GroundGrid::sector(float azimuth) {
  const int s = static_cast<int>((azimuth + static_cast<float>(M_PI)) *
                                 static_cast<float>(kSectors / (2 * M_PI)));
  return std::clamp(s, 0, kSectors - 1);
}

int GroundGrid::ring(float rho) {
  return std::min(kRings - 1, static_cast<int>(rho * (1 / kRingWidth)));
}

namespace {
constexpr float kNone = std::numeric_limits<float>::infinity();
constexpr int kCandidates = 2;  // the lowest and the second lowest: one stray return is no ground
}  // namespace

void GroundGrid::collectLowest(const ScanLines& lines, float sensorHeight) {
  static_assert(ScanLines::kBuckets % kSectors == 0, "sectors are whole buckets");
  constexpr int kColumns = ScanLines::kBuckets / kSectors;
  m_lowest.assign(kSectors * kRings * kCandidates, kNone);
  // Nothing far above the sensor's foot plus what a slope can climb is ground.
  const float highest = 1.0f - 0.5f * sensorHeight;
  for (int row = 0; row < lines.rows(); ++row) {
    for (int s = 0; s < kSectors; ++s) {
      const Return* end = lines.columnBegin(row, (s + 1) * kColumns);
      const Return* r = lines.columnBegin(row, s * kColumns);
      if (r == end) continue;
      // On one beam what is lowest is the ground, what stands on it is nearer and higher.
      const Return* lowest = r;
      for (; r != end; ++r) lowest = r->z < lowest->z ? r : lowest;
      if (lowest->z > highest + kMaxSlope * lowest->rho) continue;
      float* cell = &m_lowest[(s * kRings + ring(lowest->rho)) * kCandidates];
      if (lowest->z < cell[1]) {
        cell[1] = std::max(lowest->z, cell[0]);
        cell[0] = std::min(lowest->z, cell[0]);
      }
    }
  }
}

void GroundGrid::build(const ScanLines& lines, float sensorHeight) {
  collectLowest(lines, sensorHeight);
  for (int s = 0; s < kSectors; ++s) {
    float inner = -sensorHeight;
    float reach = kSlack + 0.35f;  // the mounting height is only nominal, and the vehicle pitches
    for (int k = 0; k < kRings; ++k) {
      reach += kMaxSlope * kRingWidth;
      const float* cell = &m_lowest[(s * kRings + k) * kCandidates];
      const bool lone = cell[1] - cell[0] > 0.3f;
      const float height = lone && cell[1] < kNone ? cell[1] : cell[0];
      if (height < kNone && std::abs(height - inner) < reach) {
        inner = height;
        reach = kSlack;
      }
      m_height[s * kRings + k] = inner;
    }
  }
  m_sorted.clear();
  for (int s = 0; s < kSectors; ++s) m_sorted.push_back(m_height[s * kRings + 3]);
  std::nth_element(m_sorted.begin(), m_sorted.begin() + kSectors / 2, m_sorted.end());
  m_median = m_sorted[kSectors / 2];
}

float GroundGrid::at(float azimuth, float rho) const {
  // The lowest of a cell is lower than its middle on a slope; the median of the neighbours evens it
  // out.
  const int s = sector(azimuth), k = ring(rho);
  const float here = m_height[s * kRings + k];
  const float left = m_height[((s + 1) % kSectors) * kRings + k];
  const float right = m_height[((s + kSectors - 1) % kSectors) * kRings + k];
  return std::max(std::min(here, left), std::min(std::max(here, left), right));
}

}  // namespace polemcl
