#pragma once
/// \file StreetLayout.h
/// \brief What stands where along a street, for good and on one day.

#include <unordered_map>

#include "sim/world/Furniture.h"
#include "sim/world/World.h"

namespace polemcl::sim {

/// \brief Roads that leave the street at s.
struct Crossing {
  double s;
  bool left, right;
  double halfWidth;
  bool straight = true;  ///< its roads are made by sideRoads(); false: a side street does
};
std::vector<Crossing> planCrossings(const WorldOptions& options, const Street& street,
                                    const std::vector<Detour>& detours);
std::vector<SideRoad> sideRoads(const std::vector<Crossing>& crossings, const Street& street,
                                const WorldOptions& options);

/// \brief Which street of a world a plan fills.
struct StreetPart {
  std::uint32_t index = 0;  ///< 0: the main street; others are side streets, open at both ends
};

/// \brief Takes away poles that a house or wall of another street, or of another turn of this one,
/// was built over.
void removeBuiltOver(std::vector<WorldObject>& objects, std::vector<TruePole>& poles);

/// \brief Fills a street. Permanent things draw from streams of (seed, kind, place), so that they
/// are the same on every day; what a day changes draws from (seed, day, ...).
class StreetLayout {
 public:
  StreetLayout(const WorldOptions& options, const Street& street, const Terrain& terrain,
               const std::vector<Crossing>& crossings, StreetPart part = {});
  void furnish();
  std::vector<WorldObject> objects;
  std::vector<TruePole> poles;
  std::vector<BuildingSite> sites;  ///< of this day

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
  // Of the year: StreetPlanYear.cpp
  struct Planned {
    std::uint32_t id;
    Kind kind;
    Site place;
  };
  void replacedPoles();
  /// \brief A pole comes for good, beside the one whose number it keeps up or anywhere.
  void settle(const Planned& old, bool beside);
  void snowBanks(double height);
  // Of some weeks: StreetPlanSites.cpp
  void planSites();
  /// \brief A place for a site within its piece of the street, from `start` m on.
  void findSite(BuildingSite site, double start, double length);
  void buildSite(const BuildingSite& site);
  void fenceOff(const BuildingSite& site, double depth, std::uint32_t& id, Random& random);
  /// \brief Takes away what has no place in building sites today.
  void clearSites();
  /// \brief The site whose ground holds a place, from `beyond` m beyond the kerb on; or none.
  const BuildingSite* siteAt(double x, double y, double beyond) const;

  Random stream(std::uint64_t kind, int side, std::uint64_t index = 0) const;
  Random dayStream(std::uint64_t kind, int side, std::uint64_t index = 0) const;
  double pavementWidth(int side, double s) const;
  bool nearCrossing(int side, double s, double gap) const;
  Site site(int side, double s, double lateral) const;
  /// \brief True and taken when nothing stands within `gap` and the ground is right.
  bool claim(const Site& place, double gap, Ground ground);
  bool goneToday(std::uint32_t id) const;
  /// \brief The day on which a permanent pole goes for good; infinity if it never does.
  double lastDayOf(std::uint32_t id) const;
  void add(WorldObject object) { objects.push_back(std::move(object)); }
  void add(Piece piece, const Site& place);

  const WorldOptions& m_options;
  const Street& m_street;
  const Terrain& m_terrain;
  const std::vector<Crossing>& m_crossings;
  struct Yard {
    int side;
    double s, length, border;
  };
  std::vector<Yard> m_yards;
  std::vector<Planned> m_planned;  ///< permanent poles, those that are gone by now too
  const std::uint32_t m_street0;   ///< where the ids of this street begin
  const bool m_open;               ///< houses do not close the ends
  std::uint32_t m_nextId;
  bool m_permanent = true;  ///< what is added now has stood there since day 0
  std::unordered_map<std::int64_t, std::vector<Eigen::Vector3d>> m_taken;  ///< x, y, gap
};

}  // namespace polemcl::sim
