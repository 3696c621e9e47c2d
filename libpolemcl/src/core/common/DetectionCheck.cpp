#include "core/common/DetectionCheck.h"

#include <algorithm>
#include <cmath>

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

}  // namespace polemcl
