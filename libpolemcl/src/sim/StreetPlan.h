#pragma once
/// \file StreetPlan.h
/// \brief What stands where along a street, for good and on one day.

#include <polemcl/sim/World.h>

#include <unordered_map>

#include "Furniture.h"

namespace polemcl::sim {

/// \brief Roads that leave the street at s.
struct Crossing {
  double s;
  bool left, right;
  double halfWidth;
};
std::vector<Crossing> planCrossings(const WorldOptions& options, const Street& street);
std::vector<SideRoad> sideRoads(const std::vector<Crossing>& crossings, const Street& street,
                                const WorldOptions& options);

/// \brief Fills a street. Permanent things draw from streams of (seed, kind, place), so that they
/// are the same on every day; what a day changes draws from (seed, day, ...).
class StreetPlan {
 public:
  StreetPlan(const WorldOptions& options, const Street& street, const Terrain& terrain,
             const std::vector<Crossing>& crossings);
  void furnish();
  std::vector<WorldObject> objects;
  std::vector<TruePole> poles;

 private:
  enum class Ground { lot, pavement, road };
  // Buildings and gardens: StreetPlanLots.cpp
  void lots(int side);
  double lot(int side, double s, Random& random);
  void house(int side, double s, double length, double setBack, Random& random);
  void garden(int side, double s, double length, double depth, Random& random);
  /// \brief Paved ground before a house, where vehicles may stand.
  void yard(int side, double s, double length, Random& random);
  void park(int side, double s, double length, Random& random);
  // Along the kerb: StreetPlanKerb.cpp
  void crossingFurniture();
  void lamps(int side);
  void avenue(int side);
  void signs(int side);
  void smallThings(int side);
  // Of one day: StreetPlanDay.cpp
  void addedPoles(std::size_t permanentPoles);
  void parkedVehicles(int side);
  void vehiclesInYards();
  void people(int side);

  Random stream(std::uint64_t kind, int side, std::uint64_t index = 0) const;
  Random dayStream(std::uint64_t kind, int side, std::uint64_t index = 0) const;
  double pavementWidth(int side, double s) const;
  bool nearCrossing(int side, double s, double gap) const;
  Site site(int side, double s, double lateral) const;
  /// \brief True and taken when nothing stands within `gap` and the ground is right.
  bool claim(const Site& place, double gap, Ground ground);
  bool goneToday(std::uint32_t id) const;
  /// \brief Takes away poles that a house or wall of another turn of the road was built over.
  void removeBuiltOver();
  void add(WorldObject object) { objects.push_back(std::move(object)); }
  void add(Piece piece);

  const WorldOptions& m_options;
  const Street& m_street;
  const Terrain& m_terrain;
  const std::vector<Crossing>& m_crossings;
  struct Yard {
    int side;
    double s, length, border;
  };
  std::vector<Yard> m_yards;
  std::uint32_t m_nextId = 1;
  std::unordered_map<std::int64_t, std::vector<Eigen::Vector3d>> m_taken;  ///< x, y, gap
};

}  // namespace polemcl::sim
