#pragma once
/// \file Buildings.h
/// \brief House fronts and walls.

#include "sim/common/Random.h"
#include "sim/world/WorldObject.h"

namespace polemcl::sim {

/// \brief A house whose front lies on local y = 0, centred on the site; it reaches to y = depth.
/// With recessed doors, windows, pilasters, drain pipes, bays and balconies as chance has it.
WorldObject makeHouse(const Site& site, std::uint32_t id, double length, double depth,
                      Random& random);
/// \brief A garden wall along local x with pillars.
WorldObject makeWall(const Site& site, std::uint32_t id, double length, Random& random);

}  // namespace polemcl::sim
