#include <mrpt/opengl/CCylinder.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <polemcl/report/DiffScene.h>

#include <algorithm>

namespace polemcl::report {
namespace {

using mrpt::img::TColor;

constexpr double thin = 0.1;    ///< m: thinner poles are not seen from afar
constexpr double lowest = 0.5;  ///< m: of a cylinder

void addPole(mrpt::opengl::CSetOfObjects& objects, const MapPole& pole, const TColor& color) {
  const auto radius = static_cast<float>(std::max(thin, pole.radius));
  auto cylinder = mrpt::opengl::CCylinder::Create(
      radius, radius, static_cast<float>(std::max(lowest, pole.top - pole.bottom)), 12);
  cylinder->setLocation(pole.x, pole.y, pole.bottom);
  cylinder->setColor_u8(color);
  objects.insert(cylinder);
}

mrpt::opengl::CSetOfObjects::Ptr group(mrpt::opengl::COpenGLScene& scene, const char* name) {
  auto objects = mrpt::opengl::CSetOfObjects::Create();
  objects->setName(name);
  scene.insert(objects);
  return objects;
}

void lookAt(mrpt::opengl::CCamera& camera, const std::vector<MapPole>& poles) {
  const auto [west, east] = std::minmax_element(
      poles.begin(), poles.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  const auto [south, north] = std::minmax_element(
      poles.begin(), poles.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
  camera.setPointingAt(static_cast<float>(0.5 * (west->x + east->x)),
                       static_cast<float>(0.5 * (south->y + north->y)), 0.0f);
  const double extent = std::max({east->x - west->x, north->y - south->y, 10.0});
  camera.setZoomDistance(static_cast<float>(1.5 * extent));
  camera.setAzimuthDegrees(-90);
  camera.setElevationDegrees(55);
}

}  // namespace

mrpt::opengl::COpenGLScene::Ptr makeDiffScene(const MapDiff& diff) {
  auto scene = mrpt::opengl::COpenGLScene::Create();
  std::vector<MapPole> all = diff.appeared;
  all.insert(all.end(), diff.vanished.begin(), diff.vanished.end());
  const auto same = group(*scene, "same"), appeared = group(*scene, "new"),
             vanished = group(*scene, "vanished"), moved = group(*scene, "moved");
  for (const MapPole& pole : diff.appeared) addPole(*appeared, pole, TColor(0x00, 0x9e, 0x73));
  for (const MapPole& pole : diff.vanished) addPole(*vanished, pole, TColor(0xd5, 0x5e, 0x00));
  for (const MapDiff::Pair& pair : diff.same) {
    addPole(*same, pair.after, TColor(0xaa, 0xb2, 0xbd));
    all.push_back(pair.after);
  }
  auto ways = mrpt::opengl::CSetOfLines::Create();
  ways->setColor_u8(TColor(0x00, 0x72, 0xb2));
  ways->setLineWidth(3);
  for (const MapDiff::Pair& pair : diff.moved) {
    addPole(*moved, pair.after, TColor(0x00, 0x72, 0xb2));
    ways->appendLine(pair.before.x, pair.before.y, 1.0, pair.after.x, pair.after.y, 1.0);
    all.push_back(pair.after);
  }
  moved->insert(ways);
  if (all.empty()) throw Error("nothing to show: both maps are empty");
  scene->getViewport()->setCustomBackgroundColor({1.0f, 1.0f, 1.0f});
  lookAt(scene->getViewport()->getCamera(), all);
  return scene;
}

}  // namespace polemcl::report
