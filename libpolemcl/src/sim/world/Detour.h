#pragma once
/// \file Detour.h
/// \brief A side street that leaves the main one and comes back to it.

#include <vector>

#include "sim/world/Street.h"

namespace polemcl::sim {

/// \brief A way round through a side street.
struct Detour {
  Street path;    ///< the whole drive: the street, the way round, the rest of the street
  Street street;  ///< what is furnished: the way round, without its mouths
  std::vector<double> bends;   ///< where `street` turns, m along it
  double leave = 0, back = 0;  ///< the corners at the main street, m along that
  int side = 1;                ///< of the main street: 1 left, -1 right
};

/// \brief `side_streets` of them, each a U of 55 to 75 m away from the street and 70 to 100 m along
/// it: the same for the same seed and length on any day.
/// \throws Error when the street is too short, or too winding beside every place tried.
std::vector<Detour> planDetours(const WorldOptions& options, const Street& street);

}  // namespace polemcl::sim
