#include "report/scene/MapScene.h"

#include <algorithm>

#include "mrpt/drawing/OverviewScene.h"

namespace polemcl::report {
namespace {

const scene::TColor kLoopColor(204, 121, 167);
constexpr double kShortestLoop = 5;  // m, of the bar that shows it; more in large scenes

std::vector<scene::Path> pathsOf(const std::vector<StampedPose2D>& poses) {
  std::vector<scene::Path> paths;
  for (const auto& drive : drivesOf(poses)) {
    scene::Path& path = paths.emplace_back();
    for (const StampedPose2D& stamped : drive) path.emplace_back(stamped.pose.x, stamped.pose.y);
  }
  return paths;
}

/// From place to place, and beyond them where they are near to each other.
std::vector<scene::Path> barsOf(const MapView& view, const Bounds& bounds) {
  const double span = std::max(bounds.xMax - bounds.xMin, bounds.yMax - bounds.yMin);
  const double shortest = std::max(kShortestLoop, span / 100);
  std::vector<scene::Path> bars;
  for (const auto& [first, second] : view.loops) {
    const Eigen::Vector2d way = second - first, middle = 0.5 * (first + second);
    const Eigen::Vector2d along = way.norm() > 0 ? way.normalized() : Eigen::Vector2d::UnitX();
    const Eigen::Vector2d half = 0.5 * std::max(way.norm(), shortest) * along;
    bars.push_back({middle - half, middle + half});
  }
  return bars;
}

std::vector<MapPole> laterOf(const std::vector<MapDiff::Pair>& pairs) {
  std::vector<MapPole> poles;
  poles.reserve(pairs.size());
  for (const MapDiff::Pair& pair : pairs) poles.push_back(pair.after);
  return poles;
}

}  // namespace

viz::Scene::Ptr makeMapScene(const MapView& view) {
  const Bounds bounds = boundsOf(view);  // refuses what cannot be shown
  const auto truth = pathsOf(view.truth), estimate = pathsOf(view.estimate);
  scene::Path places;
  for (const auto* paths : {&truth, &estimate})
    for (const scene::Path& path : *paths) places.insert(places.end(), path.begin(), path.end());
  for (const MapPole& pole : view.poles) places.emplace_back(pole.x, pole.y);

  OverviewScene overview(places, view.title);
  if (!estimate.empty()) {
    overview.addRibbons("estimate", estimate, {scene::estimateColor});
    overview.addLegend({{"path of the estimate", scene::estimateColor}});
  }
  if (!truth.empty()) {
    overview.addRibbons("truth", truth, {scene::truthColor, !estimate.empty()});
    overview.addLegend(
        {{estimate.empty() ? "true path" : "true path, at both sides of it", scene::truthColor}});
  }
  if (!view.loops.empty()) {
    overview.addRibbons("loops", barsOf(view, bounds), {kLoopColor, false, 0, true});
    overview.addLegend({{std::to_string(view.loops.size()) + " loops", kLoopColor}});
  }
  if (!view.poles.empty()) {
    overview.addPoles("poles", view.poles,
                      [](const MapPole& pole) { return scene::colorOfCount(pole.count); });
    overview.addLegend(scene::countLegend(view.poles));
  }
  return overview.finish();
}

viz::Scene::Ptr makeDiffScene(const MapDiff& diff, const std::string& title) {
  struct Kind {
    const char *name, *text;
    std::vector<MapPole> poles;
    scene::TColor color;
  };
  const scene::TColor movedTint(0x00, 0x72, 0xb2);
  const Kind kinds[] = {
      {"same", "on both maps", laterOf(diff.same), {0x9a, 0xa2, 0xad}},
      {"new", "new, on the later map only", diff.appeared, {0x00, 0x9e, 0x73}},
      {"vanished", "vanished, on the earlier map only", diff.vanished, {0xd5, 0x5e, 0x00}},
      {"moved", "moved, with a ribbon from the old place", laterOf(diff.moved), movedTint}};
  scene::Path places;
  for (const Kind& kind : kinds)
    for (const MapPole& pole : kind.poles) places.emplace_back(pole.x, pole.y);
  if (places.empty()) throw Error("nothing to show: both maps are empty");

  OverviewScene overview(places, title);
  for (const Kind& kind : kinds) {
    overview.addPoles(kind.name, kind.poles, [&](const MapPole&) { return kind.color; });
    overview.addLegend({{std::to_string(kind.poles.size()) + " " + kind.text, kind.color}});
  }
  std::vector<scene::Path> moves;
  for (const MapDiff::Pair& pair : diff.moved)
    moves.push_back({{pair.before.x, pair.before.y}, {pair.after.x, pair.after.y}});
  overview.addRibbons("moves", moves, {movedTint, false, 0.3});
  return overview.finish();
}

}  // namespace polemcl::report
