#include "core/global_localization/PreparedMap.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/common/KdTree2D.h"
#include "core/common/Transform.h"

namespace polemcl {
namespace {

/// Probability that a radius was measured too wrong to be compared.
constexpr double kRadiusUnsure = 0.2;

bool before(const PairDistanceIndex::Pair& a, const PairDistanceIndex::Pair& b) {
  return std::tie(a.distance, a.first, a.second) < std::tie(b.distance, b.first, b.second);
}

bool same(const PairDistanceIndex::Pair& a, const PairDistanceIndex::Pair& b) {
  return a.first == b.first && a.second == b.second;
}

}  // namespace

PairDistanceIndex::PairDistanceIndex(const std::vector<Eigen::Vector2d>& poles, double minDistance,
                                     double maxDistance, std::size_t neighbours) {
  const KdTree2D tree(poles);
  std::vector<PointHit> hits;
  for (std::uint32_t i = 0; i < poles.size(); ++i) {
    tree.within(poles[i].x(), poles[i].y(), maxDistance, hits);
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
