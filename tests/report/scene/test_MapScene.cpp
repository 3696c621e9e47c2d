#include <gtest/gtest.h>
#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfTriangles.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "report/scene/MapScene.h"
#include "support/ExpectHas.h"
#include "support/SampleViews.h"
#include "support/Scenes.h"

namespace polemcl::report::test_map_scene {
namespace {
MapView movedBy(MapView view, double x, double y) {
  for (MapPole& pole : view.poles) pole.x += x, pole.y += y;
  for (auto* path : {&view.truth, &view.estimate})
    for (StampedPose2D& stamped : *path) stamped.pose.x += x, stamped.pose.y += y;
  return view;
}

mrpt::opengl::COpenGLScene::Ptr writtenAndRead(const mrpt::opengl::COpenGLScene& scene) {
  const testing_apps::TempFolder folder;
  scene::save(scene, folder / "a.3Dscene");
  auto loaded = mrpt::opengl::COpenGLScene::Create();
  EXPECT_TRUE(loaded->loadFromFile((folder / "a.3Dscene").string()));
  return loaded;
}

std::size_t trianglesOf(const mrpt::opengl::COpenGLScene::Ptr& scene, const std::string& name) {
  const auto triangles =
      std::dynamic_pointer_cast<mrpt::opengl::CSetOfTriangles>(scene->getByName(name));
  return triangles ? triangles->getTrianglesCount() : 0;
}

TEST(MapScene, PolesAreUprightCylindersFromBottomToTop) {
  const auto cylinders = cylindersOf(makeMapScene(smallDrive()), "poles");
  ASSERT_EQ(cylinders.size(), 4u);
  EXPECT_NEAR(cylinders[1]->getPose().x, 8, 1e-6);
  EXPECT_NEAR(cylinders[1]->getPose().y, -6, 1e-6);
  const auto box = cylinders[1]->getBoundingBox();
  EXPECT_NEAR(box.min.z, 0.5, 1e-4);
  EXPECT_NEAR(box.max.z, 4.5, 1e-4);
  EXPECT_NEAR(box.max.x - box.min.x, 0.3, 1e-4);
}

TEST(MapScene, DotsAndLegendShowThePolesByCount) {
  MapView view = smallDrive();
  view.poles[0].count = 1;
  view.poles[1].count = 250;
  const auto scene = makeMapScene(view);
  const auto dots =
      std::dynamic_pointer_cast<mrpt::opengl::CPointCloudColoured>(scene->getByName("poles dots"));
  ASSERT_TRUE(dots);
  ASSERT_EQ(dots->size(), 4u);
  EXPECT_FALSE(dots->isEnabledVariablePointSize());
  EXPECT_NEAR(dots->getPoint3Df(1).z, 4.5, 1e-5);
  const auto colors = cylindersOf(scene, "poles");
  EXPECT_EQ(colors[2]->getColor_u8(), colors[3]->getColor_u8());
  EXPECT_NE(colors[0]->getColor_u8(), colors[1]->getColor_u8());
  EXPECT_NE(colors[0]->getColor_u8(), colors[2]->getColor_u8());
  const auto color = colors[1]->getColor_u8();
  EXPECT_EQ(dots->getPointColor(1).R, color.R);
  EXPECT_EQ(dots->getPointColor(1).B, color.B);
  for (const char* line : {"A small drive\n", "4 poles, coloured by detections\n",
                           "100 or more: 1\n", "3 to 9: 2\n", "1 or 2: 1\n", "grid 1 m\n"})
    EXPECT_NE(legendOf(scene).find(line), std::string::npos) << line << legendOf(scene);
  EXPECT_EQ(legendOf(scene).find("10 to 29"), std::string::npos);
}

TEST(MapScene, TheEstimateIsARibbonAlongThePath) {
  const auto box = boxOf(makeMapScene(smallDrive(0.1)), "estimate");
  EXPECT_NEAR(box.min.x, 0, 1e-6);
  EXPECT_NEAR(box.max.x, 20, 1e-6);
  EXPECT_NEAR(box.min.y, -0.4, 1e-6);
  EXPECT_NEAR(box.max.y, 0.6, 1e-6);
  EXPECT_GT(box.min.z, 0);
  EXPECT_LT(box.max.z, 0.1);
}

TEST(MapScene, TheTruthLiesAtBothSidesOfThePath) {
  MapView view = smallDrive();
  view.truth = {{0, {5, 0, M_PI / 2}}, {1, {5, 10, M_PI / 2}}};
  const auto ribbon = std::dynamic_pointer_cast<mrpt::opengl::CSetOfTriangles>(
      makeMapScene(view)->getByName("truth"));
  ASSERT_TRUE(ribbon);
  ASSERT_EQ(ribbon->getTrianglesCount(), 4u);
  for (std::size_t i = 0; i < 4; ++i)
    for (int corner = 0; corner < 3; ++corner) {
      mrpt::opengl::TTriangle triangle;
      ribbon->getTriangle(i, triangle);
      const double off = std::abs(triangle.x(corner) - 5.0);
      EXPECT_GT(off, 0.5) << "the estimate lies there";
      EXPECT_LT(off, 1.5);
    }
  view.estimate.clear();
  const auto alone = boxOf(makeMapScene(view), "truth");
  EXPECT_NEAR(alone.max.x - alone.min.x, 1, 1e-6);
}

TEST(MapScene, TruthAndEstimateAreToldApart) {
  const auto scene = makeMapScene(smallDrive());
  EXPECT_NE(scene->getByName("truth")->getColor_u8(), scene->getByName("estimate")->getColor_u8());
  EXPECT_NE(legendOf(scene).find("path of the estimate\ntrue path"), std::string::npos);
}

TEST(MapScene, DrivesAreNotJoinedAndLoopsAreBars) {
  MapView view = smallDrive(0.1);
  view.loops = {{{1, 2}, {1, 2}}, {{0, 0}, {0, 8}}};
  const auto once = makeMapScene(view);
  EXPECT_HAS(legendOf(once), "2 loops\n");
  const auto box = boxOf(once, "loops");
  EXPECT_NEAR(box.max.x - box.min.x, 5, 1e-6);  // the first has no length of its own
  EXPECT_NEAR(box.max.y, 8, 1e-6);

  const std::size_t triangles = trianglesOf(once, "estimate");
  for (const StampedPose2D& pose : smallDrive(0.1).estimate) view.estimate.push_back(pose);
  EXPECT_EQ(trianglesOf(makeMapScene(view), "estimate"), 2 * triangles);
}

TEST(MapScene, GroundReachesBeyondAllAndLiesAtZero) {
  const auto box = boxOf(makeMapScene(smallDrive()), "ground");
  EXPECT_LT(box.min.x, 0);
  EXPECT_GT(box.max.x, 20);
  EXPECT_LT(box.min.y, -6);
  EXPECT_GT(box.max.y, 6);
  EXPECT_NEAR(box.min.z, 0, 1e-6);
  EXPECT_NEAR(box.max.z, 0, 1e-6);
}

TEST(MapScene, UtmCoordinatesKeepTheirCentimetres) {
  const auto near = makeMapScene(smallDrive());
  const auto far = writtenAndRead(*makeMapScene(movedBy(smallDrive(), 448000.25, 5417000.5)));
  for (const char* name : {"ground", "truth", "estimate", "poles dots"}) {
    const auto here = boxOf(near, name), there = boxOf(far, name);
    const double most = std::string(name) == "ground" ? 1 : 1e-4;  // at whole steps of the grid
    EXPECT_NEAR(there.min.x, here.min.x + 0.25, most) << name;
    EXPECT_NEAR(there.max.y, here.max.y + 0.5, most) << name;
  }
  EXPECT_NEAR(cylindersOf(far, "poles")[1]->getPose().x, 8.25, 1e-6);
  EXPECT_NEAR(cylindersOf(far, "poles")[1]->getPose().y, -5.5, 1e-6);
  const auto &camera = far->getViewport()->getCamera(), &wanted = near->getViewport()->getCamera();
  EXPECT_NEAR(camera.getPointingAtX(), wanted.getPointingAtX() + 0.25, 1e-4);
  EXPECT_NEAR(camera.getPointingAtY(), wanted.getPointingAtY() + 0.5, 1e-4);
  EXPECT_NE(legendOf(far).find("origin: x 448000, y 5417000 m of the map"), std::string::npos);
  EXPECT_EQ(legendOf(near).find("origin"), std::string::npos);
}

TEST(MapScene, WhatIsMissingIsLeftOut) {
  MapView view = smallDrive();
  view.truth.clear();
  const auto scene = makeMapScene(view);
  EXPECT_FALSE(scene->getByName("truth"));
  EXPECT_TRUE(scene->getByName("estimate"));
  EXPECT_EQ(legendOf(scene).find("true path"), std::string::npos);
}

TEST(MapScene, TheFileHoldsStockObjectsAndComesBack) {
  const testing_apps::TempFolder folder;
  const auto file = folder / "a.3Dscene";
  scene::save(*makeMapScene(smallDrive()), file);
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  EXPECT_NE(bytes.find("CCylinder"), std::string::npos) << "the search below would find nothing";
  EXPECT_EQ(bytes.find("polemcl"), std::string::npos) << "a viewer would need the plugin";
  EXPECT_EQ(cylindersOf(writtenAndRead(*makeMapScene(smallDrive())), "poles").size(), 4u);
}

TEST(MapScene, RefusesNothingToShowAndValuesThatAreNotFinite) {
  EXPECT_THROW(makeMapScene({}), Error);
  MapView view = smallDrive();
  view.poles[2].y = HUGE_VAL;
  EXPECT_THROW(makeMapScene(view), Error);
}

TEST(MapScene, RefusesToWriteIntoAMissingFolder) {
  const auto scene = makeMapScene(smallDrive());
  EXPECT_THROW(scene::save(*scene, testing_apps::TempFolder() / "no/a.3Dscene"), Error);
}

TEST(DiffScene, EachKindInItsGroup) {
  const MapDiff diff = diffMaps({poleAt(0, 0), poleAt(10, 0), poleAt(20, 8), poleAt(25, 8)},
                                {poleAt(0, 0), poleAt(11, 0.5), poleAt(30, 4)});
  const auto scene = makeDiffScene(diff, "a to b");
  EXPECT_EQ(cylindersOf(scene, "same").size(), 1u);
  EXPECT_EQ(cylindersOf(scene, "new").size(), 1u);
  EXPECT_EQ(cylindersOf(scene, "vanished").size(), 2u);
  EXPECT_EQ(cylindersOf(scene, "moved").size(), 1u);
  for (const char* line : {"a to b\n", "1 on both maps\n", "1 new", "2 vanished", "1 moved"})
    EXPECT_NE(legendOf(scene).find(line), std::string::npos) << line << legendOf(scene);
}

TEST(DiffScene, PlacesAndHeightsAreThoseOfThePoles) {
  const auto poles = cylindersOf(makeDiffScene(diffMaps({}, {poleAt(3, 4)})), "new");
  ASSERT_EQ(poles.size(), 1u);
  EXPECT_EQ(poles[0]->getPose().x, 3);
  EXPECT_EQ(poles[0]->getPose().y, 4);
  EXPECT_EQ(poles[0]->getPose().z, 0.5);
  EXPECT_NEAR(poles[0]->getHeight(), 4, 1e-6);
}

TEST(DiffScene, UtmCoordinatesKeepTheirCentimetres) {
  const auto scene = makeDiffScene(diffMaps(
      {poleAt(448010.25, 5417000.5)}, {poleAt(448011.25, 5417000.5), poleAt(448050, 5417000)}));
  const auto moved = cylindersOf(scene, "moved");
  ASSERT_EQ(moved.size(), 1u);
  EXPECT_NEAR(moved[0]->getPose().x, 11.25, 1e-6);
  EXPECT_NEAR(moved[0]->getPose().y, 0.5, 1e-6);
  EXPECT_NEAR(boxOf(scene, "moves").min.x, 10.25, 1e-4);
  EXPECT_NEAR(boxOf(scene, "moves").max.x, 11.25, 1e-4);
  EXPECT_NE(legendOf(scene).find("x 448000, y 5417000"), std::string::npos);
}

TEST(DiffScene, RefusesNothing) {
  EXPECT_THROW(makeDiffScene({}), Error);
}

}  // namespace
}  // namespace polemcl::report::test_map_scene
