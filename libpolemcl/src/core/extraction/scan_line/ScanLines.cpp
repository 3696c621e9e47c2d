#include "core/extraction/scan_line/ScanLines.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/extraction/scan_line/ScanKernels.h"

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

constexpr int kFewReturns = 32;  // up to this number, insertion sorts fastest

/// Compares down to the last bit, so that the order of the points does not matter.
class Before {
 public:
  explicit Before(const PointsView& points) : m_points(points) {}
  bool operator()(const Return& a, const Return& b) const {
    return a.azimuth < b.azimuth || (a.azimuth == b.azimuth && ofSameAzimuth(a, b));
  }

 private:
  bool ofSameAzimuth(const Return& a, const Return& b) const {
    if (a.rho != b.rho) return a.rho < b.rho;
    if (a.z != b.z) return a.z < b.z;
    const float ax = m_points.x[a.point], bx = m_points.x[b.point];
    return ax != bx ? ax < bx : m_points.y[a.point] < m_points.y[b.point];
  }
  const PointsView& m_points;
};

/// For ranges that are nearly in order, or short.
void insertionSort(Return* first, Return* last, const Before& before) {
  for (Return* i = first + 1; i < last; ++i) {
    if (!before(*i, *(i - 1))) continue;
    const Return moved = *i;
    Return* j = i;
    for (; j > first && before(moved, *(j - 1)); --j) *j = *(j - 1);
    *j = moved;
  }
}

}  // namespace

ScanLines::ScanLines(const SensorModel& sensor)
    : m_sensor(sensor), m_rows(sensor.rows()), m_bucketStart(bucket(m_rows, 0) + 3) {}

int ScanLines::bucketColumn(float azimuth) const {
  const int times = m_buckets / kBuckets;
  const float perRadian = static_cast<float>(kBuckets / (2 * M_PI)) * static_cast<float>(times);
  const int column = static_cast<int>((azimuth + static_cast<float>(M_PI)) * perRadian);
  return std::clamp(column, 0, m_buckets - 1);
}

/// Chooses enough buckets that each holds few returns, and the work stays linear. The number is a
/// power of two, so that the kernels and bucketColumn() round alike.
void ScanLines::chooseBuckets(std::size_t points) {
  constexpr std::size_t kPerBucket = 8;
  constexpr int kMost = 1 << 14;
  m_buckets = kBuckets;
  while (m_buckets < kMost && points > kPerBucket * m_buckets * static_cast<std::size_t>(m_rows))
    m_buckets *= 2;
  m_bucketStart.resize(bucket(m_rows, 0) + 3);
}

const ScanLines::Counts& ScanLines::build(const PointsView& points, const GroundGrid& ground,
                                          float clearance) {
  m_points = points;
  chooseBuckets(points.size);
  if (m_key.size() < points.size + kKernelPadding) {
    const std::size_t room = points.size + points.size / 8 + kKernelPadding;
    m_key.resize(room);
    m_unsorted.resize(room);
    m_returns.resize(room);
  }
  for (int c = 0; c < GroundGrid::kCells; ++c) m_limit[c] = ground.height(c) + clearance;
  m_limit[GroundGrid::kNoCell] = std::numeric_limits<float>::quiet_NaN();  // below which nothing is
  const std::size_t count = classifyPoints(points, ground.cells(), m_limit, m_sensor.lookup(),
                                           m_rows, m_buckets, {m_unsorted.data(), m_key.data()});
  const std::uint32_t fullest = sortIntoBuckets(count);
  for (int row = 0; row < m_rows; ++row)
    fullest > static_cast<std::uint32_t>(kFewReturns) ? sortBuckets(row) : sortRow(row);
  m_counts.used = m_bucketStart[bucket(m_rows, 0)];
  m_counts.outOfView = count - m_counts.used;
  m_counts.onGround = points.size - ground.counts().invalid - ground.counts().outOfRange - count;
  return m_counts;
}

/// A counting sort. Counts enter two places late: summed up, a bucket's start stands one place
/// late, and filling, which moves it on to the next bucket's start, leaves all of them where they
/// belong. Behind the last row is a bucket for what is out of view.
/// \return The greatest number of returns in one bucket.
std::uint32_t ScanLines::sortIntoBuckets(std::size_t count) {
  std::fill(m_bucketStart.begin(), m_bucketStart.end(), 0u);
  eachInStreams(count, [&](std::size_t i) { ++m_bucketStart[m_key[i] + 2]; });
  std::uint32_t sum = 0, fullest = 0;
  for (std::size_t b = 0; b < m_bucketStart.size(); ++b) {
    if (b + 1 < m_bucketStart.size()) fullest = std::max(fullest, m_bucketStart[b]);
    sum += m_bucketStart[b];
    m_bucketStart[b] = sum;
  }
  eachInStreams(count,
                [&](std::size_t i) { m_returns[m_bucketStart[m_key[i] + 1]++] = m_unsorted[i]; });
  return fullest;
}

/// Its returns are in order but for those that share a bucket.
void ScanLines::sortRow(int row) {
  insertionSort(m_returns.data() + m_bucketStart[bucket(row, 0)],
                m_returns.data() + m_bucketStart[bucket(row + 1, 0)], Before(m_points));
}

void ScanLines::sortBuckets(int row) {
  for (std::size_t b = bucket(row, 0); b < bucket(row + 1, 0); ++b) {
    Return* first = m_returns.data() + m_bucketStart[b];
    Return* last = m_returns.data() + m_bucketStart[b + 1];
    if (last - first > kFewReturns)
      std::sort(first, last, Before(m_points));
    else
      insertionSort(first, last, Before(m_points));
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
