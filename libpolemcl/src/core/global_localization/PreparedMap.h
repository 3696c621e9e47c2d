#pragma once
/// \file PreparedMap.h
/// \brief A map with the search structures that the steps of the global search share. Private to
/// the library; see GlobalLocalizer.h.

#include <vector>

#include <polemcl/core/common/PoleIndex.h>
#include <polemcl/core/global_localization/GlobalLocalizer.h>
#include "core/common/KdTree2D.h"
#include "core/common/PoleGrid.h"
#include "core/global_localization/PairDistanceIndex.h"

namespace polemcl {

/// \brief Built once, never changed, safe to share between threads.
struct PreparedMap {
  /// \throws Error on options out of range, and as PoleIndex.
  PreparedMap(const std::vector<MapPole>& map, const GlobalOptions& globalOptions);

  const GlobalOptions options;
  const PoleIndex index;
  const PairDistanceIndex pairs;
  double meanVariance = 0;  ///< mean of the poles' variances along an axis, m²
};

}  // namespace polemcl
