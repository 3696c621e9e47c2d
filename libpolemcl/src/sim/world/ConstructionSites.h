#pragma once
/// \file ConstructionSites.h
/// \brief What stands or lies beside a street for weeks: snow banks and building sites.

#include "sim/common/Random.h"
#include "sim/world/WorldObject.h"

namespace polemcl::sim {

/// Middle of a snow bank beyond the kerb, m.
inline constexpr double kSnowBankMiddle = 0.75;

/// Fences of building sites beyond the kerb, m.
inline constexpr double kSiteFence = 0.15;

/// \brief A piece of a bank along local x, `height` m high or a little more wherever poles stand
/// along the kerb (0.4 to 1.1 m beyond it), about 2.3 m wide.
WorldObject makeSnowBank(const Site& site, std::uint32_t id, double length, double height,
                         Random& random);
/// \brief A hoarding of boards along local x, higher than a man.
WorldObject makeHoarding(const Site& site, std::uint32_t id, double length, Random& random);
/// \brief Fences of mesh along local x, 2 m high, on slim posts with feet of concrete.
WorldObject makeSiteFence(const Site& site, std::uint32_t id, double length, Random& random);
/// \brief A container of 6 m along local x.
WorldObject makeContainer(const Site& site, std::uint32_t id);
/// \brief A beacon of 1 m that traffic has to pass, with or without a lamp.
WorldObject makeBeacon(const Site& site, std::uint32_t id, Random& random);

}  // namespace polemcl::sim
