#pragma once
/// \file Traffic.h
/// \brief Objects that change from day to day: vehicles and people.

#include "sim/common/Random.h"
#include "sim/world/WorldObject.h"

namespace polemcl::sim {

/// \brief A parked car, van or lorry that points along local x.
WorldObject makeVehicle(const Site& site, std::uint32_t id, Random& random);
/// \brief A person standing or walking, below 2 m.
WorldObject makePerson(const Site& site, std::uint32_t id, Random& random);

}  // namespace polemcl::sim
