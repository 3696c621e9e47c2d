#pragma once
/// \file PreparedMap.h
/// \brief A map with the search structures that the steps of the global search share. Private to
/// the library; see GlobalLocalizer.h.

#include <vector>

#include "core/common/KdTree2D.h"
#include "core/common/PoleGrid.h"
#include "core/common/PoleIndex.h"
#include "core/global_localization/GlobalLocalizer.h"
#include "core/global_localization/PairDistanceIndex.h"

namespace polemcl {

/// \brief Built once, never changed, safe to share between threads.
struct PreparedMap {
  /// \throws Error on options out of range, and as PoleIndex.
  PreparedMap(const std::vector<MapPole>& map, const GlobalOptions& globalOptions);

  /// \brief How much a match with this map pole counts, by the radius of the pole seen, m: in
  /// (0, 1], 1 where either radius is 0, unknown.
  double likeness(double radius, std::uint32_t pole) const;

  const GlobalOptions options;
  const PoleIndex index;
  const PairDistanceIndex pairs;
  std::vector<double> radii;  ///< of the poles, m; 0: unknown
  double meanVariance = 0;    ///< mean of the poles' variances along an axis, m²
};

}  // namespace polemcl
