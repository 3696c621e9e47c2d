#include "core/extraction/scan_line/ScanLineSegmenter.h"

#include <algorithm>
#include <cmath>

#include "core/extraction/scan_line/ScanKernels.h"

namespace polemcl {
namespace {

constexpr float kTurn = static_cast<float>(2 * M_PI);

/// One row, its indices wrapped where a run or a neighbour crosses the seam.
class Row {
 public:
  Row(const ScanLines& lines, int row, const SegmentLimits& limits)
      : m_lines(lines),
        m_returns(lines.begin(row)),
        m_size(lines.size(row)),
        m_row(row),
        m_limits(limits) {}

  std::size_t size() const { return m_size; }

  /// True when the last and the first return of the row are neighbours on one surface.
  bool closed() const {
    const Return &a = m_returns[m_size - 1], &b = m_returns[0];
    return joined(a, b, b.azimuth + kTurn - a.azimuth, m_limits.step, m_limits.gap);
  }

  /// Appends the run as a segment if it is narrow and not too deep.
  void append(const SegmentRun& run, std::vector<ScanLineSegment>& segments) const {
    const Return &begin = m_returns[run.first], &end = at(run.last);
    float rho = begin.rho, farthest = rho, z = 0;
    for (std::size_t i = run.first; i <= run.last; ++i) {
      const Return& r = at(i);
      rho = std::min(rho, r.rho);
      farthest = std::max(farthest, r.rho);
      z += r.z;
    }
    const float turn = turnOf(run.first, run.last);
    if (rho * turn > m_limits.maxWidth || farthest - rho > m_limits.maxWidth) return;
    ScanLineSegment& segment = segments.emplace_back();
    segment.left = run.left;
    segment.right = run.right;
    segment.row = m_row;
    segment.first = run.first;
    segment.count = run.last - run.first + 1;
    segment.azimuthBegin = begin.azimuth;
    segment.azimuthEnd = begin.azimuth + turn;
    segment.rho = rho;
    segment.z = z / static_cast<float>(segment.count);
    placeFront(begin, end, segment);
  }

  /// From the first to the last return of a run, rad.
  float turnOf(std::size_t first, std::size_t last) const {
    return at(last).azimuth - m_returns[first].azimuth + (last < m_size ? 0 : kTurn);
  }

  /// What is beside return `end` when walking outwards with `direction` (+1 left, -1 right).
  Side side(std::size_t end, int direction) const {
    if (end >= m_size) end -= m_size;
    const float rho = m_returns[end].rho;
    float azimuth = m_returns[end].azimuth;
    std::size_t i = end;
    // A mixed pixel may stand between the edge and what lies behind it.
    for (int k = 0; k < 2; ++k) {
      float seam = 0;
      if (direction > 0 && ++i == m_size) {
        i = 0;
        seam = kTurn;
      } else if (direction < 0 && i-- == 0) {
        i = m_size - 1;
        seam = -kTurn;
      }
      const float turn = std::abs(m_returns[i].azimuth - azimuth + seam);
      const float behind = m_returns[i].rho - rho;
      const bool free = (turn > m_limits.gap) | (behind > m_limits.edge);
      if (free | (behind < -m_limits.step)) return free ? Side::free : Side::occluded;
      azimuth = m_returns[i].azimuth;
    }
    return Side::attached;
  }

 private:
  const Return& at(std::size_t i) const { return m_returns[i < m_size ? i : i - m_size]; }

  /// The bisector of the bearings of both ends, at the segment's range.
  void placeFront(const Return& a, const Return& b, ScanLineSegment& segment) const {
    const float x = m_lines.x(a) * b.rho + m_lines.x(b) * a.rho;
    const float y = m_lines.y(a) * b.rho + m_lines.y(b) * a.rho;
    const float scale = segment.rho / std::sqrt(x * x + y * y);
    segment.x = x * scale;
    segment.y = y * scale;
  }

  const ScanLines& m_lines;
  const Return* m_returns;
  std::size_t m_size;
  int m_row;
  const SegmentLimits& m_limits;
};

/// True when one side is free and none attached.
bool standsFree(Side left, Side right) {
  return static_cast<int>(left) * static_cast<int>(right) == 0 && left != Side::attached &&
         right != Side::attached;
}

}  // namespace

ScanLineSegmenter::ScanLineSegmenter(const SensorModel& sensor, const ScanLineOptions& options)
    : m_limits{2.6f * static_cast<float>(sensor.columnAngle()),
               static_cast<float>(options.connectStep), static_cast<float>(options.edgeStep),
               static_cast<float>(options.maxWidth), static_cast<float>(options.maxRange)} {
  // Bit left + 4 * right: those that stand free.
  for (int sides = 0; sides < 16; ++sides)
    m_free |= static_cast<std::uint32_t>(
                  standsFree(static_cast<Side>(sides & 3), static_cast<Side>(sides >> 2)))
              << sides;
}

/// Finds the runs of a row that may be segments. Most are not, and for no reason that could be
/// foreseen: so all are written, and only those that may be are counted.
void ScanLineSegmenter::findRuns(const ScanLines& lines, int r) {
  constexpr std::size_t kBefore = 2;  // numbers that findEdges() may read before the first
  const Row row(lines, r, m_limits);
  m_runs.clear();
  const std::size_t size = row.size();
  if (size == 0) return;
  if (m_sides.size() < size + kBefore + kKernelPadding) {
    const std::size_t room = 2 * size + kBefore + kKernelPadding;
    m_azimuth.resize(room);
    m_rho.resize(room);
    m_sides.resize(room);
    m_breaks.resize(room);
  }
  const float *azimuth = m_azimuth.data() + kBefore, *rho = m_rho.data() + kBefore;
  std::size_t breaks = findEdges(
      lines.begin(r), size, m_limits.step, m_limits.gap, m_limits.edge,
      {m_azimuth.data() + kBefore, m_rho.data() + kBefore, m_sides.data(), m_breaks.data()});
  const bool closed = row.closed();
  if (closed && breaks == 0) return;  // one closed ring: no ends, no pole
  m_breaks[breaks++] = static_cast<std::uint32_t>(closed ? size + m_breaks[0] : size - 1);
  m_runs.resize(breaks);
  std::uint32_t first = closed ? m_breaks[0] + 1 : 0;
  std::size_t count = 0;
  for (std::size_t b = closed ? 1 : 0; b < breaks; ++b) {
    const std::uint32_t last = m_breaks[b];
    int sides;
    float turn;
    if (first >= 2 && last + 2 < size) {
      sides = (m_sides[last] & 3) | (m_sides[first] & 12);
      turn = azimuth[last] - azimuth[first];
    } else {
      sides = static_cast<int>(row.side(last, +1)) + 4 * static_cast<int>(row.side(first, -1));
      turn = row.turnOf(first, last);
    }
    m_runs[count] = {first, last, static_cast<Side>(sides & 3), static_cast<Side>(sides >> 2)};
    count += (m_free >> sides & 1) &
             static_cast<unsigned>(rho[first] * turn <= 1.5f * m_limits.maxWidth) &
             static_cast<unsigned>(rho[first] <= m_limits.maxRange);
    first = last + 1;
  }
  m_runs.resize(count);
}

void ScanLineSegmenter::find(const ScanLines& lines, std::vector<ScanLineSegment>& segments) {
  segments.clear();
  for (int r = 0; r < lines.rows(); ++r) {
    findRuns(lines, r);
    const Row row(lines, r, m_limits);
    for (const SegmentRun& run : m_runs) row.append(run, segments);
  }
}

}  // namespace polemcl
