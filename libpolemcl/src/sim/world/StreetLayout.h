#pragma once
/// \file StreetLayout.h
/// \brief Layout of the objects along a street: permanent ones and those of one day.

#include <unordered_map>

#include "sim/world/StreetObjects.h"
#include "sim/world/World.h"

namespace polemcl::sim {

/// \brief Side roads that leave the street at s.
struct Crossing {
  double s;
  bool left, right;
  double halfWidth;
  bool straight = true;  ///< its roads are made by sideRoads(); false: by a detour
};
std::vector<Crossing> planCrossings(const WorldOptions& options, const Street& street,
                                    const std::vector<Detour>& detours);
std::vector<SideRoad> sideRoads(const std::vector<Crossing>& crossings, const Street& street,
                                const WorldOptions& options);

/// \brief Removes poles that stand inside a house, wall or container of another street or another
/// part of this street.
void removeBuiltOver(std::vector<WorldObject>& objects, std::vector<TruePole>& poles);

/// \brief Fills a street. Permanent objects are drawn from streams of (seed, kind, place), so that
/// they are equal on every day. Changes of a day are drawn from (seed, day, ...).
class StreetLayout {
 public:
  /// \param index 0: main street; others: side streets, open at both ends.
  StreetLayout(const WorldOptions& options, const Street& street, const Terrain& terrain,
               const std::vector<Crossing>& crossings, std::uint32_t index = 0);
  void furnish();
  std::vector<WorldObject> objects;
  std::vector<TruePole> poles;
  std::vector<BuildingSite> sites;  ///< sites of this day

 private:
  enum class Ground { lot, pavement, road };
  // Buildings and gardens: StreetLayoutPermanent.cpp
  void lots(int side);
  double lot(int side, double s, Random& random);
  void house(int side, double s, double length, double setBack, Random& random);
  void garden(int side, double s, double length, double depth, Random& random);
  /// \brief Paved ground in front of a house, where vehicles may park.
  void yard(int side, double s, double length, Random& random);
  void park(int side, double s, double length, Random& random);
  // Along the kerb: StreetLayoutPermanent.cpp
  void crossingFurniture();
  void lamps(int side);
  void avenue(int side);
  void signs(int side);
  void smallThings(int side);
  // Objects of one day: StreetLayoutChanges.cpp
  void addedPoles(std::size_t permanentPoles);
  void parkedVehicles(int side);
  void vehiclesInYards();
  void people(int side);
  // Changes of the year: StreetLayoutChanges.cpp
  struct Planned {
    std::uint32_t id;
    Kind kind;
    Site place;
  };
  void replacedPoles();
  /// \brief Adds a permanent pole that replaces an old one, beside it or anywhere.
  void settle(const Planned& old, bool beside);
  void snowBanks(double height);
  // Objects of some weeks: StreetLayoutSites.cpp
  void planSites();
  /// \brief Finds a place for a site within its piece of the street, from `start` m on.
  void findSite(BuildingSite site, double start, double length);
  void buildSite(const BuildingSite& site);
  void fenceOff(const BuildingSite& site, double depth, std::uint32_t& id, Random& random);
  /// \brief Removes objects that cannot stand in today's building sites.
  void clearSites();
  /// \brief The site whose ground contains a place, from `beyond` m beyond the kerb on; null if
  /// there is no such site.
  const BuildingSite* siteAt(double x, double y, double beyond) const;

  Random stream(std::uint64_t kind, int side, std::uint64_t index = 0) const;
  Random dayStream(std::uint64_t kind, int side, std::uint64_t index = 0) const;
  double pavementWidth(int side, double s) const;
  bool nearCrossing(int side, double s, double gap) const;
  Site site(int side, double s, double lateral) const;
  /// \brief True if nothing stands within `gap` and the ground is suitable; the place is then
  /// taken.
  bool claim(const Site& place, double gap, Ground ground);
  bool goneToday(std::uint32_t id) const;
  /// \brief The day on which a permanent pole is removed for good; infinity if never.
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
  std::vector<Planned> m_planned;  ///< permanent poles, including those removed by now
  const std::uint32_t m_street0;   ///< first id of this street
  const bool m_open;               ///< no houses at the ends
  std::uint32_t m_nextId;
  bool m_permanent = true;  ///< objects added now are permanent since day 0
  std::unordered_map<std::int64_t, std::vector<Eigen::Vector3d>> m_taken;  ///< x, y, gap
};

}  // namespace polemcl::sim
