#include "core/common/PoleGrid.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

namespace polemcl {
namespace {

/// Squared distances from a point to the nearest and to the farthest place of a rectangle.
struct Reach {
  double nearest, farthest;
};
Reach reach(double x, double y, double lowX, double lowY, double highX, double highY) {
  const double outX = std::max({lowX - x, 0.0, x - highX}),
               outY = std::max({lowY - y, 0.0, y - highY});
  const double farX = std::max(highX - x, x - lowX), farY = std::max(highY - y, y - lowY);
  return {outX * outX + outY * outY, farX * farX + farY * farY};
}

/// Indices of the points, without those that lie exactly on one with a lower index.
std::vector<std::uint32_t> distinct(const std::vector<Eigen::Vector2d>& points) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::make_tuple(points[a].x(), points[a].y(), a) <
           std::make_tuple(points[b].x(), points[b].y(), b);
  });
  const auto same = [&](std::uint32_t a, std::uint32_t b) { return points[a] == points[b]; };
  order.erase(std::unique(order.begin(), order.end(), same), order.end());
  return order;
}

}  // namespace

bool PoleGrid::candidatesIn(double lowX, double lowY, double highX, double highY,
                            std::vector<Place>& candidates) const {
  constexpr std::int64_t mostCells = 64;
  constexpr std::size_t mostCandidates = 12;
  candidates.clear();
  if (!(lowX <= highX && lowY <= highY)) return false;  // not numbers, for one
  lowX = std::max(lowX, m_minX), highX = std::min(highX, m_maxX);
  lowY = std::max(lowY, m_minY), highY = std::min(highY, m_maxY);
  if (!(lowX <= highX && lowY <= highY)) return true;  // beyond reach of every point
  const auto cell = [&](double from, double to) {
    return static_cast<std::int64_t>((to - from) * m_inverseCell);
  };
  const std::int64_t firstColumn = cell(m_minX, lowX), lastColumn = cell(m_minX, highX);
  const std::int64_t firstRow = cell(m_minY, lowY), lastRow = cell(m_minY, highY);
  const std::int64_t columns = lastColumn - firstColumn + 1, rows = lastRow - firstRow + 1;
  if (columns > mostCells || rows > mostCells || columns * rows > mostCells) return false;
  for (std::int64_t row = firstRow; row <= lastRow; ++row)
    for (std::int64_t column = firstColumn; column <= lastColumn; ++column)
      if (const Cell* listed = cellOf(keyOf(column, row)))
        candidates.insert(candidates.end(), m_candidates.begin() + listed->begin,
                          m_candidates.begin() + listed->end);
  std::sort(candidates.begin(), candidates.end(),
            [](const Place& a, const Place& b) { return a.index < b.index; });
  const auto same = [](const Place& a, const Place& b) { return a.index == b.index; };
  candidates.erase(std::unique(candidates.begin(), candidates.end(), same), candidates.end());
  return candidates.size() <= mostCandidates;
}

/// A point that can be reached from a cell.
struct PoleGrid::Entry {
  std::uint64_t key;
  std::uint32_t point;
  Reach reach;
};

PoleGrid::PoleGrid(const std::vector<Eigen::Vector2d>& points, double radius) : m_radius(radius) {
  m_cells.resize(2);
  m_mask = 1;
  if (points.empty()) return;
  setBounds(points);
  const std::vector<Entry> entries = entriesOf(points);
  std::size_t cells = 0;
  for (std::size_t i = 0; i < entries.size(); ++i)
    cells += i == 0 || entries[i].key != entries[i - 1].key;
  reserveCells(cells);
  for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
    while (end < entries.size() && entries[end].key == entries[begin].key) ++end;
    addCell(points, entries.data() + begin, entries.data() + end);
  }
}

void PoleGrid::setBounds(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Vector2d low = points[0], high = points[0];
  for (const Eigen::Vector2d& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double extent = (high - low).maxCoeff() + 2 * m_radius;
  // Twice the radius: a pole is then listed in 4 cells, few enough to stay in the cache, and a cell
  // still lists hardly more than one. Rows and columns have 32 bits of the key each.
  // Much wider than the margin for rounding too, and its inverse is finite, for any radius.
  const double magnitude = std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff()) + extent;
  m_cell = std::max({2 * m_radius, magnitude * 0x1p-30, 1e-300});
  m_inverseCell = 1 / m_cell;
  m_margin = 1e-9 * m_cell + 8 * std::numeric_limits<double>::epsilon() * magnitude;
  m_minX = low.x() - m_radius - 2 * m_margin;
  m_minY = low.y() - m_radius - 2 * m_margin;
  m_maxX = high.x() + m_radius + 2 * m_margin;
  m_maxY = high.y() + m_radius + 2 * m_margin;
}

std::vector<PoleGrid::Entry> PoleGrid::entriesOf(const std::vector<Eigen::Vector2d>& points) const {
  std::vector<Entry> entries;
  entries.reserve(points.size() * 9);
  const double radius = m_radius + m_margin;
  for (const std::uint32_t i : distinct(points)) {
    const double x = points[i].x() - m_minX, y = points[i].y() - m_minY;
    const auto firstColumn =
        static_cast<std::int64_t>(std::max(0.0, (x - radius - m_margin) * m_inverseCell));
    const auto firstRow =
        static_cast<std::int64_t>(std::max(0.0, (y - radius - m_margin) * m_inverseCell));
    const auto lastColumn = static_cast<std::int64_t>((x + radius + m_margin) * m_inverseCell);
    const auto lastRow = static_cast<std::int64_t>((y + radius + m_margin) * m_inverseCell);
    for (std::int64_t row = firstRow; row <= lastRow; ++row) {
      for (std::int64_t column = firstColumn; column <= lastColumn; ++column) {
        const double lowX = static_cast<double>(column) * m_cell - m_margin;
        const double lowY = static_cast<double>(row) * m_cell - m_margin;
        const Reach r =
            reach(x, y, lowX, lowY, lowX + m_cell + 2 * m_margin, lowY + m_cell + 2 * m_margin);
        if (r.nearest <= radius * radius) entries.push_back({keyOf(column, row), i, r});
      }
    }
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.key != b.key ? a.key < b.key : a.point < b.point;
  });
  return entries;
}

void PoleGrid::reserveCells(std::size_t cells) {
  m_shift = 62;
  while ((std::uint64_t{1} << (64 - m_shift)) < 2 * cells) --m_shift;  // at most half full
  m_cells.assign(std::uint64_t{1} << (64 - m_shift), Cell{});
  m_mask = m_cells.size() - 1;
}

void PoleGrid::addCell(const std::vector<Eigen::Vector2d>& points, const Entry* begin,
                       const Entry* end) {
  double bound = std::numeric_limits<double>::infinity();
  for (const Entry* e = begin; e != end; ++e) bound = std::min(bound, e->reach.farthest);
  Cell cell;
  cell.key = begin->key;
  cell.begin = static_cast<std::uint32_t>(m_candidates.size());
  for (const Entry* e = begin; e != end; ++e) {
    // Nowhere in the cell can it be the nearest: some other point is nearer everywhere. (Both
    // distances belong to a rectangle widened by the margin, so rounding cannot rule it out.)
    if (e->reach.nearest > bound) continue;
    m_candidates.push_back({points[e->point].x(), points[e->point].y(), e->point});
  }
  cell.end = static_cast<std::uint32_t>(m_candidates.size());
  std::uint64_t slot = slotOf(cell.key);
  while (m_cells[slot].key != kNoKey) slot = (slot + 1) & m_mask;
  m_cells[slot] = cell;
}

}  // namespace polemcl
