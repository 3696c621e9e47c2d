#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/world/StreetLayout.h"

namespace polemcl::sim {
namespace {

constexpr std::uint32_t kFirstReplaced = 500000;  // ids of later poles, within a street

/// \brief Days until a random event that affects `share` of all objects within 365 days, at a
/// constant rate.
double waiting(double share, std::uint64_t seed) {
  return std::log1p(-Random(seed).uniform()) / std::log1p(-share) * 365;
}

/// \brief A new object of a kind; trees are young.
Piece makeAgain(Kind kind, const Site& place, std::uint32_t id, double foliage, Random& random) {
  switch (kind) {
    case Kind::tree: {
      TreeStyle style(random);
      style.trunkRadius = random.uniform(0.06, 0.1);
      style.height = style.crownBase + random.uniform(2, 3.5);
      style.crownRadius = random.uniform(0.8, 1.4);
      return makeTree(place, id, style, foliage, random);
    }
    case Kind::trafficLight:
      return makeTrafficLight(place, id, random);
    case Kind::sign:
      return makeSign(place, id, random);
    default:
      return makeLampPost(place, id, LampStyle(random), random);
  }
}

}  // namespace

double StreetLayout::lastDayOf(std::uint32_t id) const {
  if (m_options.replacedPerYear <= 0) return std::numeric_limits<double>::infinity();
  return waiting(m_options.replacedPerYear, hash(m_options.seed, 0x1a57ull, id));
}

void StreetLayout::replacedPoles() {
  if (m_options.replacedPerYear <= 0) return;
  // A removed pole is either replaced beside it at once, or another one appears elsewhere at
  // another time. Earlier arrivals choose their place first, so that later days do not move a pole.
  struct Arrival {
    double day;
    const Planned* old;  ///< the pole that it replaces
    bool beside;
  };
  std::vector<Arrival> arrivals;
  for (const Planned& old : m_planned) {
    const bool beside = Random(hash(m_options.seed, 0xbe51deull, old.id)).chance(0.5);
    const std::uint64_t seed = hash(m_options.seed, 0xa4417eull, old.id);
    const double day = beside ? lastDayOf(old.id) : waiting(m_options.replacedPerYear, seed);
    if (day <= m_options.day) arrivals.push_back({day, &old, beside});
  }
  std::sort(arrivals.begin(), arrivals.end(), [](const Arrival& a, const Arrival& b) {
    return std::make_pair(a.day, a.old->id) < std::make_pair(b.day, b.old->id);
  });
  for (const Arrival& arrival : arrivals) settle(*arrival.old, arrival.beside);
}

void StreetLayout::settle(const Planned& old, bool beside) {
  const std::uint32_t id = old.id + kFirstReplaced;
  Random random(hash(m_options.seed, 0x4e3ull, id));
  const Kind kind = beside ? old.kind : random.chance(0.7) ? Kind::sign : Kind::lampPost;
  for (int attempt = 0; attempt < 12; ++attempt) {
    Site place = old.place;
    if (beside && attempt < 8) {
      const int way = random.chance(0.5) ? 1 : -1;
      const double along = way * random.uniform(1.5, 5);
      place.base.x() += along * std::cos(place.heading);
      place.base.y() += along * std::sin(place.heading);
      place.base.z() = m_terrain.height(place.base.x(), place.base.y());
    } else {
      const int side = random.chance(0.5) ? 1 : -1;
      const double s = random.uniform(0, m_street.length());
      place = site(side, s, m_options.roadWidth / 2 + random.uniform(0.4, 0.9));
    }
    if (!claim(place, 0.7, Ground::pavement)) continue;
    add(makeAgain(kind, place, id, m_options.foliage, random), place);
    return;
  }
}

void StreetLayout::snowBanks(double height) {
  if (height < 0.02) return;
  constexpr double kBank = 4.5;  // m
  for (const int side : {1, -1}) {
    for (double s = kBank / 2; s < m_street.length(); s += kBank) {
      const std::uint32_t id = m_nextId++;
      Random random = stream(0x540b, side, static_cast<std::uint64_t>(s));
      // A gap was shovelled.
      if (random.chance(0.08) || !m_street.fresh(s) || nearCrossing(side, s, 1)) continue;
      const Site place = site(side, s, m_options.roadWidth / 2 + kSnowBankMiddle);
      const double x = place.base.x(), y = place.base.y();
      if (m_terrain.edge(x, y) < 0.25 || siteAt(x, y, 0) != nullptr) continue;
      add(makeSnowBank(place, id, kBank, height, random));
    }
  }
}

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
