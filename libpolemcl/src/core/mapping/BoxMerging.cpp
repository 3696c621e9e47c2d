#include "core/mapping/BoxMerging.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/common/DisjointSets.h"
#include "core/common/KdTree2D.h"
#include "core/common/Transform.h"

namespace polemcl {
namespace {

/// The same sums of coordinates and radii as the boxes are made of, so that rounding decides alike.
bool overlap(const PoleDetection& a, const PoleDetection& b) {
  return a.x - a.radius <= b.x + b.radius && a.x + a.radius >= b.x - b.radius &&
         a.y - a.radius <= b.y + b.radius && a.y + a.radius >= b.y - b.radius;
}

}  // namespace

std::vector<std::vector<std::uint32_t>> joinOverlappingBoxes(
    const std::vector<LandmarkObservation>& observations) {
  double widest = 0;
  for (const LandmarkObservation& observation : observations)
    widest = std::max(widest, observation.pole.radius);
  const KdTree2D tree(centresOf(observations));
  DisjointSets sets(observations.size());
  std::vector<PointHit> near;
  for (std::uint32_t i = 0; i < observations.size(); ++i) {
    const PoleDetection& pole = observations[i].pole;
    // Corners of boxes that touch are the farthest; the margin is for rounding, and radii of 0.
    const double reach = 1.415 * std::max(0.0, pole.radius + widest) + 1e-6;
    tree.within(pole.x, pole.y, reach, near);
    for (const PointHit& hit : near)
      if (hit.index < i && overlap(observations[hit.index].pole, pole)) sets.join(hit.index, i);
  }
  std::vector<std::vector<std::uint32_t>> groups;
  std::vector<std::size_t> groupOf(observations.size());
  for (std::uint32_t i = 0; i < observations.size(); ++i) {
    const std::size_t root = sets.root(i);
    if (root == i) {
      groupOf[i] = groups.size();
      groups.emplace_back();
    }
    groups[groupOf[root]].push_back(i);
  }
  return groups;
}

MapPole plainMean(const std::vector<LandmarkObservation>& observations,
                  const std::vector<std::uint32_t>& members) {
  std::vector<const PoleDetection*> poles;
  poles.reserve(members.size());
  for (const std::uint32_t member : members) poles.push_back(&observations[member].pole);
  // Sums round by their order: this one does not depend on that of the detections.
  std::sort(poles.begin(), poles.end(), [](const PoleDetection* a, const PoleDetection* b) {
    return std::tie(a->x, a->y, a->radius, a->bottom, a->top, a->confidence) <
           std::tie(b->x, b->y, b->radius, b->bottom, b->top, b->confidence);
  });
  const PoleDetection& first = *poles.front();  // no digits are lost far from the origin
  const double share = 1 / static_cast<double>(poles.size());
  MapPole mean;
  mean.x = first.x;
  mean.y = first.y;
  mean.radius = mean.bottom = mean.top = mean.confidence = 0;
  mean.covariance.setZero();
  for (const PoleDetection* pole : poles) {
    mean.x += share * (pole->x - first.x);
    mean.y += share * (pole->y - first.y);
    mean.radius += share * pole->radius;
    mean.bottom += share * pole->bottom;
    mean.top += share * pole->top;
    mean.confidence += share * pole->confidence;
    mean.covariance += share * share * pole->covariance;
  }
  mean.confidence = std::min(mean.confidence, 1.0);
  mean.count = static_cast<std::uint32_t>(poles.size());
  return mean;
}

}  // namespace polemcl
