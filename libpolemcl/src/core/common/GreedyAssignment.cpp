#include "core/common/GreedyAssignment.h"

#include <cmath>
#include <string>

#include <polemcl/core/common/Types.h>
#include "core/common/KdTree2D.h"

namespace polemcl {

std::vector<AssignedPair> pairsWithin(const std::vector<Eigen::Vector2d>& first,
                                      const std::vector<Eigen::Vector2d>& second, double radius) {
  if (!(std::isfinite(radius) && radius > 0))
    throw Error("the matching radius is " + std::to_string(radius) +
                " m; it must be finite and above 0");
  const KdTree2D tree(second);
  std::vector<AssignedPair> pairs;
  std::vector<PointHit> hits;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (!first[i].allFinite())
      throw Error("point " + std::to_string(i) + " has a coordinate that is not finite");
    tree.within(first[i].x(), first[i].y(), 1.001 * radius, hits);  // the tree excludes the border
    for (const PointHit& hit : hits)
      if (hit.squaredDistance <= radius * radius)
        pairs.push_back({i, hit.index, std::sqrt(hit.squaredDistance)});
  }
  return pairs;
}

std::vector<AssignedPair> greedyAssignment(const std::vector<Eigen::Vector2d>& first,
                                           const std::vector<Eigen::Vector2d>& second,
                                           double radius) {
  std::vector<AssignedPair> chosen = chooseClosest(pairsWithin(first, second, radius));
  std::sort(chosen.begin(), chosen.end(),
            [](const AssignedPair& a, const AssignedPair& b) { return a.first < b.first; });
  return chosen;
}

}  // namespace polemcl
