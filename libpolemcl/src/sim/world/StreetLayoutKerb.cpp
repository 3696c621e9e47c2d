#include <algorithm>
#include <cmath>

#include "sim/world/StreetLayout.h"

namespace polemcl::sim {

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
