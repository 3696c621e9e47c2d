#include "core/extraction/scan_line/GroundGrid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/extraction/scan_line/GroundKernels.h"

namespace polemcl {
namespace {

constexpr float kNoHeight = std::numeric_limits<float>::infinity();
constexpr float kMaxSlope = 0.15f;  // rise over run between neighbouring cells
constexpr float kSlack = 0.25f;     // m, kerbs and noise

/// Nothing far above the sensor's foot plus what a slope can climb is ground.
float highestGround(int ring, float sensorHeight) {
  return 1 - 0.5f * sensorHeight +
         kMaxSlope * GroundGrid::kRingWidth * static_cast<float>(ring + 1);
}

}  // namespace

GroundGrid::Place GroundGrid::place(float x, float y) {
  const float sum = std::max(std::abs(x) + std::abs(y), std::numeric_limits<float>::min());
  const float t = y / sum;
  const float turn = x < 0 ? std::copysign(2.f, y) - t : t;  // -2 to 2
  return {(turn + 2) * (kSectors / 4.f), std::sqrt(x * x + y * y) * (1 / kRingWidth)};
}

int GroundGrid::cell(float x, float y) {
  const Place p = place(x, y);
  return std::min(kSectors - 1, static_cast<int>(p.sector)) * kRings +
         static_cast<int>(std::min(kRings - 1.f, p.ring));
}

float GroundGrid::at(float x, float y) const {
  const Place p = place(x, y);
  const float s = p.sector + (kSectors - 0.5f);  // between the middles of sectors
  const float k = std::clamp(p.ring - 0.5f, 0.f, kRings - 1.f);
  const int s0 = static_cast<int>(s), k0 = std::min(static_cast<int>(k), kRings - 2);
  const float* a = m_height + s0 % kSectors * kRings + k0;
  const float* b = m_height + (s0 + 1) % kSectors * kRings + k0;
  const float u = s - static_cast<float>(s0), v = k - static_cast<float>(k0);
  const float level = (1 - u) * ((1 - v) * a[0] + v * a[1]) + u * ((1 - v) * b[0] + v * b[1]);
  return level - m_upright.x() * x - m_upright.y() * y;
}

/// The points with their levels in place of z.
PointsView GroundGrid::levelled(const PointsView& points) {
  m_levels = points.z;
  if (m_upright != Eigen::Vector2f::Zero()) {
    m_tilted.resize(points.size + kKernelPadding);
    for (std::size_t i = 0; i < points.size; ++i)
      m_tilted[i] = points.z[i] + m_upright.x() * points.x[i] + m_upright.y() * points.y[i];
    m_levels = m_tilted.data();
  }
  return {points.x, points.y, m_levels, points.size};
}

const GroundGrid::Counts& GroundGrid::build(const PointsView& points, float minRange,
                                            float maxRange, float sensorHeight,
                                            const Eigen::Vector2f& upright) {
  m_upright = upright;
  if (m_cell.size() < points.size + kKernelPadding)
    m_cell.resize(points.size + points.size / 8 + kKernelPadding);
  for (int c = 0; c < kCells; ++c) {
    m_lowest[c] = kNoHeight;
    m_second[c] = highestGround(c % kRings, sensorHeight);
  }
  m_second[kNoCell] = -kNoHeight;
  m_counts =
      collectLowest(levelled(points), minRange, maxRange, {m_cell.data(), m_lowest, m_second});
  climb(sensorHeight);
  smooth();
  return m_counts;
}

/// From ring to ring outwards, no steeper than ground can be.
void GroundGrid::climb(float sensorHeight) {
  for (int s = 0; s < kSectors; ++s) {
    float inner = -sensorHeight;
    float reach = kSlack + 0.35f;  // the mounting height is only nominal, and the vehicle pitches
    for (int c = s * kRings; c < (s + 1) * kRings; ++c) {
      reach += kMaxSlope * kRingWidth;
      // One stray point is no ground.
      const bool lone = m_second[c] - m_lowest[c] > 0.3f;
      const bool alone = m_second[c] == highestGround(c % kRings, sensorHeight);
      const float height = lone && !alone ? m_second[c] : m_lowest[c];
      if (height < kNoHeight && std::abs(height - inner) < reach) {
        inner = height;
        reach = kSlack;
      }
      m_rough[c] = inner;
    }
  }
}

/// The median with both neighbours removes single wrong cells. The weighted mean then smooths the
/// borders between cells.
void GroundGrid::smooth() {
  float medians[kCells];
  const auto sides = [](const float* of, int c) {
    return std::pair(of[(c + kRings) % kCells], of[(c + kCells - kRings) % kCells]);
  };
  for (int c = 0; c < kCells; ++c) {
    const auto [left, right] = sides(m_rough, c);
    medians[c] = std::max(std::min(m_rough[c], left), std::min(std::max(m_rough[c], left), right));
  }
  // Twice, which weighs five neighbours 1 4 6 4 1.
  float means[kCells];
  for (int c = 0; c < kCells; ++c) {
    const auto [left, right] = sides(medians, c);
    means[c] = 0.5f * medians[c] + 0.25f * (left + right);
  }
  for (int c = 0; c < kCells; ++c) {
    const auto [left, right] = sides(means, c);
    m_height[c] = 0.5f * means[c] + 0.25f * (left + right);
  }
  constexpr int kRing = 3;
  float sorted[kSectors];
  for (int s = 0; s < kSectors; ++s) sorted[s] = m_rough[s * kRings + kRing];
  std::nth_element(sorted, sorted + kSectors / 2, sorted + kSectors);
  m_median = sorted[kSectors / 2];
}

}  // namespace polemcl
