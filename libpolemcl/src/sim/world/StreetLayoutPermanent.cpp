#include <algorithm>
#include <cmath>

#include "sim/world/StreetLayout.h"

namespace polemcl::sim {
namespace {
/// \brief Density of leaves on one day: slightly above or below the season's mean.
double leavesOf(const WorldOptions& options) {
  return options.foliage * Random(hash(options.seed, 0x1eafull, options.day)).uniform(0.85, 1.15);
}
}  // namespace

void StreetLayout::lots(int side) {
  Random random = stream(0x107, side);
  for (double s = 0; s < m_street.length();) s += lot(side, s, random);
  if (m_open) return;
  // Houses at both ends of the street: the town continues there.
  for (const double s : {-12.0, m_street.length() + 12.0}) {
    const Pose2D end = m_street.at(s);
    const double along = s < 0 ? s : s - m_street.length();
    const double lateral = side * (m_options.roadWidth / 2 + pavementWidth(side, s));
    const double x = end.x + along * std::cos(end.yaw) - lateral * std::sin(end.yaw);
    const double y = end.y + along * std::sin(end.yaw) + lateral * std::cos(end.yaw);
    const Site place{{x, y, m_terrain.height(x, y)}, end.yaw + (side > 0 ? 0 : M_PI)};
    const std::uint32_t id = m_nextId++;
    if (m_terrain.edge(x, y) > 1) add(makeHouse(place, id, 20, 9, random));
  }
}

/// \return Length used, m.
double StreetLayout::lot(int side, double s, Random& random) {
  const double length = random.uniform(9, 26), kind = random.uniform(),
               depth = random.uniform(3.5, 8);
  const double middle = s + length / 2;
  Random own(random.next());  // keeps other lots unchanged if this one is left out
  if (middle > m_street.length() || !m_street.fresh(middle)) return length;
  if (nearCrossing(side, middle, length / 2 + 1.0)) return 3;
  if (kind < 0.34) {
    house(side, middle, length - own.uniform(0, 0.4), 0, own);
  } else if (kind < 0.62) {
    garden(side, middle, length, depth, own);
    house(side, middle, length - own.uniform(0.5, 5), depth, own);
  } else if (kind < 0.74) {
    yard(side, middle, length, own);
  } else if (kind < 0.91) {
    park(side, middle, length, own);
  } else {
    const double border = m_options.roadWidth / 2 + pavementWidth(side, middle) + 0.3;
    add(makeWall(site(side, middle, border), m_nextId++, length, own));
    garden(side, middle, length - 2, 8, own);
  }
  return length;
}

void StreetLayout::house(int side, double s, double length, double setBack, Random& random) {
  const double front = m_options.roadWidth / 2 + pavementWidth(side, s) + setBack;
  const double depth = random.uniform(8, 12);
  const std::uint32_t id = m_nextId++;
  const Site place = site(side, s, front);
  const double c = std::cos(place.heading), n = std::sin(place.heading);
  // Never on a road, including another part of this street. Side streets may also be close behind.
  const int steps = m_options.sideStreets > 0 ? 8 : 2;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j <= steps; ++j) {
      const double x = (i / static_cast<double>(steps) - 0.5) * length,
                   y = j / static_cast<double>(steps) * depth;
      if (m_terrain.edge(place.base.x() + c * x - n * y, place.base.y() + n * x + c * y) < 1.0)
        return;
    }
  add(makeHouse(place, id, length, depth, random));
}

