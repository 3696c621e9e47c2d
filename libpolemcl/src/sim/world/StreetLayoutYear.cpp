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

}  // namespace polemcl::sim
