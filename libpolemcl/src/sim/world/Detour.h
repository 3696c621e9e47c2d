#pragma once
/// \file Detour.h
/// \brief A side street that leaves the main street and returns to it.

#include <vector>

#include "sim/world/Street.h"

namespace polemcl::sim {

/// \brief A route through a side street.
struct Detour {
  Street path;                 ///< the whole drive: street, side street, rest of the street
  Street street;               ///< the furnished part: the side street without its mouths
  std::vector<double> bends;   ///< positions of the bends, m along `street`
  double leave = 0, back = 0;  ///< corners at the main street, m along the main street
  int side = 1;                ///< side of the main street: 1 left, -1 right
};

/// \brief Plans `side_streets` detours. Each is a U that goes 55 to 75 m away from the street and
/// 70 to 100 m along it. Equal seed and length give equal detours on any day.
/// \throws Error when the street is too short, or has too many bends at every place tried.
std::vector<Detour> planDetours(const WorldOptions& options, const Street& street);

}  // namespace polemcl::sim
