#pragma once
/// \file PreparedMap.h
/// \brief A map with the search structures that the steps of the global search share. Private to
/// the library; see GlobalLocalizer.h.

#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/core/global_localization/GlobalLocalizer.h>
#include "core/common/KdTree2D.h"
#include "core/common/PoleGrid.h"
#include "core/global_localization/PairDistanceIndex.h"

namespace polemcl {

/// \brief Built once, never changed, safe to share between threads.
class PreparedMap {
 public:
  /// \throws Error on options out of range or a map pole whose centre or covariance is not finite.
  PreparedMap(const std::vector<MapPole>& map, const GlobalOptions& options);

  const GlobalOptions& options() const { return m_options; }
  const KdTree2D& tree() const { return m_tree; }
  const PoleGrid& grid() const { return m_grid; }
  const PairDistanceIndex& pairs() const { return m_pairs; }
  /// \brief Half the trace of a pole's covariance, m².
  double variance(std::size_t pole) const { return m_variances[pole]; }
  double meanVariance() const { return m_meanVariance; }  ///< m²

 private:
  GlobalOptions m_options;
  KdTree2D m_tree;
  PoleGrid m_grid;
  PairDistanceIndex m_pairs;
  std::vector<double> m_variances;
  double m_meanVariance = 0;
};

}  // namespace polemcl
