#pragma once
/// \file Furniture.h
/// \brief Metal, wooden and stone objects along a street.

#include <optional>

#include "sim/common/Random.h"
#include "sim/world/WorldObject.h"

namespace polemcl::sim {

/// \brief An object and, if it counts as one, its pole.
struct Piece {
  WorldObject object;
  std::optional<TruePole> pole;
};

/// \brief Lamp posts of one type; a street keeps one type for a few hundred metres.
struct LampStyle {
  double height, baseRadius, topRadius;  ///< m
  double armLength;                      ///< m, 0: lamp on top
  bool thickFoot;                        ///< wider up to the fuse box door
  explicit LampStyle(Random& random);
};

Piece makeLampPost(const Site& site, std::uint32_t id, const LampStyle& style, Random& random);
Piece makeSign(const Site& site, std::uint32_t id, Random& random);
Piece makeTrafficLight(const Site& site, std::uint32_t id, Random& random);
WorldObject makeBollard(const Site& site, std::uint32_t id, Random& random);
WorldObject makeBin(const Site& site, std::uint32_t id, Random& random);
WorldObject makeBillboard(const Site& site, std::uint32_t id, Random& random);
WorldObject makeCabinet(const Site& site, std::uint32_t id, Random& random);
WorldObject makeAdvertColumn(const Site& site, std::uint32_t id, Random& random);
WorldObject makeBicycle(const Site& site, std::uint32_t id, Random& random);
/// \brief Fence of posts below 2 m with rails or pickets, along local x, centred on the site.
WorldObject makeFence(const Site& site, std::uint32_t id, double length, Random& random);

}  // namespace polemcl::sim
