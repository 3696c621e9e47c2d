#include <cmath>

#include "sim/world/StreetLayout.h"

namespace polemcl::sim {

void StreetLayout::addedPoles(std::size_t permanentPoles) {
  if (m_options.day == 0) return;
  for (std::size_t i = 0; i < permanentPoles; ++i) {
    Random random = dayStream(0xadd, 0, i);
    // Permanent ids include other objects; about a third of them are poles.
    if (!random.chance(m_options.addedShare / 3)) continue;
    const std::uint32_t id = m_nextId++;
    const int side = random.chance(0.5) ? 1 : -1;
    const double s = random.uniform(0, m_street.length());
    const Site place = site(side, s, m_options.roadWidth / 2 + random.uniform(0.4, 0.9));
    if (!m_street.fresh(s) || !claim(place, 0.7, Ground::pavement)) continue;
    if (random.chance(0.7))
      add(makeSign(place, id, random), place);
    else
      add(makeLampPost(place, id, LampStyle(random), random), place);
  }
}

void StreetLayout::parkedVehicles(int side) {
  constexpr double kBlock = 45;  // length with or without parking, m
  Random random = dayStream(0xca5, side);
  for (double s = random.uniform(2, 5); s < m_street.length(); s += random.uniform(5.4, 7)) {
    const std::uint32_t id = m_nextId++;
    Random own(random.next());
    Random block = stream(0xb10c, side, static_cast<std::uint64_t>(s / kBlock));
    if (!block.chance(0.65) || !own.chance(m_options.parkedShare)) continue;
    if (!m_street.fresh(s) || nearCrossing(1, s, 6) || nearCrossing(-1, s, 6)) continue;
    Site place = site(side, s, m_options.roadWidth / 2 - 1.05 + own.normal(0, 0.08));
    if (!claim(place, 2.2, Ground::road)) continue;
    const double turned = own.chance(0.9) ? M_PI : 0.0;
    place.heading += turned + own.normal(0, 0.02);
    add(makeVehicle(place, id, own));
  }
}

void StreetLayout::vehiclesInYards() {
  for (std::size_t i = 0; i < m_yards.size(); ++i) {
    const Yard& yard = m_yards[i];
    Random random = dayStream(0xca6, yard.side, i);
    for (double along = -yard.length / 2 + 1.5; along < yard.length / 2 - 1; along += 2.7) {
      const std::uint32_t id = m_nextId++;
      Random own(random.next());
      Site place = site(yard.side, yard.s + along, yard.border + own.uniform(2.9, 3.5));
      if (!own.chance(0.6 * m_options.parkedShare) || !claim(place, 1.4, Ground::lot)) continue;
      const double turned = own.chance(0.5) ? M_PI / 2 : -M_PI / 2;
      place.heading += turned + own.normal(0, 0.03);
      add(makeVehicle(place, id, own));
    }
  }
}

void StreetLayout::people(int side) {
  if (m_options.clutter <= 0) return;
  Random random = dayStream(0x9e0, side);
  for (double s = random.uniform(0, 20); s < m_street.length();
       s += random.uniform(3, 45) / m_options.clutter) {
    const std::uint32_t id = m_nextId++;
    Random own(random.next());
    const double out = own.uniform(0.4, pavementWidth(side, s) - 0.3), kind = own.uniform();
    const Site place = site(side, s, m_options.roadWidth / 2 + out);
    if (!m_street.fresh(s) || !claim(place, 0.5, Ground::pavement)) continue;
    if (kind < 0.7) {
      add(makePerson(place, id, own));
    } else if (kind < 0.85) {
      add(makeBin(place, id, own));
    } else {
      add(makeBicycle(place, id, own));
    }
  }
}

}  // namespace polemcl::sim
