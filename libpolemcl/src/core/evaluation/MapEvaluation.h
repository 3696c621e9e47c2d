#pragma once
/// \file MapEvaluation.h
/// \brief How good a pole map is: precision, recall and F1 in the authors' ways, and how far it has
/// been moved as a whole.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <polemcl/export.h>

namespace polemcl {

struct MapScore {
  std::size_t mapPoles = 0, truthPoles = 0, matches = 0;
  double precision = 0;  ///< matches / mapPoles
  double recall = 0;     ///< matches / truthPoles
  double f1 = 0;         ///< harmonic mean of the two; 0 without matches
};
/// \brief Matches map poles to truth poles within `radius` (inclusive), m.
/// \param oneToOne false: TP = map poles whose nearest truth pole lies within the radius, for both
///        figures (the authors' way; recall can exceed 1). true: maximum bipartite matching.
/// \throws Error when either set is empty or holds a pole that is not finite, or the radius is not
///         finite and positive.
POLEMCL_EXPORT MapScore scoreMap(const std::vector<Eigen::Vector2d>& truth,
                                 const std::vector<Eigen::Vector2d>& map, double radius,
                                 bool oneToOne);

/// \brief The rigid motion that takes the true poles onto those of the map (least squares).
struct MapShift {
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  ///< mean of map - truth over the pairs, m
  double rotation = 0;    ///< about the mean of the true poles, rad, counter-clockwise
  std::size_t pairs = 0;  ///< one to one, nearest first; with fewer than 2 the rotation is 0
};

/// \param radius Greatest distance of a pair, m.
/// \throws Error as greedyAssignment().
MapShift mapShift(const std::vector<Eigen::Vector2d>& truth,
                  const std::vector<Eigen::Vector2d>& map, double radius);

/// \brief Maximum matching in a sparse bipartite graph (augmenting paths, Kuhn 1955): size of the
/// largest set of edges of which no two share an end. O(edges · matches).
/// \param edges edges[l] lists the right nodes that left node l may take, each in [0, rightCount).
std::size_t maximumMatching(const std::vector<std::vector<std::uint32_t>>& edges,
                            std::size_t rightCount);

}  // namespace polemcl
