#pragma once
/// \file ConstructionSites.h
/// \brief Objects that stand or lie beside a street for weeks: snow banks and building sites.

#include "sim/common/Random.h"
#include "sim/world/WorldObject.h"

namespace polemcl::sim {

/// Distance of a snow bank's middle from the kerb, m.
inline constexpr double kSnowBankMiddle = 0.75;

/// Distance of a building site's fence from the kerb, m.
inline constexpr double kSiteFence = 0.15;

/// \brief A piece of a snow bank along local x, about 2.3 m wide. Where poles stand (0.4 to 1.1 m
/// from the kerb) it is at least `height` m high.
WorldObject makeSnowBank(const Site& site, std::uint32_t id, double length, double height,
                         Random& random);
/// \brief A hoarding of boards along local x, above eye level.
WorldObject makeHoarding(const Site& site, std::uint32_t id, double length, Random& random);
/// \brief Mesh fences along local x, 2 m high, on slim posts with concrete feet.
WorldObject makeSiteFence(const Site& site, std::uint32_t id, double length, Random& random);
/// \brief A container, 6 m long, along local x.
WorldObject makeContainer(const Site& site, std::uint32_t id);
/// \brief A traffic beacon, 1 m high, with or without a lamp.
WorldObject makeBeacon(const Site& site, std::uint32_t id, Random& random);

}  // namespace polemcl::sim
