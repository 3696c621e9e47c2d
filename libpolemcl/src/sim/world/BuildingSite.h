#pragma once
/// \file BuildingSite.h
/// \brief Parts of the pavement that are fenced off for weeks.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace polemcl::sim {

/// \brief A building site beside a street. It exists on days d with firstDay <= d < endDay.
struct BuildingSite {
  std::uint64_t seed = 0;             ///< seed of its details; equal on all its days
  double firstDay = 0, endDay = 0;    ///< days since the day of the map; may be negative
  int side = 1;                       ///< side of its street: 1 left, -1 right
  double from = 0, to = 0;            ///< m along its street
  bool boards = false;                ///< hoarding of boards; otherwise mesh fences
  std::vector<Eigen::Vector2d> kerb;  ///< fence along the kerb, map frame, about 1 m apart
};

}  // namespace polemcl::sim
