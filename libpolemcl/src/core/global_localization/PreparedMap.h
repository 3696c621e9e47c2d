#pragma once
/// \file PreparedMap.h
/// \brief A map with the search structures that the steps of the global search share. Private to
/// the library; see GlobalLocalizer.h.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "core/common/KdTree2D.h"
#include "core/common/PoleGrid.h"
#include "core/common/PoleIndex.h"
#include "core/global_localization/GlobalLocalizer.h"

namespace polemcl {

/// \brief Built once, never changed, safe to share between threads.
///
/// Memory is bounded by `poles · neighbours` pairs of 12 bytes. In crowds (parks) each pole keeps
/// only that many of its neighbours, evenly taken from near to far, so that no distance is lost.
/// Where more than 2048 poles are in reach, which is no real place, it takes them from one pole per
/// cell of a grid: the time to build grows with the number of poles, not with its square.
class PairDistanceIndex {
 public:
  struct Pair {
    float distance;       ///< m
    std::uint32_t first;  ///< into the poles given, first < second
    std::uint32_t second;
  };
  /// \param poles Centres, map frame, m; finite.
  /// \param minDistance, maxDistance Pairs outside are not kept, m; 0 < min < max.
  /// \param neighbours Most partners a pole asks for (it may be asked for by more).
  PairDistanceIndex(const std::vector<Eigen::Vector2d>& poles, double minDistance,
                    double maxDistance, std::size_t neighbours = 48);

  /// \brief All pairs with low <= distance <= high, as [begin, end) of memory that belongs to this.
  struct Range {
    const Pair* begin;
    const Pair* end;
    std::size_t size() const { return static_cast<std::size_t>(end - begin); }
  };
  Range between(double low, double high) const&;
  Range between(double low, double high) const&& = delete;  // it would point into what is gone
  std::size_t size() const { return m_pairs.size(); }

 private:
  std::vector<Pair> m_pairs;  ///< by distance, then first, then second
};

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
