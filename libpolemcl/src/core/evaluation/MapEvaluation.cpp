#include "core/evaluation/MapEvaluation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <polemcl/core/common/Types.h>
#include "core/common/GreedyAssignment.h"

namespace polemcl {
namespace {

void checkPoles(const std::vector<Eigen::Vector2d>& poles, const std::string& name) {
  if (poles.empty()) throw Error("the " + name + " holds no pole; there must be at least one");
  for (std::size_t i = 0; i < poles.size(); ++i) {
    if (poles[i].allFinite()) continue;
    throw Error("pole " + std::to_string(i) + " of the " + name +
                " has a coordinate that is not finite; remove it");
  }
}

}  // namespace

MapScore scoreMap(const std::vector<Eigen::Vector2d>& truth,
                  const std::vector<Eigen::Vector2d>& map, double radius, bool oneToOne) {
  checkPoles(truth, "true map");
  checkPoles(map, "map");
  std::vector<std::vector<std::uint32_t>> edges(map.size());
  for (const AssignedPair& pair : pairsWithin(map, truth, radius))
    edges[pair.first].push_back(static_cast<std::uint32_t>(pair.second));
  const auto matched = [](const std::vector<std::uint32_t>& candidates) {
    return !candidates.empty();
  };
  MapScore score;
  score.mapPoles = map.size();
  score.truthPoles = truth.size();
  score.matches =
      oneToOne ? maximumMatching(edges, truth.size())
               : static_cast<std::size_t>(std::count_if(edges.begin(), edges.end(), matched));
  const double matches = static_cast<double>(score.matches);
  score.precision = matches / static_cast<double>(map.size());
  score.recall = matches / static_cast<double>(truth.size());
  if (score.matches > 0)
    score.f1 = 2 * score.precision * score.recall / (score.precision + score.recall);
  return score;
}

MapShift mapShift(const std::vector<Eigen::Vector2d>& truth,
                  const std::vector<Eigen::Vector2d>& map, double radius) {
  MapShift result;
  const std::vector<AssignedPair> pairs = greedyAssignment(truth, map, radius);
  result.pairs = pairs.size();
  if (pairs.empty()) return result;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const AssignedPair& pair : pairs) {
    centre += truth[pair.first];
    result.shift += map[pair.second] - truth[pair.first];
  }
  centre /= static_cast<double>(pairs.size());
  result.shift /= static_cast<double>(pairs.size());
  double along = 0, across = 0;
  for (const AssignedPair& pair : pairs) {
    const Eigen::Vector2d from = truth[pair.first] - centre,
                          to = map[pair.second] - centre - result.shift;
    along += from.dot(to);
    across += from.x() * to.y() - from.y() * to.x();
  }
  result.rotation = std::atan2(across, along);
  return result;
}

std::size_t maximumMatching(const std::vector<std::vector<std::uint32_t>>& edges,
                            std::size_t rightCount) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> rightOf(edges.size(), kNone), leftOf(rightCount, kNone);
  std::vector<std::uint32_t> seenFor(rightCount, kNone);  // last search that reached a right node
  std::vector<std::uint32_t> reachedFrom(rightCount);     // the left node before it on its path
  std::vector<bool> exhausted(rightCount, false);         // no free node can be reached from it
  std::size_t matches = 0;
  std::vector<std::uint32_t> queue, seen;

  // Breadth first over alternating paths; returns a free right node.
  const auto search = [&](std::uint32_t start) {
    queue.assign(1, start);
    seen.clear();
    for (std::size_t head = 0; head < queue.size(); ++head) {
      for (const std::uint32_t right : edges[queue[head]]) {
        if (exhausted[right] || seenFor[right] == start) continue;
        seenFor[right] = start;
        reachedFrom[right] = queue[head];
        if (leftOf[right] == kNone) return right;
        seen.push_back(right);
        queue.push_back(leftOf[right]);
      }
    }
    for (const std::uint32_t right : seen) exhausted[right] = true;
    return kNone;
  };

  for (std::uint32_t start = 0; start < edges.size(); ++start) {
    std::uint32_t right = search(start);
    if (right == kNone) continue;
    ++matches;
    // Back along the path: each left node takes the right node that it reached.
    while (right != kNone) {
      const std::uint32_t left = reachedFrom[right];
      leftOf[right] = left;
      std::swap(right, rightOf[left]);
    }
  }
  return matches;
}

}  // namespace polemcl
