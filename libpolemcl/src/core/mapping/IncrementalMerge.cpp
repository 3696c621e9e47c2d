#include "core/mapping/IncrementalMerge.h"

#include <algorithm>
#include <utility>

#include "core/common/GreedyAssignment.h"

namespace polemcl {
namespace {

void absorb(MapPole& pole, const PoleDetection& seen) {
  const double n = pole.count, all = n + 1;
  pole.x += (seen.x - pole.x) / all;
  pole.y += (seen.y - pole.y) / all;
  pole.radius += (seen.radius - pole.radius) / all;
  pole.confidence += (seen.confidence - pole.confidence) / all;
  pole.bottom = std::min(pole.bottom, seen.bottom);
  pole.top = std::max(pole.top, seen.top);
  // Covariance of the mean of n + 1 independent detections; the pole's covariance sums up n of
  // them.
  pole.covariance = (n * n * pole.covariance + seen.covariance) / (all * all);
  ++pole.count;
}

MapPole newPole(const PoleDetection& seen) {
  MapPole pole;
  pole.x = seen.x;
  pole.y = seen.y;
  pole.radius = seen.radius;
  pole.bottom = seen.bottom;
  pole.top = seen.top;
  pole.confidence = seen.confidence;
  pole.covariance = seen.covariance;
  pole.count = 1;
  return pole;
}

}  // namespace

void mergeScan(std::vector<MapPole>& poles, const PoleIndex& index,
               const std::vector<PoleDetection>& detections_map, double mergeDistance) {
  std::vector<AssignedPair> pairs;  // detection, pole
  for (std::size_t i = 0; i < detections_map.size(); ++i)
    for (const auto& near : index.within(detections_map[i].x, detections_map[i].y, mergeDistance))
      pairs.push_back({i, near.index, near.distance});
  std::vector<bool> merged(detections_map.size());
  for (const AssignedPair& pair : chooseClosest(std::move(pairs))) {
    merged[pair.first] = true;
    absorb(poles[pair.second], detections_map[pair.first]);
  }
  for (std::size_t i = 0; i < detections_map.size(); ++i)
    if (!merged[i]) poles.push_back(newPole(detections_map[i]));
}

}  // namespace polemcl
