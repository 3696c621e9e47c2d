#pragma once
/// \file Buildings.h
/// \brief House fronts and walls.

#include "sim/common/Random.h"
#include "sim/world/WorldObject.h"

namespace polemcl::sim {

/// \brief A house with its front on local y = 0, centred on the site; it extends to y = depth.
/// Recessed doors, windows, pilasters, drain pipes, bays and balconies are added at random.
WorldObject makeHouse(const Site& site, std::uint32_t id, double length, double depth,
                      Random& random);
/// \brief A garden wall with pillars along local x.
WorldObject makeWall(const Site& site, std::uint32_t id, double length, Random& random);

}  // namespace polemcl::sim
