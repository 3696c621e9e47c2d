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
  grid->setColor_u8(TColor(0xd0, 0xd5, 0xdb));
  return grid;
}

/// Lines along the path, each so far to its left, m.
mrpt::opengl::CSetOfLines::Ptr makeLines(const std::vector<StampedPose2D>& path,
                                         const std::vector<double>& offsets, const TColor& color) {
  constexpr double height = 0.05;  // above the grid, which would flicker through
  auto lines = mrpt::opengl::CSetOfLines::Create();
  lines->setLineWidth(2);
  lines->setColor_u8(color);
  for (double offset : offsets)
    for (std::size_t i = 1; i < path.size(); ++i) {
      const Pose2D from = compose(path[i - 1].pose, {0, offset, 0});
      const Pose2D to = compose(path[i].pose, {0, offset, 0});
      lines->appendLine(from.x, from.y, height, to.x, to.y, height);
    }
  return lines;
}

mrpt::opengl::CSetOfObjects::Ptr makePoles(const std::vector<MapPole>& poles) {
  auto objects = mrpt::opengl::CSetOfObjects::Create();
  CPoleMap map;
  map.setPoles(poles);
  map.getVisualizationInto(*objects);
  return objects;
}

void insert(mrpt::opengl::COpenGLScene& scene, const std::string& name,
            const mrpt::opengl::CRenderizable::Ptr& object) {
  object->setName(name);
  scene.insert(object);
}

void lookDown(mrpt::opengl::CCamera& camera, const Bounds& bounds) {
  const double extent = std::max({bounds.xMax - bounds.xMin, bounds.yMax - bounds.yMin, 10.0});
  camera.setPointingAt(static_cast<float>(0.5 * (bounds.xMin + bounds.xMax)),
                       static_cast<float>(0.5 * (bounds.yMin + bounds.yMax)), 0.0f);
  camera.setZoomDistance(static_cast<float>(1.5 * extent));
  camera.setAzimuthDegrees(-90);
  camera.setElevationDegrees(55);
}

}  // namespace

mrpt::opengl::COpenGLScene::Ptr makeMapScene(const MapView& view) {
  const Bounds bounds = boundsOf(view);
  auto scene = mrpt::opengl::COpenGLScene::Create();
  const auto viewport = scene->getViewport();
  viewport->setCustomBackgroundColor({1.0f, 1.0f, 1.0f});
  lookDown(viewport->getCamera(), bounds);
  insert(*scene, "ground", makeGround(bounds));
  insert(*scene, "poles", makePoles(view.poles));
  // Not upon each other: viewers resolve less than the height that would keep them apart.
  if (!view.truth.empty())
    insert(*scene, "truth", makeLines(view.truth, {-0.5, 0.5}, TColor(0x60, 0x68, 0x74)));
  if (!view.estimate.empty())
    insert(*scene, "estimate", makeLines(view.estimate, {0}, TColor(0x00, 0x72, 0xb2)));
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
