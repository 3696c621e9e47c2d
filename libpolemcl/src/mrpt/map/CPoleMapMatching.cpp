#include <mrpt/poses/CPose2D.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/tfest/TMatchingPair.h>

#include <cmath>
#include <limits>

#include <polemcl/mrpt/map/CPoleMap.h>
#include "core/common/PoleIndex.h"

namespace polemcl {

using mrpt::maps::CMetricMap;
using mrpt::maps::TMatchingExtraResults;
using mrpt::maps::TMatchingParams;
using mrpt::tfest::TMatchingPairList;

namespace {

constexpr double kAnywhere = 4 * PoleIndex::farthest;  ///< no two poles are farther apart, m

const std::vector<MapPole>& polesOf(const CMetricMap* map) {
  const auto* poles = dynamic_cast<const CPoleMap*>(map);
  if (!poles)
    throw Error(std::string("a pole map can be matched with another pole map only, not with ") +
                (map ? map->GetRuntimeClass()->className : "no map"));
  return poles->poles();
}

void requireConsistent(const TMatchingParams& params) {
  if (params.offset_other_map_points >= params.decimation_other_map_points)
    throw Error("offset_other_map_points must be less than decimation_other_map_points");
  if (params.onlyUniqueRobust && !params.onlyKeepTheClosest)
    throw Error("onlyUniqueRobust needs onlyKeepTheClosest");
}

std::vector<PoleIndex::Neighbour> partners(const PoleIndex& index, const TMatchingParams& params,
                                           const mrpt::math::TPoint3D& place) {
  const auto& pivot = params.angularDistPivotPoint;
  const double radius =
      params.maxDistForCorrespondence +
      params.maxAngularDistForCorrespondence * std::hypot(place.x - pivot.x, place.y - pivot.y);
  if (!params.onlyKeepTheClosest) return index.within(place.x, place.y, radius);
  const auto nearest = index.nearest(place.x, place.y, radius);
  return nearest ? std::vector{*nearest} : std::vector<PoleIndex::Neighbour>();
}

}  // namespace

void CPoleMap::determineMatching2D(const CMetricMap* otherMap,
                                   const mrpt::poses::CPose2D& otherMapPose,
                                   TMatchingPairList& correspondences,
                                   const TMatchingParams& params,
                                   TMatchingExtraResults& extraResults) const {
  determineMatching3D(otherMap, mrpt::poses::CPose3D(otherMapPose), correspondences, params,
                      extraResults);
}

void CPoleMap::determineMatching3D(const CMetricMap* otherMap,
                                   const mrpt::poses::CPose3D& otherMapPose,
                                   TMatchingPairList& correspondences,
                                   const TMatchingParams& params,
                                   TMatchingExtraResults& extraResults) const {
  const std::vector<MapPole>& others = polesOf(otherMap);
  requireConsistent(params);
  TMatchingPairList pairs;
  double squares = 0;
  std::size_t matched = 0;
  for (std::size_t i = params.offset_other_map_points; i < others.size();
       i += params.decimation_other_map_points) {
    const auto place = otherMapPose.composePoint({others[i].x, others[i].y, 0});
    const auto near = partners(index(), params, place);
    if (!near.empty()) ++matched;
    for (const auto& neighbour : near) {
      const MapPole& pole = m_poles[neighbour.index];
      mrpt::tfest::TMatchingPair& pair = pairs.emplace_back();
      pair.globalIdx = static_cast<std::uint32_t>(neighbour.index);
      pair.localIdx = static_cast<std::uint32_t>(i);
      pair.global = {static_cast<float>(pole.x), static_cast<float>(pole.y), 0};
      pair.local = {static_cast<float>(others[i].x), static_cast<float>(others[i].y), 0};
      const double square = neighbour.distance * neighbour.distance;
      pair.errorSquareAfterTransformation = static_cast<float>(square);
      squares += square;
    }
  }
  // As in MRPT's point maps: mean over the pairs in spite of its name, and a share of all points.
  extraResults.sumSqrDist =
      pairs.empty() ? 0 : static_cast<float>(squares / static_cast<double>(pairs.size()));
  extraResults.correspondencesRatio =
      others.empty() ? 0
                     : static_cast<float>(params.decimation_other_map_points * matched) /
                           static_cast<float>(others.size());
  correspondences.clear();
  if (params.onlyUniqueRobust)
    pairs.filterUniqueRobustPairs(m_poles.size(), correspondences);
  else
    correspondences.swap(pairs);
}

float CPoleMap::compute3DMatchingRatio(const CMetricMap* otherMap,
                                       const mrpt::poses::CPose3D& otherMapPose,
                                       const mrpt::maps::TMatchingRatioParams& params) const {
  TMatchingParams matching;
  matching.maxDistForCorrespondence = params.maxDistForCorr;
  TMatchingPairList pairs;
  TMatchingExtraResults results;
  determineMatching3D(otherMap, otherMapPose, pairs, matching, results);
  return results.correspondencesRatio;
}

float CPoleMap::squareDistanceToClosestCorrespondence(float x0, float y0) const {
  const auto nearest = index().nearest(x0, y0, kAnywhere);
  return nearest ? static_cast<float>(nearest->distance * nearest->distance)
                 : std::numeric_limits<float>::infinity();
}

}  // namespace polemcl