void StreetLayout::garden(int side, double s, double length, double depth, Random& random) {
  const double border = m_options.roadWidth / 2 + pavementWidth(side, s) + 0.1;
  const double kind = random.uniform();
  const Site edge = site(side, s, border);
  const std::uint32_t id = m_nextId++;
  if (claim(edge, 0.1, Ground::pavement)) {
    if (kind < 0.4)
      add(makeFence(edge, id, length, random));
    else if (kind < 0.7)
      add(makeHedge(edge, id, length, leavesOf(m_options), random));
    else if (kind < 0.85)
      add(makeWall(edge, id, length, random));
  }
  const int plants = 1 + random.below(5);
  for (int i = 0; i < plants; ++i) {
    const double along = s + random.uniform(-0.45, 0.45) * length;
    const Site place = site(side, along, border + random.uniform(1, std::max(1.2, depth - 1.5)));
    const std::uint32_t plant = m_nextId++;
    Random own(random.next());
    const bool tree = own.chance(0.3);
    if (!claim(place, tree ? 1.5 : 0.9, Ground::lot)) continue;
    if (tree)
      add(makeTree(place, plant, TreeStyle(own), leavesOf(m_options), own), place);
    else
      add(makeBush(place, plant, leavesOf(m_options), own));
  }
}

void StreetLayout::yard(int side, double s, double length, Random& random) {
  const double border = m_options.roadWidth / 2 + pavementWidth(side, s);
  const double depth = random.uniform(9, 18);
  m_yards.push_back({side, s, length, border});
  house(side, s, length - random.uniform(0, 3), depth, random);
  for (int i = 0, plants = random.below(4); i < plants; ++i) {
    const double along = s + random.uniform(-0.5, 0.5) * length;
    const Site place = site(side, along, border + depth - random.uniform(1.2, 2.5));
    const std::uint32_t id = m_nextId++;
    Random own(random.next());
    if (!claim(place, 1.0, Ground::lot)) continue;
    if (own.chance(0.4))
      add(makeTree(place, id, TreeStyle(own), leavesOf(m_options), own), place);
    else
      add(makeBush(place, id, leavesOf(m_options), own));
  }
}

void StreetLayout::park(int side, double s, double length, Random& random) {
  const double border = m_options.roadWidth / 2 + pavementWidth(side, s) + 0.4;
  const TreeStyle style(random);
  const int plants = static_cast<int>(length * random.uniform(0.25, 0.5));
  for (int i = 0; i < plants; ++i) {
    const double along = s + random.uniform(-0.5, 0.5) * length;
    const Site place = site(side, along, border + random.uniform(0.3, 13));
    const std::uint32_t id = m_nextId++;
    Random own(random.next());
    const bool tree = own.chance(0.5);
    if (!claim(place, tree ? 2.2 : 1.0, Ground::lot)) continue;
    if (tree)
      add(makeTree(place, id, own.chance(0.7) ? style : TreeStyle(own), leavesOf(m_options), own),
          place);
    else
      add(makeBush(place, id, leavesOf(m_options), own));
  }
  if (random.chance(0.6)) house(side, s, length - 1, random.uniform(15, 20), random);
  const std::uint32_t id = m_nextId++;
  const Site edge = site(side, s, border - 0.2);
  if (random.chance(0.3) && claim(edge, 0.1, Ground::pavement))
    add(makeFence(edge, id, length, random));
}

void StreetLayout::crossingFurniture() {
  for (std::size_t i = 0; i < m_crossings.size(); ++i) {
    const Crossing& crossing = m_crossings[i];
    Random random = stream(0x7af, 0, i);
    const bool lights = random.chance(0.4);
    for (const int side : {1, -1})
      for (const double end : {-1.0, 1.0}) {
        const std::uint32_t id = m_nextId++;
        Random own(random.next());
        const double s = crossing.s + end * (crossing.halfWidth + own.uniform(0.9, 2.5));
        const Site place = site(side, s, m_options.roadWidth / 2 + own.uniform(0.4, 1.0));
        if (!own.chance(lights ? 0.85 : 0.5) || !claim(place, 0.8, Ground::pavement)) continue;
        add(lights ? makeTrafficLight(place, id, own) : makeSign(place, id, own), place);
      }
  }
}

