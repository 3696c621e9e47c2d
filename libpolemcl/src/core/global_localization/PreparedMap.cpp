#include "core/global_localization/PreparedMap.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "core/common/KdTree2D.h"
#include "core/common/Transform.h"

namespace polemcl {
namespace {

/// Probability that a radius was measured too wrong to be compared.
constexpr double kRadiusUnsure = 0.2;

/// Poles in reach of which all are looked at: one on each 2.5 m² for a reach of 40 m.
constexpr std::size_t kMostInReach = 2048;
/// Where there are more, cells of this share of the reach have one pole each: less than 1000.
constexpr double kCellShare = 1.0 / 16;

/// Poles round a pole, in a time that does not grow with their density.
class PolesInReach {
 public:
  PolesInReach(const std::vector<Eigen::Vector2d>& poles, double reach)
      : m_reach(reach), m_all(poles) {}

  /// By ascending index; `hits` is replaced.
  void find(std::uint32_t pole, std::vector<PointHit>& hits) {
    const Eigen::Vector2d& place = m_all.point(pole);
    if (m_all.withinUnlessMore(place.x(), place.y(), m_reach, kMostInReach, hits)) return;
    if (!m_few) thinOut();
    m_few->within(place.x(), place.y(), m_reach, hits);
    for (PointHit& hit : hits) hit.index = m_names[hit.index];
  }

 private:
  /// Leaves the first pole of each cell.
  void thinOut() {
    std::map<std::pair<double, double>, std::uint32_t> first;
    for (std::uint32_t i = 0; i < m_all.size(); ++i) {
      const Eigen::Vector2d cell = m_all.point(i) / (kCellShare * m_reach);
      first.try_emplace({std::floor(cell.x()), std::floor(cell.y())}, i);
    }
    for (const auto& [cell, pole] : first) m_names.push_back(pole);
    std::sort(m_names.begin(), m_names.end());
    std::vector<Eigen::Vector2d> places;
    places.reserve(m_names.size());
    for (const std::uint32_t pole : m_names) places.push_back(m_all.point(pole));
    m_few.emplace(std::move(places));
  }

  double m_reach;
  KdTree2D m_all;
  std::optional<KdTree2D> m_few;       ///< only where it is needed
  std::vector<std::uint32_t> m_names;  ///< of its points among all
};

bool before(const PairDistanceIndex::Pair& a, const PairDistanceIndex::Pair& b) {
  return std::tie(a.distance, a.first, a.second) < std::tie(b.distance, b.first, b.second);
}

bool same(const PairDistanceIndex::Pair& a, const PairDistanceIndex::Pair& b) {
  return a.first == b.first && a.second == b.second;
}

}  // namespace

PairDistanceIndex::PairDistanceIndex(const std::vector<Eigen::Vector2d>& poles, double minDistance,
                                     double maxDistance, std::size_t neighbours) {
  PolesInReach inReach(poles, maxDistance);
  std::vector<PointHit> hits;
  for (std::uint32_t i = 0; i < poles.size(); ++i) {
    inReach.find(i, hits);
    hits.erase(std::remove_if(hits.begin(), hits.end(),
                              [&](const PointHit& hit) {
                                return hit.squaredDistance < minDistance * minDistance;
                              }),
               hits.end());
    if (hits.size() > neighbours) {
      std::stable_sort(hits.begin(), hits.end(), [](const PointHit& a, const PointHit& b) {
        return a.squaredDistance < b.squaredDistance;
      });
    }
    const std::size_t count = std::min(hits.size(), neighbours);
    for (std::size_t k = 0; k < count; ++k) {
      const PointHit& hit = hits[k * hits.size() / count];
      m_pairs.push_back({static_cast<float>(std::sqrt(hit.squaredDistance)), std::min(i, hit.index),
                         std::max(i, hit.index)});
    }
  }
  std::sort(m_pairs.begin(), m_pairs.end(), before);
  m_pairs.erase(std::unique(m_pairs.begin(), m_pairs.end(), same), m_pairs.end());
  m_pairs.shrink_to_fit();
}

PairDistanceIndex::Range PairDistanceIndex::between(double low, double high) const& {
  const auto below = [](const Pair& pair, double bound) { return pair.distance < bound; };
  const auto above = [](double bound, const Pair& pair) { return bound < pair.distance; };
  const auto begin = std::lower_bound(m_pairs.begin(), m_pairs.end(), low, below);
  const auto end = std::upper_bound(begin, m_pairs.end(), std::max(low, high), above);
  return {m_pairs.data() + (begin - m_pairs.begin()), m_pairs.data() + (end - m_pairs.begin())};
}

PreparedMap::PreparedMap(const std::vector<MapPole>& map, const GlobalOptions& globalOptions)
    : options(globalOptions),
      index(map, options.maxTolerance),
      pairs(centresOf(map), options.minBaseline, options.maxBaseline) {
  for (std::size_t i = 0; i < map.size(); ++i) {
    meanVariance += index.variance(i) / static_cast<double>(map.size());
    radii.push_back(map[i].radius);
  }
}

double PreparedMap::likeness(double radius, std::uint32_t pole) const {
  if (!(radius > 0 && radii[pole] > 0)) return 1;
  const double off = (radius - radii[pole]) / options.radiusSigma;
  return kRadiusUnsure + (1 - kRadiusUnsure) * std::exp(-0.5 * off * off);
}

}  // namespace polemcl
