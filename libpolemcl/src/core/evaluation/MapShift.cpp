#include "core/evaluation/MapShift.h"

#include <cmath>

#include "core/common/GreedyAssignment.h"

namespace polemcl {

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

}  // namespace polemcl
