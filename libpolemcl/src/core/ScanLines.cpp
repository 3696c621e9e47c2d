#include <polemcl/core/ScanLines.h>

#include <algorithm>
#include <cmath>

namespace polemcl {

ScanLines::ScanLines(const SensorModel& sensor)
    : m_sensor(sensor), m_rows(sensor.rows()), m_bucketStart(bucket(m_rows, 0) + 1) {}

int ScanLines::bucketColumn(float azimuth) {
  constexpr float kPerRadian = static_cast<float>(kBuckets / (2 * M_PI));
  const int column = static_cast<int>((azimuth + static_cast<float>(M_PI)) * kPerRadian);
  return std::clamp(column, 0, kBuckets - 1);
}

const ScanLines::Counts& ScanLines::build(const PointsView& points, float minRange,
                                          float maxRange) {
  m_counts = {};
  classify(points, minRange, maxRange);

  std::fill(m_bucketStart.begin(), m_bucketStart.end(), 0u);
  for (std::size_t i = 0; i < points.size; ++i)
    if (m_key[i] >= 0) ++m_bucketStart[m_key[i] + 1];
  for (std::size_t b = 1; b < m_bucketStart.size(); ++b) m_bucketStart[b] += m_bucketStart[b - 1];
  m_counts.used = m_bucketStart.back();

  m_returns.resize(m_counts.used);
  for (std::size_t i = 0; i < points.size; ++i)
    if (m_key[i] >= 0) m_returns[m_bucketStart[m_key[i]]++] = m_scratch[i];
  // Filling moved every start to its bucket's end, which is the next one's start: shift back.
  for (std::size_t b = m_bucketStart.size() - 1; b > 0; --b)
    m_bucketStart[b] = m_bucketStart[b - 1];
  m_bucketStart[0] = 0;
  sortBuckets();
  return m_counts;
}

void ScanLines::classify(const PointsView& points, float minRange, float maxRange) {
  m_key.resize(points.size);
  m_scratch.resize(points.size);
  for (std::size_t i = 0; i < points.size; ++i) {
    const float x = points.x[i], y = points.y[i], z = points.z[i];
    const float rho = std::sqrt(x * x + y * y);
    m_key[i] = -1;
    if (!std::isfinite(rho) || !std::isfinite(z) || (rho == 0.f && z == 0.f)) {
      ++m_counts.invalid;
    } else if (rho < minRange || rho > maxRange) {
      ++m_counts.outOfRange;
    } else if (const int row = m_sensor.row(rho, z); row < 0) {
      ++m_counts.outOfView;
    } else {
      const float azimuth = std::atan2(y, x);
      m_key[i] = static_cast<std::int32_t>(bucket(row, bucketColumn(azimuth)));
      m_scratch[i] = {azimuth, rho, z, static_cast<std::uint32_t>(i)};
    }
  }
}

void ScanLines::sortBuckets() {
  const auto before = [](const Return& a, const Return& b) {
    if (a.azimuth != b.azimuth) return a.azimuth < b.azimuth;
    return a.rho != b.rho ? a.rho < b.rho : a.z < b.z;
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
