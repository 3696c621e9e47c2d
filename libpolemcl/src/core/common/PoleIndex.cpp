#include "core/common/PoleIndex.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/common/KdTree2D.h"
#include "core/common/PoleGrid.h"

namespace polemcl {
namespace {

std::vector<Eigen::Vector2d> centres(const std::vector<MapPole>& poles) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(poles.size());
  for (const MapPole& pole : poles) {
    if (!std::isfinite(pole.x) || !std::isfinite(pole.y) || !pole.covariance.allFinite()) {
      throw Error(
          "pole " + std::to_string(points.size()) +
          " of the map has a centre or covariance that is not finite; remove it from the map");
    }
    if (std::abs(pole.x) > PoleIndex::farthest || std::abs(pole.y) > PoleIndex::farthest) {
      std::ostringstream text;
      text << "pole " << points.size() << " of the map lies at (" << pole.x << ", " << pole.y
           << "); coordinates up to " << PoleIndex::farthest
           << " m are allowed: remove it from the map";
      throw Error(text.str());
    }
    points.emplace_back(pole.x, pole.y);
  }
  return points;
}

double checkedRadius(double radius) {
  if (std::isfinite(radius) && radius > 0) return radius;
  throw Error("a pole index cannot be prepared for a radius of " + std::to_string(radius) +
              " m; it must be finite and above 0");
}

}  // namespace

PoleIndex::PoleIndex(const std::vector<MapPole>& poles, double preparedRadius)
    : m_tree(std::make_shared<const KdTree2D>(centres(poles))),
      m_grid(std::make_shared<const PoleGrid>(centres(poles), checkedRadius(preparedRadius))),
      m_preparedRadius(preparedRadius) {
  m_variances.reserve(poles.size());
  for (const MapPole& pole : poles) m_variances.push_back(0.5 * pole.covariance.trace());
}

std::optional<PoleIndex::Neighbour> PoleIndex::nearest(double x, double y, double radius) const {
  if (!(radius > 0)) return std::nullopt;
  const PointHit hit = radius <= m_preparedRadius ? m_grid->nearest(x, y, radius * radius)
                                                  : m_tree->nearest(x, y, radius);
  if (!hit) return std::nullopt;
  return Neighbour{hit.index, std::sqrt(hit.squaredDistance)};
}

std::vector<PoleIndex::Neighbour> PoleIndex::within(double x, double y, double radius) const {
  std::vector<PointHit> hits;
  m_tree->within(x, y, radius, hits);
  std::stable_sort(hits.begin(), hits.end(), [](const PointHit& a, const PointHit& b) {
    return a.squaredDistance < b.squaredDistance;
  });
  std::vector<Neighbour> neighbours;
  neighbours.reserve(hits.size());
  for (const PointHit& hit : hits)
    neighbours.push_back({hit.index, std::sqrt(hit.squaredDistance)});
  return neighbours;
}

}  // namespace polemcl
