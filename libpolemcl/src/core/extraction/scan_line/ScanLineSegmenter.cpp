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
  const Return* returns() const { return m_returns; }

  /// True when the last and the first return of the row are neighbours on one surface.
  bool closed() const {
    const Return &a = m_returns[m_size - 1], &b = m_returns[0];
    return joined(a, b, b.azimuth + kTurn - a.azimuth, m_limits.step, m_limits.gap);
  }

  /// Appends the run of returns first..last (last may be size or more: it wraps) if it is a
  /// segment.
  void consider(std::size_t first, std::size_t last, std::vector<ScanLineSegment>& segments) const {
    const Return &begin = m_returns[first], &end = at(last);
    const float turn = end.azimuth - begin.azimuth + (last < m_size ? 0 : kTurn);
    if (begin.rho * turn > 1.5f * m_limits.maxWidth || begin.rho > m_limits.maxRange) return;
    const Side left = side(last < m_size ? last : last - m_size, +1);
    const Side right = side(first, -1);
    // One of them free, and none attached.
    if (static_cast<int>(left) * static_cast<int>(right) != 0 || left == Side::attached ||
        right == Side::attached)
      return;
    float rho = begin.rho, farthest = rho, z = 0;
    for (std::size_t i = first; i <= last; ++i) {
      const Return& r = at(i);
      rho = std::min(rho, r.rho);
      farthest = std::max(farthest, r.rho);
      z += r.z;
    }
    if (rho * turn > m_limits.maxWidth || farthest - rho > m_limits.maxWidth) return;
    ScanLineSegment& segment = segments.emplace_back();
    segment.left = left;
    segment.right = right;
    segment.row = m_row;
    segment.first = static_cast<std::uint32_t>(first);
    segment.count = static_cast<std::uint32_t>(last - first + 1);
    segment.azimuthBegin = begin.azimuth;
    segment.azimuthEnd = begin.azimuth + turn;
    segment.rho = rho;
    segment.z = z / static_cast<float>(segment.count);
    placeFront(begin, end, segment);
  }

 private:
  const Return& at(std::size_t i) const { return m_returns[i < m_size ? i : i - m_size]; }

  /// What is beside return `end` when walking outwards with `direction` (+1 left, -1 right).
  Side side(std::size_t end, int direction) const {
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

}  // namespace

ScanLineSegmenter::ScanLineSegmenter(const SensorModel& sensor, const ScanLineOptions& options)
    : m_limits{2.6f * static_cast<float>(sensor.columnAngle()),
               static_cast<float>(options.connectStep), static_cast<float>(options.edgeStep),
               static_cast<float>(options.maxWidth), static_cast<float>(options.maxRange)} {}

void ScanLineSegmenter::find(const ScanLines& lines, std::vector<ScanLineSegment>& segments) {
  segments.clear();
  for (int r = 0; r < lines.rows(); ++r) {
    const Row row(lines, r, m_limits);
    if (row.size() == 0) continue;
    if (m_breaks.size() < row.size() + kKernelPadding)
      m_breaks.resize(2 * row.size() + kKernelPadding);
    const std::size_t breaks =
        findBreaks(row.returns(), row.size(), m_limits.step, m_limits.gap, m_breaks.data());
    const bool closed = row.closed();
    if (closed && breaks == 0) continue;  // one closed ring: no ends, no pole
    std::size_t first = closed ? m_breaks[0] + 1 : 0;
    for (std::size_t b = closed ? 1 : 0; b < breaks; ++b) {
      row.consider(first, m_breaks[b], segments);
      first = m_breaks[b] + 1;
    }
    row.consider(first, closed ? row.size() + m_breaks[0] : row.size() - 1, segments);
  }
}

}  // namespace polemcl
