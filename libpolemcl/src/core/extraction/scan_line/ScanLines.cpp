#include "core/extraction/scan_line/ScanLines.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "core/extraction/scan_line/ScanKernels.h"

namespace polemcl {
namespace {

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

/// Puts one return into its place among those before it, which are in order.
/// \return How many it has passed.
std::size_t insert(Return* first, Return* one, const Before& before) {
  const Return moved = *one;
  Return* j = one;
  for (; j > first && before(moved, *(j - 1)); --j) *j = *(j - 1);
  *j = moved;
  return static_cast<std::size_t>(one - j);
}

/// Looks at 15 places: unsorted returns go backwards at about half of them.
bool looksSorted(const Return* returns, std::size_t count) {
  constexpr std::size_t kFew = 16;
  if (count < 4 * kFew) return true;
  std::size_t turns = 0;
  for (std::size_t k = 1; k < kFew; ++k) {
    const Return* at = returns + k * count / kFew;
    turns += at->azimuth < (at - 1)->azimuth;
  }
  return turns < 4;
}

/// Sorts returns that are nearly in order. \return False when they are not, and not yet sorted.
bool sortSorted(Return* returns, std::size_t count, const Before& before) {
  constexpr std::size_t kSteps = 8;  // for each return: a few come from far away
  std::size_t steps = 0;
  for (std::size_t i = findDisorder(returns, count, 0); i < count;
       i = findDisorder(returns, count, i + 1)) {
    steps += insert(returns, returns + i + 1, before);
    if (steps > kSteps * (i + 8)) return false;
  }
  return true;
}

}  // namespace

ScanLines::ScanLines(const SensorModel& sensor)
    : m_sensor(sensor),
      m_rows(sensor.beamCount()),
      m_oneFiring(static_cast<float>(0.05 * sensor.columnAngle())),
      m_streamBegin(2 * static_cast<std::size_t>(m_rows) + 1),
      m_streamEnd(m_streamBegin.size()),
      m_next(m_streamBegin.size()),
      m_begin(m_rows),
      m_end(m_rows),
      m_hint(static_cast<std::size_t>(m_rows) * kParts) {}

const ScanLines::Counts& ScanLines::build(const PointsView& points, const GroundGrid& ground,
                                          float clearance) {
  m_points = points;
  for (int c = 0; c < GroundGrid::kCells; ++c) m_limit[c] = ground.height(c) + clearance;
  m_limit[GroundGrid::kNoCell] = std::numeric_limits<float>::quiet_NaN();  // below which nothing is
  const auto classify = [&] {
    m_next = m_streamBegin;
    classifyPoints(points, ground.cells(), ground.levels(), m_limit, m_sensor.lookup(), m_rows,
                   {m_returns.data(), m_next.data(), m_streamEnd.data()});
  };
  classify();
  const std::size_t streams = 2 * static_cast<std::size_t>(m_rows);
  if (!std::equal(m_next.begin(), m_next.begin() + streams, m_streamEnd.begin(),
                  std::less_equal<>())) {
    layOut();
    classify();
  }
  m_counts.used = 0;
  m_looked = m_twins = 0;
  for (int row = 0; row < m_rows; ++row) {
    joinHalves(row);
    index(row);
    m_counts.used += size(row);
  }
  constexpr std::size_t kRare = 30;  // rarer neighbours are there by chance
  if (kRare * m_twins > m_looked)
    for (int row = 0; row < m_rows; ++row) keepNearer(row);
  m_counts.outOfView = m_next[streams] - m_streamBegin[streams];
  m_counts.onGround = points.size - ground.counts().invalid - ground.counts().outOfRange -
                      m_counts.used - m_counts.outOfView;
  return m_counts;
}

/// Makes room for the streams as they were counted, and some more, so that the next scan fits.
void ScanLines::layOut() {
  std::uint32_t room = 0;
  for (std::size_t s = 0; s < m_next.size(); ++s) {
    const bool outOfView = s + 1 == m_next.size();
    const std::uint32_t had = m_streamEnd[s] - m_streamBegin[s],
                        count = m_next[s] - m_streamBegin[s];
    m_streamBegin[s] = room;
    if (!outOfView) room += std::max(had, count + count / 4 + 64);
    m_streamEnd[s] = room;
  }
  m_returns.resize(room);
}

/// Sorts returns of half a turn that come in any order: first into parts of equal azimuth, each of
/// which holds few.
void ScanLines::sortMixed(Return* returns, std::size_t count) {
  constexpr std::size_t kMostParts = 1 << 14;
  constexpr std::ptrdiff_t kFew = 32;  // up to this number, insertion sorts fastest
  const float pi = static_cast<float>(M_PI), start = returns[0].azimuth < 0 ? -pi : 0;
  const std::size_t parts = std::min(2 * count, kMostParts);
  const float perRadian = static_cast<float>(parts) / pi;
  const auto part = [&](const Return& r) {
    return std::min(static_cast<std::size_t>((r.azimuth - start) * perRadian), parts - 1);
  };
  m_partEnd.assign(parts + 1, 0);
  for (std::size_t i = 0; i < count; ++i) ++m_partEnd[part(returns[i]) + 1];
  std::partial_sum(m_partEnd.begin(), m_partEnd.end(), m_partEnd.begin());
  m_sorted.resize(count);
  for (std::size_t i = 0; i < count; ++i) m_sorted[m_partEnd[part(returns[i])]++] = returns[i];
  const Before before(m_points);
  for (std::size_t p = 0, first = 0; p < parts; first = m_partEnd[p++]) {
    const auto begin = m_sorted.begin() + static_cast<std::ptrdiff_t>(first),
               end = m_sorted.begin() + m_partEnd[p];
    if (end - begin > kFew) std::sort(begin, end, before);
  }
  for (std::size_t i = 1; i < count; ++i) insert(m_sorted.data(), m_sorted.data() + i, before);
  std::copy(m_sorted.begin(), m_sorted.end(), returns);
}

void ScanLines::sortStream(std::size_t first, std::size_t last) {
  Return* returns = m_returns.data() + first;
  const std::size_t count = last - first;
  const Before before(m_points);
  if (count < 2) return;
  if (returns[count - 1].azimuth < returns[0].azimuth) std::reverse(returns, returns + count);
  if (looksSorted(returns, count) && sortSorted(returns, count, before)) return;
  sortMixed(returns, count);
}

/// The half turn behind comes first; the one ahead moves down to it.
void ScanLines::joinHalves(int row) {
  const std::size_t back = 2 * static_cast<std::size_t>(row), ahead = back + 1;
  sortStream(m_streamBegin[back], m_next[back]);
  sortStream(m_streamBegin[ahead], m_next[ahead]);
  Return* returns = m_returns.data();
  std::copy(returns + m_streamBegin[ahead], returns + m_next[ahead], returns + m_next[back]);
  m_begin[row] = m_streamBegin[back];
  m_end[row] = m_next[back] + m_next[ahead] - m_streamBegin[ahead];
}

/// Notes for each part of the turn a return near its first one; every eighth return is looked at.
void ScanLines::index(int row) {
  constexpr std::uint32_t kStep = 8;
  std::uint32_t* hint = m_hint.data() + static_cast<std::size_t>(row) * kParts;
  std::fill(hint, hint + kParts, 0u);
  const Return* returns = begin(row);
  const auto count = static_cast<std::uint32_t>(size(row));
  for (std::uint32_t i = kStep; i < count; i += kStep) {
    const int next = part(returns[i].azimuth, kParts) + 1;
    if (next < kParts) hint[next] = i;
    const Return& after = returns[std::min(i + 1, count - 1)];
    m_twins += returns[i].azimuth - returns[i - 1].azimuth < m_oneFiring ||
               (i + 1 < count && after.azimuth - returns[i].azimuth < m_oneFiring);
    ++m_looked;
  }
  for (int p = 1; p < kParts; ++p) hint[p] = std::max(hint[p], hint[p - 1]);
}

/// Leaves the nearest return of each firing in a row.
void ScanLines::keepNearer(int row) {
  Return* const first = m_returns.data() + m_begin[row];
  if (first == end(row)) return;
  Return* last = first;  // of those that stay
  float begin = first->azimuth;
  for (const Return* r = first + 1; r < end(row); ++r) {
    if (r->azimuth - begin >= m_oneFiring) {
      *++last = *r;
      begin = r->azimuth;
    } else if (r->rho < last->rho) {
      *last = *r;
    }
  }
  m_end[row] = m_begin[row] + static_cast<std::uint32_t>(last - first) + 1;
  index(row);
}

std::size_t ScanLines::lowerBound(int row, float azimuth) const {
  const std::size_t p = static_cast<std::size_t>(row) * kParts + part(azimuth, kParts);
  const Return* i = begin(row) + m_hint[p];
  const Return* last = end(row);
  while (i < last && i->azimuth < azimuth) ++i;
  return static_cast<std::size_t>(i - begin(row));
}

}  // namespace polemcl
