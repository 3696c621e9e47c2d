#include "core/common/DetectionCheck.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/common/Covariance.h"
#include "core/common/PoleIndex.h"

namespace polemcl {

const char* faultOf(const PoleDetection& pole) {
  if (!std::isfinite(pole.x + pole.y + pole.radius + pole.bottom + pole.top + pole.timeOffset +
                     pole.turnRate))
    return "a number that is not finite";
  if (std::max(std::abs(pole.x), std::abs(pole.y)) > PoleIndex::farthest)
    return "a place more than 1e9 m away";
  if (!(pole.confidence >= 0 && pole.confidence <= 1)) return "a confidence outside [0, 1]";
  if (!isCovariance(pole.covariance))
    return "a covariance that is not symmetric positive semidefinite";
  if (pole.covariance.trace() > kGreatestVariance) return "a covariance above 1e12 m²";
  if (std::abs(pole.radius) > 1e6) return "a radius above 1e6 m";
  if (std::max(std::abs(pole.bottom), std::abs(pole.top)) > PoleIndex::farthest)
    return "a height above 1e9 m";
  if (std::abs(pole.timeOffset) > 1000) return "a time offset above 1000 s";
  return nullptr;
}

void keepMostConfident(std::vector<PoleDetection>& poles) {
  if (poles.size() <= mostDetections) return;
  std::vector<std::size_t> order(poles.size());
  std::iota(order.begin(), order.end(), 0);
  // An invalid confidence comes first: faultOf() shall see it.
  const auto rank = [&](std::size_t i) {
    return std::isfinite(poles[i].confidence) ? poles[i].confidence : INFINITY;
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rank(a) > rank(b); });
  order.resize(mostDetections);
  std::sort(order.begin(), order.end());
  std::vector<PoleDetection> kept;
  kept.reserve(order.size());
  for (const std::size_t i : order) kept.push_back(poles[i]);
  poles = std::move(kept);
}

}  // namespace polemcl
