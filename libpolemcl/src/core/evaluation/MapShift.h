#pragma once
/// \file MapShift.h
/// \brief How far a pole map as a whole has been moved from the truth.

#include <Eigen/Core>
#include <vector>

namespace polemcl {

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

}  // namespace polemcl
