#include "core/global_localization/PreparedMap.h"

#include <cmath>

#include "core/common/Transform.h"

namespace polemcl {
namespace {

/// Probability that a radius was measured too wrong to be compared.
constexpr double kRadiusUnsure = 0.2;

}  // namespace

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
