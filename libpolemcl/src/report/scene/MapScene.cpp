#include "report/scene/MapScene.h"

#include "mrpt/drawing/OverviewScene.h"

namespace polemcl::report {
namespace {

scene::Path pathOf(const std::vector<StampedPose2D>& poses) {
  scene::Path path;
  for (const StampedPose2D& stamped : poses) path.emplace_back(stamped.pose.x, stamped.pose.y);
  return path;
}

}  // namespace

viz::Scene::Ptr makeMapScene(const MapView& view) {
  boundsOf(view);  // refuses what cannot be shown
  const scene::Path truth = pathOf(view.truth), estimate = pathOf(view.estimate);
  scene::Path places = truth;
  places.insert(places.end(), estimate.begin(), estimate.end());
  for (const MapPole& pole : view.poles) places.emplace_back(pole.x, pole.y);

  OverviewScene overview(places, view.title);
  if (!estimate.empty()) {
    overview.addRibbons("estimate", {estimate}, {scene::estimateColor});
    overview.addLegend({{"path of the estimate", scene::estimateColor}});
  }
  if (!truth.empty()) {
    overview.addRibbons("truth", {truth}, {scene::truthColor, !estimate.empty()});
    overview.addLegend(
        {{estimate.empty() ? "true path" : "true path, at both sides of it", scene::truthColor}});
  }
  if (!view.poles.empty()) {
    overview.addPoles("poles", view.poles,
                      [](const MapPole& pole) { return scene::colorOfCount(pole.count); });
    overview.addLegend(scene::countLegend(view.poles));
  }
  return overview.finish();
}

}  // namespace polemcl::report
