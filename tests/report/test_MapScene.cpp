#include <gtest/gtest.h>
#include <mrpt/opengl/CCylinder.h>
#include <mrpt/opengl/CGridPlaneXY.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <polemcl/core/Types.h>
#include <polemcl/report/MapScene.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "views.h"

namespace polemcl::report {
namespace {

using mrpt::opengl::CSetOfLines;

std::vector<mrpt::opengl::CCylinder::Ptr> cylindersOf(mrpt::opengl::COpenGLScene& scene) {
  auto poles = std::dynamic_pointer_cast<mrpt::opengl::CSetOfObjects>(scene.getByName("poles"));
  std::vector<mrpt::opengl::CCylinder::Ptr> cylinders;
  if (!poles) return {};
  for (const auto& object : *poles)
    if (auto cylinder = std::dynamic_pointer_cast<mrpt::opengl::CCylinder>(object))
      cylinders.push_back(cylinder);
  return cylinders;
}

}  // namespace

TEST(MapScene, PolesAreUprightCylindersFromBottomToTop) {
  const auto scene = makeMapScene(smallDrive());
  const auto cylinders = cylindersOf(*scene);
  ASSERT_EQ(cylinders.size(), 4u);
  EXPECT_NEAR(cylinders[1]->getPoseX(), 8, 1e-6);
  EXPECT_NEAR(cylinders[1]->getPoseY(), -6, 1e-6);
  const auto box = cylinders[1]->getBoundingBox();
  EXPECT_NEAR(box.min.z, 0.5, 1e-4);
  EXPECT_NEAR(box.max.z, 4.5, 1e-4);
  EXPECT_NEAR(box.max.x - box.min.x, 0.3, 1e-4);
}

TEST(MapScene, TheEstimateIsALineThroughEveryPose) {
  const auto scene = makeMapScene(smallDrive(0.1));
  const auto lines = std::dynamic_pointer_cast<CSetOfLines>(scene->getByName("estimate"));
  ASSERT_TRUE(lines);
  ASSERT_EQ(lines->getLineCount(), 20u);
  for (std::size_t i = 0; i < 20; ++i) {
    double x0, y0, z0, x1, y1, z1;
    lines->getLineByIndex(i, x0, y0, z0, x1, y1, z1);
    EXPECT_NEAR(x0, static_cast<double>(i), 1e-6);
    EXPECT_NEAR(x1, static_cast<double>(i + 1), 1e-6);
    EXPECT_NEAR(y1, 0.1, 1e-6);
  }
}

TEST(MapScene, TheTruthIsALaneRoundThePath) {
  MapView view = smallDrive();
  view.truth = {{0, {0, 0, M_PI / 2}}, {1, {0, 10, M_PI / 2}}};
  const auto scene = makeMapScene(view);
  const auto lines = std::dynamic_pointer_cast<CSetOfLines>(scene->getByName("truth"));
  ASSERT_TRUE(lines);
  ASSERT_EQ(lines->getLineCount(), 2u);
  const auto box = lines->getBoundingBox();
  EXPECT_NEAR(box.min.x, -0.5, 1e-6);
  EXPECT_NEAR(box.max.x, 0.5, 1e-6);
  EXPECT_NEAR(box.min.y, 0, 1e-6);
  EXPECT_NEAR(box.max.y, 10, 1e-6);
}

TEST(MapScene, GroundReachesBeyondAllAndLiesAtZero) {
  const auto scene = makeMapScene(smallDrive());
  const auto box = scene->getByName("ground")->getBoundingBox();
  EXPECT_LT(box.min.x, 0);
  EXPECT_GT(box.max.x, 20);
  EXPECT_LT(box.min.y, -6);
  EXPECT_GT(box.max.y, 6);
  EXPECT_NEAR(box.min.z, 0, 1e-6);
  EXPECT_NEAR(box.max.z, 0, 1e-6);
}

TEST(MapScene, WhatIsMissingIsLeftOut) {
  MapView view = smallDrive();
  view.truth.clear();
  const auto scene = makeMapScene(view);
  EXPECT_FALSE(scene->getByName("truth"));
  EXPECT_TRUE(scene->getByName("estimate"));
}

TEST(MapScene, TheFileHoldsStockObjectsAndComesBack) {
  const TestFolder folder;
  const auto file = folder / "a.3Dscene";
  saveScene(*makeMapScene(smallDrive()), file);
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  EXPECT_NE(bytes.find("CCylinder"), std::string::npos) << "the search below would find nothing";
  EXPECT_EQ(bytes.find("polemcl"), std::string::npos) << "a viewer would need the plugin";
  mrpt::opengl::COpenGLScene loaded;
  ASSERT_TRUE(loaded.loadFromFile(file.string()));
  EXPECT_EQ(cylindersOf(loaded).size(), 4u);
}

TEST(MapScene, RefusesNothingToShowAndValuesThatAreNotFinite) {
  EXPECT_THROW(makeMapScene({}), Error);
  MapView view = smallDrive();
  view.poles[2].y = HUGE_VAL;
  EXPECT_THROW(makeMapScene(view), Error);
}

TEST(MapScene, RefusesToWriteIntoAMissingFolder) {
  const auto scene = makeMapScene(smallDrive());
  EXPECT_THROW(saveScene(*scene, TestFolder() / "no/a.3Dscene"), Error);
}

}  // namespace polemcl::report
