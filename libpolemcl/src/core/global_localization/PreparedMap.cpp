#include "core/global_localization/PreparedMap.h"

#include <cmath>
#include <string>

namespace polemcl {
namespace {

std::vector<Eigen::Vector2d> mapCentres(const std::vector<MapPole>& map) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(map.size());
  for (const MapPole& pole : map) {
    if (!std::isfinite(pole.x) || !std::isfinite(pole.y) || !pole.covariance.allFinite())
      throw Error("pole " + std::to_string(points.size()) +
                  " of the map has a centre or covariance that is not finite; remove it");
    points.emplace_back(pole.x, pole.y);
  }
  return points;
}

const GlobalOptions& checked(const GlobalOptions& options) {
  checkOptions(options);
  return options;
}

}  // namespace

PreparedMap::PreparedMap(const std::vector<MapPole>& map, const GlobalOptions& options)
    : m_options(checked(options)),
      m_tree(mapCentres(map)),
      m_grid(mapCentres(map), options.maxTolerance),
      m_pairs(mapCentres(map), options.minBaseline, options.maxBaseline) {
  m_variances.reserve(map.size());
  for (const MapPole& pole : map) {
    m_variances.push_back(0.5 * pole.covariance.trace());
    m_meanVariance += m_variances.back() / static_cast<double>(map.size());
  }
}

}  // namespace polemcl
