#include <gtest/gtest.h>
#include <mrpt/opengl/CText.h>

#include <cmath>

#include "mrpt/drawing/OverviewScene.h"

namespace polemcl::test_overview_scene {
namespace {
scene::Path alongALine(double length, double heading, double x = 0, double y = 0) {
  scene::Path path;
  for (double s = 0; s <= length; s += length / 200)
    path.emplace_back(x + s * std::cos(heading), y + s * std::sin(heading));
  return path;
}

scene::Path round(double radius) {
  scene::Path path;
  for (int i = 0; i < 100; ++i)
    path.emplace_back(radius * std::cos(i * 0.0628), radius * std::sin(i * 0.0628));
  return path;
}

/// Position of a map place in a 4:3 window, ±1 at its borders; third: distance in the viewer's
/// units.
Eigen::Vector3d seenAt(const mrpt::opengl::COpenGLScene& scene, const Eigen::Vector3d& place) {
  const auto& camera = scene.getViewport()->getCamera();
  const double azimuth = camera.getAzimuthDegrees() * M_PI / 180,
               elevation = camera.getElevationDegrees() * M_PI / 180;
  const Eigen::AngleAxisd turn(azimuth, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d eye = turn * Eigen::AngleAxisd(-elevation, Eigen::Vector3d::UnitY()) *
                              Eigen::Vector3d(camera.getZoomDistance(), 0, 0);
  const Eigen::Vector3d target(camera.getPointingAtX(), camera.getPointingAtY(),
                               camera.getPointingAtZ());
  const double scale = scene.getViewport()->getByName("map")->getScaleX();
  const Eigen::Vector3d ahead = -eye.normalized(), right = turn * Eigen::Vector3d::UnitY(),
                        p = scale * place - target - eye;
  const double depth = ahead.dot(p), half = std::tan(15 * M_PI / 180) * depth;
  return {right.dot(p) / half * 3 / 4, right.cross(ahead).dot(p) / half, depth};
}

/// All places are in the window, and not too small in it.
void expectInView(const scene::Path& places, const Eigen::Vector2d& origin = {0, 0}) {
  const auto scene = OverviewScene(places, "").finish();
  EXPECT_TRUE(scene->followCamera());
  double widest = 0, farthest = 0;
  for (const auto& place : places)
    for (double z : {0.0, 5.0}) {
      const Eigen::Vector2d local = place - origin;
      const auto seen = seenAt(*scene, {local.x(), local.y(), z});
      const double out = seen.head<2>().cwiseAbs().maxCoeff();
      EXPECT_LT(out, 1.05) << place.transpose();
      widest = std::max(widest, out);
      farthest = std::max(farthest, seen.z());
    }
  EXPECT_GT(widest, 0.8);
  EXPECT_LT(farthest, 1000) << "viewers draw up to 10000";
}

TEST(OverviewScene, TheCameraSeesAllWhateverItsShapeAndSize) {
  for (double heading : {0.0, 0.7, 1.6, 3.0}) expectInView(alongALine(1500, heading));
  for (double radius : {20.0, 300.0, 9000.0}) expectInView(round(radius));
  expectInView(alongALine(1500, 0.3, 448123, 5417456), {449000, 5418000});
}

TEST(OverviewScene, LargeMapsAreDrawnSmallerAndSaySo) {
  const auto lengthOf = [](double metres) {
    const auto scene = OverviewScene(alongALine(metres, 0), "").finish();
    const auto legend = scene->getViewport("text")->getTextMessages().messages;
    std::string text;
    for (const auto& [index, line] : legend) text += line.text;
    const double scale = scene->getViewport()->getByName("map")->getScaleX();
    EXPECT_EQ(text.find("unit") != std::string::npos, scale < 1) << text;
    return metres * scale;
  };
  for (double metres : {12.0, 20.0, 21.0, 1500.0, 60000.0}) {
    EXPECT_LE(lengthOf(metres), 20.001) << metres;
    EXPECT_GT(lengthOf(metres), 2) << metres;
  }
}

TEST(OverviewScene, RibbonsHaveGapsWhereAPathJumps) {
  const auto trianglesOf = [](const scene::Path& path) {
    OverviewScene overview(path, "");
    overview.addRibbons("path", {path}, {scene::truthColor});
    const auto scene = overview.finish();
    return std::dynamic_pointer_cast<mrpt::opengl::CSetOfTriangles>(
               scene->getViewport()->getByName("path"))
        ->getTrianglesCount();
  };
  EXPECT_EQ(trianglesOf({{0, 0}, {10, 0}, {50, 0}, {60, 0}}), 6u);
  EXPECT_EQ(trianglesOf({{0, 0}, {10, 0}, {61, 0}, {70, 0}}), 4u);
  EXPECT_EQ(trianglesOf({{0, 0}, {0, 0}, {0.1, 0}, {10, 0}}), 2u) << "more than is seen";
}

TEST(OverviewScene, TheCornersTellWhereOnTheMapTheyLie) {
  const auto scene = OverviewScene({{448010, 5417010}, {448020, 5417040}}, "").finish();
  const auto label = scene->getViewport()->getByClass<mrpt::opengl::CText>();
  ASSERT_TRUE(label);
  EXPECT_EQ(label->getString(), "448009, 5417009");
  EXPECT_NEAR(label->getPose().x, 9, 1e-6);
}

TEST(OverviewScene, AMapWithoutPolesHasAScene) {
  EXPECT_TRUE(OverviewScene({}, "empty").finish()->getByName("ground"));
}

TEST(SceneParts, OnlyFarOriginsMove) {
  const auto at = [](double x, double y) {
    return scene::originFor(Eigen::AlignedBox2d(Eigen::Vector2d(x, y), Eigen::Vector2d(x, y)));
  };
  EXPECT_EQ(at(9000, -9000), Eigen::Vector2d(0, 0));
  EXPECT_EQ(at(448600, -5417400), Eigen::Vector2d(449000, -5417000));
  EXPECT_EQ(scene::originText({0, 0}), "");
  EXPECT_EQ(scene::originText({449000, 0}), "origin: x 449000, y 0 m of the map");
}

TEST(SceneParts, TheLegendHasALetterForEachCharacter) {
  mrpt::opengl::COpenGLScene scene;
  scene::showLegend(scene, {{"Straße → 12"}, {"pole", scene::truthColor}});
  const auto& messages = scene.getViewport("text")->getTextMessages().messages;
  EXPECT_EQ(messages.at(0).text, "Stra?e ? 12");
  EXPECT_GT(messages.at(0).y, messages.at(1).y) << "from top to bottom";
  const auto marks = scene.getViewport("text")->getByClass<mrpt::opengl::CPointCloudColoured>();
  ASSERT_TRUE(marks);
  EXPECT_EQ(marks->size(), 1u);
}

TEST(SceneParts, TheLegendIsAsWideAsItsLinesAndMarksStandBesideTheirs) {
  mrpt::opengl::COpenGLScene scene;
  const std::string line(40, 'm');
  scene::showLegend(scene, {{line}, {"pole", scene::truthColor}, {line}});
  const auto panel = scene.getViewport("text");
  double x, y, width, height;  // pixels
  panel->getViewportPosition(x, y, width, height);
  EXPECT_GT(width, 40 * 12 * 0.75) << "letters of 12 pixels are hardly narrower than high";
  EXPECT_LT(width, 40 * 12 * 1.1);
  const auto mark = panel->getByClass<mrpt::opengl::CPointCloudColoured>()->getPoint3Df(0);
  const double markAt = (mark.y + 1) / 2 * height;
  EXPECT_NEAR(markAt, panel->getTextMessages().messages.at(1).y + 6, 0.1) << "half the letters";
}

}  // namespace
}  // namespace polemcl::test_overview_scene
