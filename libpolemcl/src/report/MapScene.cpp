#include <mrpt/io/CMemoryStream.h>
#include <mrpt/opengl/CGridPlaneXY.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/serialization/CArchive.h>
#include <polemcl/io/AtomicFile.h>
#include <polemcl/mrpt/CPoleMap.h>
#include <polemcl/report/MapScene.h>
#include <polemcl/report/PlotAxes.h>

#include <algorithm>
#include <cmath>

namespace polemcl::report {
namespace {

using mrpt::img::TColor;

/// A grid of round coordinates with a margin round the content.
mrpt::opengl::CGridPlaneXY::Ptr makeGround(const Bounds& bounds) {
  const double extent = std::max({bounds.xMax - bounds.xMin, bounds.yMax - bounds.yMin, 10.0});
  const double step = tickStep(extent, 30);
  const auto down = [&](double value) { return std::floor(value / step - 1) * step; };
  const auto up = [&](double value) { return std::ceil(value / step + 1) * step; };
  auto grid = mrpt::opengl::CGridPlaneXY::Create(
      static_cast<float>(down(bounds.xMin)), static_cast<float>(up(bounds.xMax)),
      static_cast<float>(down(bounds.yMin)), static_cast<float>(up(bounds.yMax)), 0.0f,
      static_cast<float>(step));
  grid->setName("ground");
  grid->setColor_u8(TColor(0xd0, 0xd5, 0xdb));
  return grid;
}

mrpt::opengl::CSetOfLines::Ptr makePath(const std::string& name,
                                        const std::vector<StampedPose2D>& path, double height,
                                        float width, const TColor& color) {
  auto lines = mrpt::opengl::CSetOfLines::Create();
  lines->setName(name);
  lines->setLineWidth(width);
  lines->setColor_u8(color);
  for (std::size_t i = 1; i < path.size(); ++i)
    lines->appendLine(path[i - 1].pose.x, path[i - 1].pose.y, height, path[i].pose.x,
                      path[i].pose.y, height);
  return lines;
}

mrpt::opengl::CSetOfObjects::Ptr makePoles(const std::vector<MapPole>& poles) {
  auto objects = mrpt::opengl::CSetOfObjects::Create();
  objects->setName("poles");
  CPoleMap map;
  map.setPoles(poles);
  map.getVisualizationInto(*objects);
  return objects;
}

void lookDown(mrpt::opengl::CCamera& camera, const Bounds& bounds) {
  const double extent = std::max({bounds.xMax - bounds.xMin, bounds.yMax - bounds.yMin, 10.0});
  camera.setPointingAt(static_cast<float>(0.5 * (bounds.xMin + bounds.xMax)),
                       static_cast<float>(0.5 * (bounds.yMin + bounds.yMax)), 0.0f);
  camera.setZoomDistance(static_cast<float>(1.2 * extent));
  camera.setAzimuthDegrees(-90);
  camera.setElevationDegrees(55);
}

}  // namespace

mrpt::opengl::COpenGLScene::Ptr makeMapScene(const MapView& view) {
  const Bounds bounds = boundsOf(view);
  auto scene = mrpt::opengl::COpenGLScene::Create();
  const auto viewport = scene->getViewport();
  viewport->setCustomBackgroundColor({1.0f, 1.0f, 1.0f});
  const double extent = std::max({bounds.xMax - bounds.xMin, bounds.yMax - bounds.yMin, 10.0});
  viewport->setViewportClipDistances(0.1f, static_cast<float>(10 * extent));
  lookDown(viewport->getCamera(), bounds);
  scene->insert(makeGround(bounds));
  scene->insert(makePoles(view.poles));
  // Two heights, so that the estimate stays visible on top of a truth it lies upon.
  if (!view.truth.empty())
    scene->insert(makePath("truth", view.truth, 0.05, 6, TColor(0x80, 0x88, 0x94)));
  if (!view.estimate.empty())
    scene->insert(makePath("estimate", view.estimate, 0.10, 2, TColor(0x00, 0x72, 0xb2)));
  return scene;
}

void saveScene(const mrpt::opengl::COpenGLScene& scene, const std::filesystem::path& file) {
  // Through memory: MRPT's file streams do not tell when the disk is full.
  mrpt::io::CMemoryStream bytes;
  mrpt::serialization::archiveFrom(bytes) << scene;
  io::AtomicFile output(file);
  output.stream().write(static_cast<const char*>(bytes.getRawBufferData()),
                        static_cast<std::streamsize>(bytes.getTotalBytesCount()));
  output.commit();
}

}  // namespace polemcl::report
