#include <polemcl/core/Slices.h>

#include <cmath>

namespace polemcl {
namespace {

constexpr float kTurn = static_cast<float>(2 * M_PI);

/// One row with wrapped indexing and its rules of connection.
class RowScanner {
 public:
  RowScanner(const ScanLines& lines, int row, const SensorModel& sensor,
             const NativeOptions& options)
      : m_returns(lines.begin(row)),
        m_size(lines.size(row)),
        m_row(row),
        m_gap(2.6f * static_cast<float>(sensor.columnAngle())),
        m_step(static_cast<float>(options.connectStep)),
        m_edge(static_cast<float>(options.edgeStep)),
        m_maxWidth(static_cast<float>(options.maxWidth)),
        m_maxRange(static_cast<float>(options.maxRange)) {}

  void scan(std::vector<Slice>& slices) const {
    if (m_size == 0) return;
    std::size_t start = 0;  // the first return after a break, so that no run straddles the seam
    while (start < m_size && connected(start + m_size - 1, start)) ++start;
    if (start == m_size) return;  // one closed ring: no ends, no pole
    for (std::size_t i = start; i < start + m_size;) {
      std::size_t last = i;
      while (last + 1 < start + m_size && connected(last, last + 1)) ++last;
      consider(i, last, slices);
      i = last + 1;
    }
  }

 private:
  const Return& at(std::size_t i) const {
    return m_returns[i < m_size ? i : i < 2 * m_size ? i - m_size : i - 2 * m_size];
  }
  /// Azimuth step from return i to its neighbour j >= i, positive across the seam too.
  float turn(std::size_t i, std::size_t j) const {
    const float step = at(j).azimuth - at(i).azimuth;
    return step < 0 || (step == 0 && i != j && at(i).point == at(j).point) ? step + kTurn : step;
  }
  bool connected(std::size_t i, std::size_t j) const {
    const Return &a = at(i), &b = at(j);
    if (!(std::abs(a.rho - b.rho) < m_step)) return false;
    const float step = turn(i, j);
    return step < m_gap || (step < 2 * m_gap && step * a.rho < 0.15f);
  }

  /// What is beside return `end` when walking outwards with `direction` (+1 left, -1 right).
  Side side(std::size_t end, int direction) const {
    const float rho = at(end).rho;
    std::size_t inner = end;
    for (int k = 0; k < 2;
         ++k) {  // a mixed pixel may stand between the edge and what lies behind it
      const std::size_t next = inner + m_size + direction;
      const float step =
          direction > 0 ? turn(inner % m_size, next % m_size) : turn(next % m_size, inner % m_size);
      if (step > m_gap) return Side::free;
      const float behind = at(next % m_size).rho - rho;
      if (behind > m_edge) return Side::free;
      if (behind < -m_step) return Side::occluded;
      inner = next % m_size;
    }
    return Side::attached;
  }

  void consider(std::size_t first, std::size_t last, std::vector<Slice>& slices) const {
    const float width = turn(first, last);
    float rho = at(first).rho, farthest = rho, z = 0;
    if (rho * width > 1.5f * m_maxWidth || rho > m_maxRange) return;
    for (std::size_t i = first; i <= last; ++i) {
      rho = std::min(rho, at(i).rho);
      farthest = std::max(farthest, at(i).rho);
      z += at(i).z;
    }
    if (rho * width > m_maxWidth || farthest - rho > m_maxWidth) return;
    Slice slice;
    slice.left = side(last % m_size, +1);
    slice.right = side(first % m_size, -1);
    if (slice.left == Side::attached || slice.right == Side::attached) return;
    if (slice.left != Side::free && slice.right != Side::free) return;
    slice.row = m_row;
    slice.first = static_cast<std::uint32_t>(first % m_size);
    slice.count = static_cast<std::uint32_t>(last - first + 1);
    slice.azimuthBegin = at(first).azimuth;
    slice.azimuthEnd = slice.azimuthBegin + width;
    slice.rho = rho;
    slice.z = z / static_cast<float>(slice.count);
    const float middle = slice.azimuthBegin + 0.5f * width;
    slice.x = rho * std::cos(middle);
    slice.y = rho * std::sin(middle);
    slices.push_back(slice);
  }

  const Return* m_returns;
  std::size_t m_size;
  int m_row;
  float m_gap, m_step, m_edge, m_maxWidth, m_maxRange;
};

}  // namespace

void findSlices(const ScanLines& lines, const SensorModel& sensor, const NativeOptions& options,
                std::vector<Slice>& slices) {
  slices.clear();
  for (int row = 0; row < lines.rows(); ++row) RowScanner(lines, row, sensor, options).scan(slices);
}

}  // namespace polemcl
