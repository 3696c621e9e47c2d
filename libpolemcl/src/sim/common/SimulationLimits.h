#pragma once
/// \file SimulationLimits.h
/// \brief Allowed ranges of the simulation settings, for INI files and validate().

#include <sstream>

#include "config/Config.h"
#include "core/common/Types.h"

namespace polemcl::sim::limits {

inline const Range seed = Range::between(0, 9e15), day = Range::between(0, 36500),
                   length = Range::between(20, 50000), curviness = Range::between(0, 2),
                   relief = Range::between(0, 3), roadWidth = Range::between(6, 20),
                   lampSpacing = Range::between(8, 1000), signSpacing = Range::between(8, 1000),
                   treeSpacing = Range::between(4, 100), share = Range::between(0, 1),
                   clutter = Range::between(0, 3), foliage = Range::between(0, 2),
                   replacedPerYear = Range::between(0, 0.9), dayOfYear = Range::between(0, 365),
                   snowBank = Range::between(0, 2), buildingSites = Range::between(0, 6),
                   sideStreets = Range::between(0, 2);
inline const Range origin = Range::between(-10, 10), height = Range::between(0.3, 5),
                   spacing = Range::between(0.05, 50), speed = Range::between(0.1, 50),
                   laneOffset = Range::between(-10, 10), odometryNoise = Range::between(0, 1),
                   scans = Range::between(0, 1e7), falseFactor = Range::between(0, 10),
                   detour = Range::between(0, 2);

/// \throws Error with the key, unless its value is allowed.
inline void require(const char* key, double value, const Range& allowed) {
  if (allowed.contains(value)) return;
  std::ostringstream message;
  message << key << " = " << value << ": allowed are " << allowed.text();
  throw Error(message.str());
}

}  // namespace polemcl::sim::limits
