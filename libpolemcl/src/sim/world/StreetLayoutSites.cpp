#include <algorithm>
#include <cmath>
#include <set>

#include "sim/world/StreetLayout.h"

namespace polemcl::sim {
namespace {

constexpr double kPiece = 120;  // piece of a side of the street, m: one site at a time
constexpr double kShortest = 30, kLongest = 90;                    // duration of a site in days
constexpr std::uint32_t kFirstOfSites = 600000, kIdsPerSite = 64;  // ids within a street

/// \brief Kinds of objects that have to leave a building site.
bool makesRoom(Kind kind) {
  static const std::set<Kind> kinds{Kind::bush,    Kind::car,     Kind::person,
                                    Kind::bicycle, Kind::bollard, Kind::billboard,
                                    Kind::bin,     Kind::cabinet, Kind::column};
  return kinds.count(kind) > 0;
}

}  // namespace

void StreetLayout::planSites() {
  if (m_options.buildingSites <= 0) return;
  // On each piece, sites follow one another: an idle time, then a site of one to three months. The
  // sequence starts long before day 0, so that day 0 is like any other day.
  const double busy = std::min(0.9, m_options.buildingSites * kPiece / 2 / 1000);
  const double mean = 0.5 * (kShortest + kLongest), idle = mean * (1 / busy - 1);
  for (const int side : {1, -1})
    for (std::size_t piece = 0; kPiece * static_cast<double>(piece) < m_street.length(); ++piece) {
      Random random = stream(0xb5173, side, piece);
      for (double day = -1000; day <= m_options.day;) {
        day += -idle * std::log1p(-random.uniform());
        const double length = random.uniform(20, 60), first = day;
        const std::uint64_t seed = random.next();
        day += random.uniform(kShortest, kLongest);
        if (first > m_options.day || day <= m_options.day) continue;
        BuildingSite site;
        site.seed = seed;
        site.firstDay = first;
        site.endDay = day;
        site.side = side;
        findSite(site, kPiece * static_cast<double>(piece), length);
      }
    }
}

void StreetLayout::findSite(BuildingSite site, double start, double length) {
  Random random(hash(site.seed, 0xf14dull));
  site.boards = random.chance(0.5);
  for (int attempt = 0; attempt < 20; ++attempt, length = std::max(15.0, 0.9 * length)) {
    site.from = start + random.uniform(2, kPiece - length - 2);
    site.to = site.from + length;
    const double middle = 0.5 * (site.from + site.to);
    if (site.to > m_street.length() - 2 || nearCrossing(site.side, middle, length / 2 + 3))
      continue;
    if (!m_street.fresh(site.from) || !m_street.fresh(site.to)) continue;
    const double out = m_options.roadWidth / 2 + kSiteFence;
    for (double s = site.from; s < site.to + 0.5; s += 1) {
      const Pose2D place = m_street.at(std::min(s, site.to), site.side * out);
      site.kerb.emplace_back(place.x, place.y);
    }
    sites.push_back(site);
    buildSite(site);
    return;
  }
}

void StreetLayout::fenceOff(const BuildingSite& site, double depth, std::uint32_t& id,
                            Random& random) {
  const double out = m_options.roadWidth / 2 + kSiteFence;
  const auto fence = [&](const Site& place, double length) {
    add(site.boards ? makeHoarding(place, id++, length, random)
                    : makeSiteFence(place, id++, length, random));
  };
  const int parts = std::max(1, static_cast<int>(std::round((site.to - site.from) / 7)));
  const double length = (site.to - site.from) / parts;
  for (int i = 0; i < parts; ++i)
    fence(this->site(site.side, site.from + (i + 0.5) * length, out), length);
  for (const double end : {site.from, site.to}) {
    Site across = this->site(site.side, end, out + depth / 2);
    across.heading += M_PI / 2;
    fence(across, depth);
  }
}

void StreetLayout::buildSite(const BuildingSite& building) {
  Random random(hash(building.seed, 0xb01dull));
  std::uint32_t id = m_street0 + kFirstOfSites +
                     kIdsPerSite * static_cast<std::uint32_t>(hash(building.seed) % 6000);
  const double depth = pavementWidth(building.side, building.from) - kSiteFence;
  fenceOff(building, depth, id, random);
  const double half = m_options.roadWidth / 2;
  for (int k = random.below(3); k > 0; --k) {
    const double s = random.uniform(building.from + 4, building.to - 4);
    add(makeContainer(site(building.side, s, half + kSiteFence + 1.5), id++));
  }
  for (double s = building.from - 1; s <= building.to + 1; s += random.uniform(6, 9))
    add(makeBeacon(site(building.side, s, half - 0.45), id++, random));
  for (const double s :
       {building.from - random.uniform(1, 4), building.to + random.uniform(1, 4)}) {
    const Site place = site(building.side, s, half + random.uniform(0.3, 0.5));
    if (claim(place, 0.5, Ground::pavement)) add(makeSign(place, id, random), place);
    ++id;
  }
}

const BuildingSite* StreetLayout::siteAt(double x, double y, double beyond) const {
  for (const BuildingSite& site : sites) {
    std::size_t nearest = 0;
    const Eigen::Vector2d place(x, y);
    for (std::size_t i = 1; i < site.kerb.size(); ++i)
      if ((site.kerb[i] - place).squaredNorm() < (site.kerb[nearest] - place).squaredNorm())
        nearest = i;
    const double s = std::min(site.from + static_cast<double>(nearest), site.to);
    const Pose2D pose = m_street.at(s);
    const double dx = x - pose.x, dy = y - pose.y, c = std::cos(pose.yaw), n = std::sin(pose.yaw);
    const double along = s + c * dx + n * dy;
    const double lateral = site.side * (c * dy - n * dx) - m_options.roadWidth / 2;
    if (along >= site.from && along <= site.to && lateral >= beyond &&
        lateral <= pavementWidth(site.side, site.from))
      return &site;
  }
  return nullptr;
}

void StreetLayout::clearSites() {
  if (sites.empty()) return;
  std::set<std::uint32_t> gone;
  for (const TruePole& pole : poles) {
    const BuildingSite* site = siteAt(pole.x, pole.y, kSiteFence);
    // Most poles are removed until the end of the work; some remain behind the fence.
    if (site != nullptr && Random(hash(site->seed, pole.id)).chance(0.6)) gone.insert(pole.id);
  }
  const auto mustGo = [&](const WorldObject& object) {
    return gone.count(object.id) > 0 ||
           (makesRoom(object.kind) &&
            siteAt(object.centre.x(), object.centre.y(), -2.4) != nullptr);
  };
  objects.erase(std::remove_if(objects.begin(), objects.end(), mustGo), objects.end());
  poles.erase(std::remove_if(poles.begin(), poles.end(),
                             [&](const TruePole& pole) { return gone.count(pole.id) > 0; }),
              poles.end());
}

}  // namespace polemcl::sim
