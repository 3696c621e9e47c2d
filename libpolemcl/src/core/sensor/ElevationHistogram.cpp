#include "core/sensor/ElevationHistogram.h"

#include <algorithm>
#include <cmath>

namespace polemcl {
namespace {

constexpr double kSteepest = 2.2;          // slope: 65°
constexpr double kSlopeCell = 0.0005;      // slope: 0.03°, a tenth of the narrowest gap in use
constexpr std::size_t kSlopeCells = 8800;  // 2 · kSteepest / kSlopeCell
constexpr std::size_t kAround = 24;        // cells of the running mean on each side: 0.7°

/// kSlopeCells when it lies outside.
std::size_t cellOf(const BeamCoordinates& at) {
  const double cell = (at.z / at.rho + kSteepest) / kSlopeCell;
  return cell >= 0 && cell < static_cast<double>(kSlopeCells) ? static_cast<std::size_t>(cell)
                                                              : kSlopeCells;
}

}  // namespace

BeamCoordinates beamCoordinates(const BeamPoint& point, const BeamOrigin& origin) {
  double x = point.x - origin.x;
  const double y = point.y - origin.y;
  if (origin.slide != 0) x += origin.slide * std::atan2(y, x) / (2 * M_PI);
  return {std::sqrt(x * x + y * y), point.z - origin.z};
}

void ElevationHistogram::fill(const BeamOrigin& origin) {
  m_counts.assign(kSlopeCells, 0.f);
  for (const BeamPoint& point : m_points) {
    const std::size_t cell = cellOf(beamCoordinates(point, origin));
    if (cell < kSlopeCells) ++m_counts[cell];
  }
  m_smooth.assign(kSlopeCells, 0.f);
  for (std::size_t i = 1; i + 1 < kSlopeCells; ++i)
    m_smooth[i] = 0.25f * m_counts[i - 1] + 0.5f * m_counts[i] + 0.25f * m_counts[i + 1];
  m_sums.assign(kSlopeCells + 1, 0);
  for (std::size_t i = 0; i < kSlopeCells; ++i) m_sums[i + 1] = m_sums[i] + m_smooth[i];
}

double ElevationHistogram::mean(std::size_t cell) const {
  const std::size_t from = cell > kAround ? cell - kAround : 0;
  const std::size_t to = std::min(kSlopeCells, cell + kAround + 1);
  return (m_sums[to] - m_sums[from]) / static_cast<double>(to - from);
}

/// Half the sum of deviations from a mean is what stands out above it.
double ElevationHistogram::contrast(const BeamOrigin& origin) {
  fill(origin);
  double sum = 0;
  for (std::size_t i = 0; i < kSlopeCells; ++i) sum += 0.5 * std::abs(m_smooth[i] - mean(i));
  return m_sums[kSlopeCells] > 0 ? sum / m_sums[kSlopeCells] : 0;
}

std::vector<double> ElevationHistogram::cumulative(const BeamOrigin& origin,
                                                   const BeamOrigin& reference) {
  fill(origin);
  std::vector<double> share(kSlopeCells, 0);  // of a return that stands out
  for (std::size_t i = 0; i < kSlopeCells; ++i)
    if (m_smooth[i] > 0) share[i] = std::max(0.0, 1 - mean(i) / m_smooth[i]);
  std::vector<double> sums(kSlopeCells + 1, 0);
  for (const BeamPoint& point : m_points) {
    const std::size_t cell = cellOf(beamCoordinates(point, origin));
    const std::size_t place = cellOf(beamCoordinates(point, reference));
    if (cell < kSlopeCells && place < kSlopeCells) sums[place + 1] += share[cell];
  }
  for (std::size_t i = 0; i < kSlopeCells; ++i) sums[i + 1] += sums[i];
  return sums;
}

double ElevationHistogram::slopeOf(std::size_t cell) {
  return -kSteepest + kSlopeCell * static_cast<double>(cell);
}

}  // namespace polemcl
