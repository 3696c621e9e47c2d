#include "core/evaluation/Repeatability.h"

#include <cmath>
#include <string>

#include "core/common/GreedyAssignment.h"
#include "core/common/KdTree2D.h"
#include "core/common/PointsCopy.h"

namespace polemcl {
namespace {

PointsCopy turned(const PointsView& points, double yaw) {
  const double c = std::cos(yaw), s = std::sin(yaw);
  PointsCopy cloud;
  cloud.z.assign(points.z, points.z + points.size);
  for (std::size_t i = 0; i < points.size; ++i) {
    cloud.x.push_back(static_cast<float>(c * points.x[i] - s * points.y[i]));
    cloud.y.push_back(static_cast<float>(s * points.x[i] + c * points.y[i]));
  }
  return cloud;
}

std::vector<Eigen::Vector2d> turnedCentres(const std::vector<PoleDetection>& poles, double yaw) {
  const double c = std::cos(yaw), s = std::sin(yaw);
  std::vector<Eigen::Vector2d> centres;
  centres.reserve(poles.size());
  for (const PoleDetection& p : poles) centres.emplace_back(c * p.x - s * p.y, s * p.x + c * p.y);
  return centres;
}

double ratio(std::size_t part, std::size_t all) {
  return all == 0 ? 0 : static_cast<double>(part) / static_cast<double>(all);
}

}  // namespace

RepeatabilityScore evaluateRepeatability(const std::vector<std::vector<Eigen::Vector2d>>& scans_map,
                                         const RepeatabilityOptions& options) {
  if (!(std::isfinite(options.radius) && options.radius > 0) || options.atLeast < 1 ||
      options.atLeast > options.next)
    throw Error("found again within " + std::to_string(options.radius) + " m in " +
                std::to_string(options.atLeast) + " of " + std::to_string(options.next) +
                " scans makes no sense: a radius above 0 and 1 <= least <= next are needed");
  if (scans_map.size() <= options.next)
    throw Error("only " + std::to_string(scans_map.size()) +
                " scans: a detection is looked for in " + std::to_string(options.next) +
                " scans after its own, so more are needed");
  std::vector<KdTree2D> trees;
  RepeatabilityScore score;
  score.scans = scans_map.size();
  for (const auto& scan : scans_map) {
    trees.emplace_back(scan);
    score.detections += scan.size();
  }
  for (std::size_t i = 0; i + options.next < scans_map.size(); ++i)
    for (const Eigen::Vector2d& pole : scans_map[i]) {
      std::size_t again = 0;
      for (std::size_t k = 1; k <= options.next; ++k)
        again += trees[i + k].nearest(pole.x(), pole.y(), options.radius) ? 1 : 0;
      ++score.judged;
      score.repeated += again >= options.atLeast;
    }
  score.perScan = ratio(score.detections, score.scans);
  score.share = ratio(score.repeated, score.judged);
  return score;
}

void addRotations(PoleExtractor& extractor, const PointsView& points, double radius,
                  RotationScore& score) {
  const std::vector<PoleDetection> poles = extractor.extract(points);
  for (int degrees = 30; degrees < 360; degrees += 30) {
    const double yaw = degrees * M_PI / 180;
    const PointsCopy cloud = turned(points, yaw);
    const auto again = turnedCentres(extractor.extract(cloud.view()), 0);
    score.matched += greedyAssignment(turnedCentres(poles, yaw), again, radius).size();
    score.poles += poles.size();
    score.turnedPoles += again.size();
    ++score.turns;
  }
  ++score.scans;
  score.share = ratio(score.matched, score.poles);
  score.backShare = ratio(score.matched, score.turnedPoles);
}

}  // namespace polemcl
