#pragma once
/// \file BuildingSite.h
/// \brief Stretches of pavement that are fenced off for weeks.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace polemcl::sim {

/// \brief A building site beside a street. It stands on days d with firstDay <= d < endDay.
struct BuildingSite {
  std::uint64_t seed = 0;           ///< of what differs from other sites; the same on all its days
  double firstDay = 0, endDay = 0;  ///< days since the day of the map; may be negative
  int side = 1;                     ///< of its street: 1 left, -1 right
  double from = 0, to = 0;          ///< m along its street
  bool boards = false;              ///< a hoarding of boards; else fences of mesh
  std::vector<Eigen::Vector2d> kerb;  ///< its fence along the kerb, m, map frame, about every metre
};

}  // namespace polemcl::sim
