#include "core/mapping/MapDiff.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "core/common/GreedyAssignment.h"
#include "core/common/KdTree2D.h"
#include "core/common/Transform.h"

namespace polemcl {
namespace {

using Poles = std::vector<MapPole>;

bool byPlace(const MapPole& a, const MapPole& b) {
  return std::tie(a.x, a.y) < std::tie(b.x, b.y);
}

/// Takes the pairs nearer than the gate out of both lists, nearest first.
std::vector<MapDiff::Pair> takePairs(Poles& before, Poles& after, double gate) {
  const KdTree2D tree(centresOf(before));
  std::vector<AssignedPair> candidates;
  std::vector<PointHit> hits;
  for (std::size_t i = 0; i < after.size(); ++i) {
    tree.within(after[i].x, after[i].y, gate, hits);
    for (const PointHit& hit : hits) candidates.push_back({hit.index, i, hit.squaredDistance});
  }
  std::vector<bool> takenBefore(before.size()), takenAfter(after.size());
  std::vector<MapDiff::Pair> pairs;
  for (const AssignedPair& pair : chooseClosest(std::move(candidates))) {
    takenBefore[pair.first] = takenAfter[pair.second] = true;
    pairs.push_back({before[pair.first], after[pair.second], std::sqrt(pair.distance)});
  }
  const auto rest = [](const Poles& all, const std::vector<bool>& taken) {
    Poles left;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (!taken[i]) left.push_back(all[i]);
    return left;
  };
  before = rest(before, takenBefore);
  after = rest(after, takenAfter);
  std::sort(pairs.begin(), pairs.end(), [](const MapDiff::Pair& a, const MapDiff::Pair& b) {
    return byPlace(a.after, b.after);
  });
  return pairs;
}

}  // namespace

void MapDiffOptions::validate() const {
  if (!(std::isfinite(same) && same > 0))
    throw Error("same = " + std::to_string(same) + " is not allowed; it must be above 0 m");
  if (!(std::isfinite(moved) && moved >= 0))
    throw Error("moved = " + std::to_string(moved) + " is not allowed; it must be at least 0 m");
}

MapDiff diffMaps(const Poles& before, const Poles& after, const MapDiffOptions& options) {
  options.validate();
  MapDiff diff;
  diff.vanished = before;
  diff.appeared = after;
  std::sort(diff.vanished.begin(), diff.vanished.end(), byPlace);
  std::sort(diff.appeared.begin(), diff.appeared.end(), byPlace);
  diff.same = takePairs(diff.vanished, diff.appeared, options.same);
  diff.moved = takePairs(diff.vanished, diff.appeared, options.moved);
  return diff;
}

}  // namespace polemcl
