#include "sim/world/StreetLayout.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "sim/world/Season.h"

namespace polemcl::sim {

namespace {
/// \brief Adds the mouths of a side street as crossings, and removes other roads near or between
/// them.
void makeMouths(const Detour& detour, double halfWidth, std::vector<Crossing>& crossings) {
  constexpr double kApart = 40;  // m
  for (Crossing& crossing : crossings)
    if (crossing.s > detour.leave - kApart && crossing.s < detour.back + kApart)
      (detour.side > 0 ? crossing.left : crossing.right) = false;
  const auto isNone = [](const Crossing& c) { return !c.left && !c.right; };
  crossings.erase(std::remove_if(crossings.begin(), crossings.end(), isNone), crossings.end());
  for (const double s : {detour.leave, detour.back})
    crossings.push_back({s, detour.side > 0, detour.side < 0, halfWidth, false});
}
}  // namespace

std::vector<Crossing> planCrossings(const WorldOptions& options, const Street& street,
                                    const std::vector<Detour>& detours) {
  Random random(hash(options.seed, 0xc055ull));
  std::vector<Crossing> crossings;
  for (double s = random.uniform(30, 90); s < street.length() - 15; s += random.uniform(75, 170)) {
    const double kind = random.uniform();
    const bool left = kind<0.7, right = kind> 0.35;
    const Crossing crossing{s, left, right, random.uniform(2.8, 4.2)};
    if (street.fresh(s)) crossings.push_back(crossing);
  }
  for (const Detour& detour : detours) makeMouths(detour, options.roadWidth / 2, crossings);
  return crossings;
}

std::vector<SideRoad> sideRoads(const std::vector<Crossing>& crossings, const Street& street,
                                const WorldOptions& options) {
  Random random(hash(options.seed, 0x51deull));
  std::vector<SideRoad> roads;
  for (const Crossing& crossing : crossings)
    for (const int side : {1, -1}) {
      const double skew = random.normal(0, 0.12);
      if (!crossing.straight || !(side > 0 ? crossing.left : crossing.right)) continue;
      const Pose2D start = street.at(crossing.s);
      const double heading = start.yaw + side * M_PI / 2 + skew;
      const Eigen::Vector2d a(start.x, start.y);
      roads.push_back(
          {a, a + 70 * Eigen::Vector2d(std::cos(heading), std::sin(heading)), crossing.halfWidth});
    }
  return roads;
}

StreetLayout::StreetLayout(const WorldOptions& options, const Street& street,
                           const Terrain& terrain, const std::vector<Crossing>& crossings,
                           std::uint32_t index)
    : m_options(options),
      m_street(street),
      m_terrain(terrain),
      m_crossings(crossings),
      m_street0(index * kIdsPerStreet),
      m_open(index > 0),
      m_nextId(m_street0 + 1) {}

void StreetLayout::furnish() {
  crossingFurniture();
  for (const int side : {1, -1}) {
    lamps(side);
    avenue(side);
    signs(side);
    smallThings(side);
    lots(side);
  }
  const std::size_t permanent = m_nextId - m_street0;
  m_permanent = false;
  replacedPoles();
  planSites();
  m_nextId = m_street0 + kFirstIdOfOneDay;
  addedPoles(permanent);
  vehiclesInYards();
  for (const int side : {1, -1}) {
    parkedVehicles(side);
    people(side);
  }
  clearSites();
  if (m_options.dayOfYear > 0)
    snowBanks(m_options.snowBank * seasonOf(m_options.dayOfYear + m_options.day).snow);
  removeBuiltOver(objects, poles);
  std::sort(poles.begin(), poles.end(),
            [](const TruePole& a, const TruePole& b) { return a.id < b.id; });
}

Random StreetLayout::stream(std::uint64_t kind, int side, std::uint64_t index) const {
  return Random(hash(m_options.seed, kind, side + 2, index));
}

Random StreetLayout::dayStream(std::uint64_t kind, int side, std::uint64_t index) const {
  return Random(hash(m_options.seed, kind, side + 2, index, 0xda11ull, m_options.day));
}

double StreetLayout::pavementWidth(int side, double s) const {
  return stream(0x9a5e, side, static_cast<std::uint64_t>(s / 150)).uniform(2.2, 4.2);
}

bool StreetLayout::nearCrossing(int side, double s, double gap) const {
  for (const Crossing& crossing : m_crossings)
    if ((side > 0 ? crossing.left : crossing.right) &&
        std::abs(crossing.s - s) < crossing.halfWidth + gap)
      return true;
  return false;
}

Site StreetLayout::site(int side, double s, double lateral) const {
  const Pose2D pose = m_street.at(s, side * lateral);
  return {Eigen::Vector3d(pose.x, pose.y, m_terrain.height(pose.x, pose.y)),
          pose.yaw + (side > 0 ? 0 : M_PI)};
}

bool StreetLayout::claim(const Site& place, double gap, Ground ground) {
  const double x = place.base.x(), y = place.base.y(), edge = m_terrain.edge(x, y);
  if (ground == Ground::road ? edge < -2.6 || edge > -0.6 : edge < 0.25) return false;
  constexpr double kSpacing = 4;
  const auto cellX = static_cast<std::int64_t>(std::floor(x / kSpacing));
  const auto cellY = static_cast<std::int64_t>(std::floor(y / kSpacing));
  for (std::int64_t i = cellX - 1; i <= cellX + 1; ++i)
    for (std::int64_t j = cellY - 1; j <= cellY + 1; ++j) {
      const auto cell = m_taken.find(i * 0x100000000ll + j);
      if (cell == m_taken.end()) continue;
      for (const auto& other : cell->second)
        if (std::hypot(other.x() - x, other.y() - y) < std::max(gap, other.z())) return false;
    }
  m_taken[cellX * 0x100000000ll + cellY].emplace_back(x, y, gap);
  return true;
}

bool StreetLayout::goneToday(std::uint32_t id) const {
  return m_options.day != 0 &&
         Random(hash(m_options.seed, 0x60ull, m_options.day, id)).chance(m_options.removedShare);
}

void removeBuiltOver(std::vector<WorldObject>& objects, std::vector<TruePole>& poles) {
  std::unordered_set<std::uint32_t> hidden;
  for (const WorldObject& object : objects) {
    if (object.kind != Kind::house && object.kind != Kind::wall && object.kind != Kind::container)
      continue;
    for (const Solid& solid : object.solids) {
      if (solid.shape != Shape::box) continue;
      for (const TruePole& pole : poles) {
        const Eigen::Vector3d place(pole.x, pole.y, solid.position.z());
        const Eigen::Vector3d local = solid.axes.transpose() * (place - solid.position);
        const double margin = pole.radius;
        if (std::abs(local.x()) < solid.size.x() + margin &&
            std::abs(local.y()) < solid.size.y() + margin)
          hidden.insert(pole.id);
      }
    }
  }
  const auto isHidden = [&](const auto& thing) { return hidden.count(thing.id) > 0; };
  objects.erase(std::remove_if(objects.begin(), objects.end(), isHidden), objects.end());
  poles.erase(std::remove_if(poles.begin(), poles.end(), isHidden), poles.end());
}

void StreetLayout::add(Piece piece, const Site& place) {
  const std::uint32_t id = piece.object.id;
  if (m_permanent && piece.pole) m_planned.push_back({id, piece.object.kind, place});
  if (goneToday(id) || (m_permanent && lastDayOf(id) <= m_options.day)) return;
  const auto keep = [this](Piece each) {
    objects.push_back(std::move(each.object));
    if (each.pole && each.pole->top >= 2) poles.push_back(*each.pole);
  };
  if (m_options.realism.scale <= 0) return keep(std::move(piece));
  const Random own(hash(m_options.seed, 0xdef1ull, id));
  for (Piece& each : deviating(std::move(piece), place, m_options.realism, own))
    keep(std::move(each));
}

}  // namespace polemcl::sim
