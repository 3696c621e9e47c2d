#include <polemcl/core/ScanLines.h>

#include <algorithm>
#include <cmath>

#include "ScanKernels.h"

namespace polemcl {
namespace {

/// Calls f(i) for all i below n, from four places at once: neighbours in the cloud fall into the
/// same bucket, and would wait for each other's counter.
template <class F>
void eachInStreams(std::size_t n, F f) {
  const std::size_t quarter = n / 4;
  for (std::size_t i = 0; i < quarter; ++i) {
    f(i);
    f(i + quarter);
    f(i + 2 * quarter);
    f(i + 3 * quarter);
  }
  for (std::size_t i = 4 * quarter; i < n; ++i) f(i);
}

}  // namespace

ScanLines::ScanLines(const SensorModel& sensor)
    : m_sensor(sensor), m_rows(sensor.rows()), m_bucketStart(bucket(m_rows, 0) + 2) {}

int ScanLines::bucketColumn(float azimuth) {
  constexpr float kPerRadian = static_cast<float>(kBuckets / (2 * M_PI));
  const int column = static_cast<int>((azimuth + static_cast<float>(M_PI)) * kPerRadian);
  return std::clamp(column, 0, kBuckets - 1);
}

const ScanLines::Counts& ScanLines::build(const PointsView& points, float minRange,
                                          float maxRange) {
  m_points = points;
  if (m_key.size() < points.size + kKernelPadding) {
    m_key.resize(points.size + kKernelPadding);
    m_azimuth.resize(points.size + kKernelPadding);
    m_rho.resize(points.size + kKernelPadding);
  }
  m_counts = classifyPoints(points, m_sensor.lookup(), kBuckets, minRange, maxRange,
                            {m_key.data(), m_azimuth.data(), m_rho.data()});

  // Counting sort. Counts enter two places late: summed up, a bucket's start stands one place late,
  // and filling, which moves it on to the next bucket's start, leaves all of them where they
  // belong.
  std::fill(m_bucketStart.begin(), m_bucketStart.end(), 0u);
  eachInStreams(points.size, [&](std::size_t i) {
    if (m_key[i] >= 0) ++m_bucketStart[m_key[i] + 2];
  });
  for (std::size_t b = 1; b < m_bucketStart.size(); ++b) m_bucketStart[b] += m_bucketStart[b - 1];
  if (m_returns.size() < m_counts.used) m_returns.resize(m_counts.used + m_counts.used / 8);
  eachInStreams(points.size, [&](std::size_t i) {
    if (m_key[i] >= 0)
      m_returns[m_bucketStart[m_key[i] + 1]++] = {m_azimuth[i], m_rho[i], points.z[i],
                                                  static_cast<std::uint32_t>(i)};
  });
  sortBuckets();
  return m_counts;
}

void ScanLines::sortBuckets() {
  // Down to the last bit, so that the order of the points is of no consequence.
  const auto before = [this](const Return& a, const Return& b) {
    if (a.azimuth != b.azimuth) return a.azimuth < b.azimuth;
    if (a.rho != b.rho) return a.rho < b.rho;
    if (a.z != b.z) return a.z < b.z;
    return x(a) != x(b) ? x(a) < x(b) : y(a) < y(b);
  };
  for (std::size_t b = 0; b + 1 < m_bucketStart.size(); ++b) {
    Return* first = m_returns.data() + m_bucketStart[b];
    Return* last = m_returns.data() + m_bucketStart[b + 1];
    if (last - first > 32) {
      std::sort(first, last, before);
      continue;
    }
    for (Return* i = first + 1; i < last; ++i) {
      if (!before(*i, *(i - 1))) continue;
      const Return moved = *i;
      Return* j = i;
      for (; j > first && before(moved, *(j - 1)); --j) *j = *(j - 1);
      *j = moved;
    }
  }
}

std::size_t ScanLines::lowerBound(int row, float azimuth) const {
  const std::size_t b = bucket(row, bucketColumn(azimuth));
  const Return* i = m_returns.data() + m_bucketStart[b];
  const Return* last = m_returns.data() + m_bucketStart[b + 1];
  while (i < last && i->azimuth < azimuth) ++i;
  return static_cast<std::size_t>(i - begin(row));
}

}  // namespace polemcl
