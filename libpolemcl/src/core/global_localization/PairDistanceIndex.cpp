#include "core/global_localization/PairDistanceIndex.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/common/KdTree2D.h"

namespace polemcl {
namespace {

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

}  // namespace polemcl