void StreetLayout::lamps(int side) {
  Random random = stream(0x1a4b, side);
  for (double s = random.uniform(3, m_options.lampSpacing); s < m_street.length();
       s += m_options.lampSpacing * random.uniform(0.8, 1.2)) {
    // One type of lamp for about 250 m of street, on both sides.
    Random make = stream(0x5791e, 0, static_cast<std::uint64_t>(s / 250));
    const LampStyle style(make);
    const std::uint32_t id = m_nextId++;
    Random own(random.next());
    // Some streets have their lamps at the house fronts.
    const double out =
        make.chance(0.2) ? pavementWidth(side, s) - own.uniform(0.35, 0.6) : own.uniform(0.4, 0.7);
    const Site place = site(side, s, m_options.roadWidth / 2 + out);
    if (m_street.fresh(s) && claim(place, 0.7, Ground::pavement))
      add(makeLampPost(place, id, style, own), place);
  }
}

void StreetLayout::avenue(int side) {
  constexpr double kBlock = 70;  // length planted as one unit, or not planted, m
  const double leaves = m_options.foliage * dayStream(0x1eaf, 0).uniform(0.85, 1.15);
  for (double start = 0; start < m_street.length(); start += kBlock) {
    Random random = stream(0xa7e, side, static_cast<std::uint64_t>(start / kBlock));
    if (!random.chance(m_options.treeShare)) continue;
    const TreeStyle style(random);
    const double spacing = m_options.treeSpacing * random.uniform(0.7, 1.3);
    const double aside = random.uniform(0.6, 1.2);
    for (double s = start + random.uniform(0, 3); s < std::min(start + kBlock, m_street.length());
         s += spacing * random.uniform(0.85, 1.15)) {
      const std::uint32_t id = m_nextId++;
      Random own(random.next());
      const Site place = site(side, s, m_options.roadWidth / 2 + aside + own.normal(0, 0.06));
      if (m_street.fresh(s) && !nearCrossing(side, s, 2) && claim(place, 1.2, Ground::pavement))
        add(makeTree(place, id, style, leaves, own), place);
    }
  }
}

void StreetLayout::signs(int side) {
  Random random = stream(0x519, side);
  for (double s = random.uniform(2, m_options.signSpacing); s < m_street.length();
       s += m_options.signSpacing * random.uniform(0.4, 1.6)) {
    const std::uint32_t id = m_nextId++;
    Random own(random.next());
    const bool rear = own.chance(0.2);  // near the houses
    const double out =
        rear ? pavementWidth(side, s) - own.uniform(0.3, 0.6) : own.uniform(0.35, 0.8);
    const Site place = site(side, s, m_options.roadWidth / 2 + out);
    if (m_street.fresh(s) && claim(place, 0.5, Ground::pavement))
      add(makeSign(place, id, own), place);
  }
}

void StreetLayout::smallThings(int side) {
  if (m_options.clutter <= 0) return;
  Random random = stream(0x5ba11, side);
  for (double s = random.uniform(0, 10); s < m_street.length();
       s += random.uniform(5, 22) / m_options.clutter) {
    Random own(random.next());
    const double kind = own.uniform(), width = pavementWidth(side, s);
    const bool rear = own.chance(0.5);
    const double out = rear ? width - own.uniform(0.3, 0.6) : own.uniform(0.4, 0.9);
    const int row = kind < 0.4 ? 1 + own.below(6) : 1;
    for (int i = 0; i < row; ++i) {
      const std::uint32_t id = m_nextId++;
      const double along = s + 1.5 * i;
      const Site place = site(side, along, m_options.roadWidth / 2 + out);
      if (!m_street.fresh(along) || !claim(place, kind < 0.4 ? 0.5 : 0.8, Ground::pavement))
        continue;
      if (kind < 0.4)
        add(makeBollard(place, id, own));
      else if (kind < 0.55)
        add(makeCabinet(place, id, own));
      else if (kind < 0.63)
        add(makeBillboard(place, id, own));
      else if (kind < 0.67)
        add(makeAdvertColumn(place, id, own));
      else
        add(makeBush(place, id, m_options.foliage, own));
    }
  }
}

}  // namespace polemcl::sim
