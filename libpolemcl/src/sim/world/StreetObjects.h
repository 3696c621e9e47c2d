#pragma once
/// \file StreetObjects.h
/// \brief Makers of the single objects along a street. They are centred on their site.

#include <optional>
#include <vector>

#include "sim/common/Random.h"
#include "sim/common/RealismOptions.h"
#include "sim/world/WorldObject.h"

namespace polemcl::sim {

/// \brief An object and, if it counts as one, its pole.
struct Piece {
  WorldObject object;
  std::optional<TruePole> pole;
};
/// \brief The true pole of an object. \param local Its axis at 1.5 m above ground, frame of the
/// site.
TruePole poleAt(const Site& site, std::uint32_t id, Kind kind, const Eigen::Vector3d& local,
                double radius, double top);

/// \brief The piece with the deviations that are drawn for it, and what else they bring: more
/// posts, a hedge.
std::vector<Piece> deviating(Piece piece, const Site& site, const RealismOptions& realism,
                             Random random);

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

/// \brief Trees of one planting: an avenue has one sort and age.
struct TreeStyle {
  double trunkRadius, crownBase, height, crownRadius;  ///< m
  explicit TreeStyle(Random& random);
};

/// \param foliage Scales the density of leaves; 0 gives bare branches.
Piece makeTree(const Site& site, std::uint32_t id, const TreeStyle& style, double foliage,
               Random& random);
WorldObject makeBush(const Site& site, std::uint32_t id, double foliage, Random& random);
/// \brief Hedge along local x, centred on the site.
WorldObject makeHedge(const Site& site, std::uint32_t id, double length, double foliage,
                      Random& random);

/// \brief A house with its front on local y = 0, centred on the site; it extends to y = depth.
/// Recessed doors, windows, pilasters, drain pipes, bays and balconies are added at random.
WorldObject makeHouse(const Site& site, std::uint32_t id, double length, double depth,
                      Random& random);
/// \brief A garden wall with pillars along local x.
WorldObject makeWall(const Site& site, std::uint32_t id, double length, Random& random);

/// \brief A parked car, van or lorry that points along local x.
WorldObject makeVehicle(const Site& site, std::uint32_t id, Random& random);
/// \brief A person, below 2 m.
WorldObject makePerson(const Site& site, std::uint32_t id, Random& random);

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
