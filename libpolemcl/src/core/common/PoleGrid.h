#pragma once
/// \file PoleGrid.h
/// \brief Nearest point within a prepared radius in one look-up: a hashed grid of candidates.
///
/// Each cell of the plane that some point can be reached from lists every point that can be the
/// nearest one of any place in the cell. Poles stand metres apart, so a cell mostly lists one point
/// and most of the plane lists none: a search is one hash and one distance. Exact; the k-d tree is
/// its oracle in the tests. Who asks it in place of the tree: PoleIndex (likelihood, nearest pole
/// within the prepared radius) and the global search.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/common/KdTree2D.h"

namespace polemcl {

class PoleGrid {
 public:
  /// \param points Finite (the k-d tree over them checks). \param radius Largest search radius, >
  /// 0, m.
  PoleGrid(const std::vector<Eigen::Vector2d>& points, double radius);

  double radius() const { return m_radius; }
  /// \brief A point of the grid.
  struct Place {
    double x, y;          ///< m
    std::uint32_t index;  ///< into the points given to the constructor
  };
  /// \brief Nearest point with squared distance < squaredRadius; null without one. The lower
  /// index wins a tie. A query that is not a number finds nothing.
  /// \param squaredRadius At most radius()², m²; beyond it the answer would not be complete.
  const Place* find(double x, double y, double squaredRadius) const noexcept {
    if (!(x >= m_minX && x <= m_maxX && y >= m_minY && y <= m_maxY)) return nullptr;
    const auto column = static_cast<std::int64_t>((x - m_minX) * m_inverseCell);
    const auto row = static_cast<std::int64_t>((y - m_minY) * m_inverseCell);
    const Cell* cell = cellOf(keyOf(column, row));
    if (!cell) return nullptr;
    const Place* best = nullptr;
    for (std::uint32_t i = cell->begin; i < cell->end; ++i) {
      const double squared = squaredDistance(m_candidates[i], x, y);
      if (squared < squaredRadius) {
        squaredRadius = squared;
        best = &m_candidates[i];
      }
    }
    return best;
  }
  /// \brief Every point that can be the nearest one, within radius(), of a place in a rectangle.
  /// \param candidates Gets them, each once, by ascending index.
  /// \return False for a rectangle that has too many of them, or spans too many cells, for one list
  ///         to be better than a look-up for each place: `candidates` then means nothing.
  bool candidatesIn(double lowX, double lowY, double highX, double highY,
                    std::vector<Place>& candidates) const;
  /// \brief The same as index and squared distance.
  PointHit nearest(double x, double y, double squaredRadius) const noexcept {
    const Place* place = find(x, y, squaredRadius);
    return place ? PointHit{place->index, squaredDistance(*place, x, y)} : PointHit{};
  }

 private:
  struct Cell {
    std::uint64_t key = kNoKey;
    std::uint32_t begin = 0, end = 0;  ///< into m_candidates
  };
  struct Entry;
  static constexpr std::uint64_t kNoKey = ~std::uint64_t{0};

  static double squaredDistance(const Place& place, double x, double y) noexcept {
    const double dx = x - place.x, dy = y - place.y;
    return dx * dx + dy * dy;
  }
  static std::uint64_t keyOf(std::int64_t column, std::int64_t row) {
    return static_cast<std::uint64_t>(row) << 32 | static_cast<std::uint64_t>(column);
  }
  /// Fibonacci hashing: the high bits of the product mix row and column.
  std::uint64_t slotOf(std::uint64_t key) const { return key * 0x9E3779B97F4A7C15u >> m_shift; }

  /// Null if nothing can be reached from the cell.
  const Cell* cellOf(std::uint64_t key) const noexcept {
    std::uint64_t slot = slotOf(key);
    while (m_cells[slot].key != key) {
      if (m_cells[slot].key == kNoKey) return nullptr;
      slot = (slot + 1) & m_mask;
    }
    return &m_cells[slot];
  }

  void setBounds(const std::vector<Eigen::Vector2d>& points);
  std::vector<Entry> entriesOf(const std::vector<Eigen::Vector2d>& points) const;
  void addCell(const std::vector<Eigen::Vector2d>& points, const Entry* begin, const Entry* end);
  void reserveCells(std::size_t cells);

  double m_radius;
  double m_cell = 1, m_inverseCell = 1;
  double m_margin = 0;  ///< more than rounding can move a query across a cell's border, m
  double m_minX = 1, m_maxX = 0, m_minY = 1,
         m_maxY = 0;  ///< places that reach a point; empty at first
  std::uint64_t m_mask = 0;
  int m_shift = 63;
  std::vector<Cell> m_cells;
  std::vector<Place> m_candidates;
};

}  // namespace polemcl
