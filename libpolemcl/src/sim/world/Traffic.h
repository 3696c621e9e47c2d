#pragma once
/// \file Traffic.h
/// \brief What is elsewhere on another day: vehicles and people.

#include "sim/common/Random.h"
#include "sim/world/WorldObject.h"

namespace polemcl::sim {

/// \brief A parked car, van or lorry; it points along local x.
WorldObject makeVehicle(const Site& site, std::uint32_t id, Random& random);
/// \brief Someone standing or in mid-step, below 2 m.
WorldObject makePerson(const Site& site, std::uint32_t id, Random& random);

}  // namespace polemcl::sim
