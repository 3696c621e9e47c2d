#include <gtest/gtest.h>
#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfTriangles.h>
#include <mrpt/opengl/CText.h>

#include <Eigen/LU>
#include <fstream>
#include <iterator>

#include "mrpt/drawing/SceneParts.h"
#include "report/scene/LiveObjects.h"
#include "report/scene/LiveScene.h"
#include "support/LiveMoments.h"
#include "support/Scenes.h"
#include "support/TempFolder.h"

namespace polemcl::report::test_live_scene {
namespace {
std::string shareOf(const mrpt::opengl::CRenderizable& object) {
  const auto* text = dynamic_cast<const mrpt::opengl::CText*>(&object);
  return text ? text->getString() : "no text";
}

std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(LiveScene, ShowsTheMapAndWhatWasObservedWhereItStands) {
  LiveScene scene(smallMap(), "drive");
  scene.show(knownMoment());
  ASSERT_EQ(cylindersOf(scene.scene(), "map").size(), 4u);
  EXPECT_NEAR(cylindersOf(scene.scene(), "map")[1]->getPose().x, 20, 1e-6);
  const auto matched = cylindersOf(scene.scene(), "matched"),
             unmatched = cylindersOf(scene.scene(), "unmatched");
  ASSERT_EQ(matched.size(), 1u);  // robot (-5, -10), turned by 90 degrees, from (10, 0)
  EXPECT_NEAR(matched[0]->getPose().x, 20, 1e-6);
  EXPECT_NEAR(matched[0]->getPose().y, -5, 1e-6);
  EXPECT_NEAR(matched[0]->getBoundingBox().max.z, 3, 1e-4);
  ASSERT_EQ(unmatched.size(), 1u);
  EXPECT_NEAR(unmatched[0]->getPose().x, 10, 1e-6);
  EXPECT_NEAR(unmatched[0]->getPose().y, 3, 1e-6);
  EXPECT_NE(matched[0]->getColor_u8(), unmatched[0]->getColor_u8());
  EXPECT_NE(matched[0]->getColor_u8(), cylindersOf(scene.scene(), "map")[0]->getColor_u8());
}

TEST(LiveScene, HeavyParticlesAreDarkAndOnTop) {
  LiveScene scene(smallMap(), "");
  scene.show(knownMoment());
  const auto points = std::dynamic_pointer_cast<mrpt::opengl::CPointCloudColoured>(
      scene.scene()->getViewport()->getByName("particles"));
  ASSERT_TRUE(points);
  ASSERT_EQ(points->size(), 3u);
  EXPECT_NEAR(points->getPoint3Df(0).x, 9.9, 1e-5);  // drawn first
  EXPECT_NEAR(points->getPoint3Df(2).x, 10, 1e-5);
  const auto brightness = [&](std::size_t i) {
    const auto color = points->getPointColor(i);
    return color.R + color.G + color.B;
  };
  EXPECT_GT(brightness(0), brightness(1));
  EXPECT_GT(brightness(1), brightness(2));
}

TEST(LiveScene, TheEllipseHolds95PercentOfAGaussian) {
  PoseWithCovariance pose{{3, 4, 0}, Eigen::Matrix3d::Zero()};
  pose.covariance.topLeftCorner<2, 2>() << 4, 1, 1, 2;
  const auto corners = ellipse95(pose, 24);
  ASSERT_EQ(corners.size(), 25u);
  EXPECT_EQ(corners.front(), corners.back());
  const Eigen::Matrix2d information = pose.covariance.topLeftCorner<2, 2>().inverse();
  for (const auto& corner : corners) {
    const Eigen::Vector2d off = corner - Eigen::Vector2d(3, 4);
    EXPECT_NEAR(off.dot(information * off), 5.991, 1e-3);  // of chi square, table
  }
  pose.covariance.setZero();
  for (const auto& corner : ellipse95(pose)) EXPECT_EQ(corner, Eigen::Vector2d(3, 4));
}

TEST(LiveScene, WayAndVehicleLieWhereTheEstimateWasAndIs) {
  LiveScene scene(smallMap(), "");
  scene.show(knownMoment());
  const auto way = boxOf(scene.scene(), "way"), vehicle = boxOf(scene.scene(), "vehicle");
  EXPECT_NEAR(way.min.x, 8, 1e-4);
  EXPECT_NEAR(way.max.x, 10, 1e-4);
  EXPECT_NEAR(vehicle.max.y, 1.5, 1e-4);  // 3 m long, along +y
  EXPECT_NEAR(vehicle.min.y, -1.5, 1e-4);
  EXPECT_NEAR((vehicle.min.x + vehicle.max.x) / 2, 10, 1e-4);
}

TEST(LiveScene, AJumpLeavesNoLine) {
  LiveMoment moment = knownMoment();
  moment.way = {{8, 0, false}, {9, 0, true}, {500, 0, false}};
  LiveScene scene(smallMap(), "");
  scene.show(moment);
  EXPECT_NEAR(boxOf(scene.scene(), "way").max.x, 9, 1e-4);
}

TEST(LiveScene, ThePathHasTheColoursOfHealth) {
  LiveMoment moment = knownMoment();
  moment.way = {{0, 0, false},
                {1, 0, true},
                {2, 0, true, HealthState::degraded},
                {3, 0, true, HealthState::lost},
                {9, 9, false},
                {9, 8, true}};
  LiveScene scene(smallMap(), "");
  scene.show(moment);
  const auto way = std::dynamic_pointer_cast<mrpt::opengl::CSetOfTriangles>(
      scene.scene()->getViewport()->getByName("way"));
  ASSERT_TRUE(way);
  ASSERT_EQ(way->getTrianglesCount(), 8u);  // two for each metre, none over the jump
  const HealthState states[] = {HealthState::ok, HealthState::degraded, HealthState::lost,
                                HealthState::ok};
  for (std::size_t i = 0; i < 8; ++i) {
    mrpt::opengl::TTriangle face;
    way->getTriangle(i, face);
    const auto color = live::pathColorOf(states[i / 2]);
    EXPECT_EQ(face.vertices[0].xyzrgba.r, color.R) << i;
    EXPECT_EQ(face.vertices[0].xyzrgba.g, color.G) << i;
    EXPECT_NEAR(face.vertices[0].xyzrgba.pt.x, i < 6 ? i / 2 : 9, 0.4) << i;
  }
}

TEST(LiveScene, TheTruthIsThereWhenItIsKnown) {
  LiveMoment moment = knownMoment();
  LiveScene scene(smallMap(), "");
  scene.show(moment);
  EXPECT_FALSE(scene.scene()->getViewport()->getByName("true_way"));
  EXPECT_EQ(legendOf(scene.scene()).find("true path"), std::string::npos);
  moment.truth = Pose2D{10.3, 0.4, M_PI / 2 - 0.1};
  moment.trueWay = {{8.3, 0.4, false}, {10.3, 0.4, true}};
  scene.show(moment);
  EXPECT_NEAR(boxOf(scene.scene(), "true_way").min.x, 8.3, 1e-4);
  EXPECT_NEAR(boxOf(scene.scene(), "true_way").max.x, 10.3, 1e-4);
  const auto arrow = boxOf(scene.scene(), "true_vehicle");
  EXPECT_NEAR((arrow.min.x + arrow.max.x) / 2, 10.3, 0.1);
  EXPECT_NE(legendOf(scene.scene()).find("true path"), std::string::npos);
  EXPECT_NE(legendOf(scene.scene()).find("error 0.500 m, 5.73 deg"), std::string::npos);
}

TEST(LiveScene, ThePointsOfTheScanStandAtTheEstimate) {
  LiveMoment moment = knownMoment();  // at (10, 0), looking along +y
  moment.points_robot = {{2, 1, 0.1f}, {2, 1, 4}};
  LiveScene scene(smallMap(), "");
  scene.show(moment);
  const auto points = std::dynamic_pointer_cast<mrpt::opengl::CPointCloudColoured>(
      scene.scene()->getViewport()->getByName("points"));
  ASSERT_TRUE(points);
  ASSERT_EQ(points->size(), 2u);
  EXPECT_NEAR(points->getPoint3Df(1).x, 9, 1e-5);
  EXPECT_NEAR(points->getPoint3Df(1).y, 2, 1e-5);
  EXPECT_NEAR(points->getPoint3Df(1).z, 4, 1e-5);
  EXPECT_GT(points->getPointColor(0).R, points->getPointColor(1).R);  // high ones are darker
}

TEST(LiveScene, WithoutAPoseItShowsThePlacesSupposedAndTheWholeMap) {
  LiveScene scene(smallMap(), "drive");
  scene.show(knownMoment());
  scene.show(searchingMoment());
  for (const char* gone : {"vehicle", "ellipse", "particles", "matched", "unmatched", "way"})
    EXPECT_FALSE(scene.scene()->getViewport()->getByName(gone)) << gone;
  EXPECT_TRUE(scene.scene()->getViewport("close")->empty());
  const auto places = std::dynamic_pointer_cast<mrpt::opengl::CSetOfObjects>(
      scene.scene()->getViewport()->getByName("hypotheses"));
  ASSERT_TRUE(places);
  ASSERT_EQ(places->size(), 4u);  // two arrows, each with its share
  EXPECT_EQ(shareOf(**(places->begin() + 1)), "90%");
  EXPECT_NEAR((*(places->begin() + 1))->getPose().x, 20, 1e-6);
  EXPECT_EQ(shareOf(**(places->begin() + 3)), "10%");
  EXPECT_NEAR((*(places->begin() + 3))->getPose().x, 40, 1e-6);
  EXPECT_NEAR(scene.camera().getPointingAtX(), 30, 1e-3);
  EXPECT_GT(scene.camera().getZoomDistance(), 60);
  EXPECT_NE(legendOf(scene.scene()).find("lost: searching"), std::string::npos);
  EXPECT_NE(legendOf(scene.scene()).find("observed poles 3, places 2"), std::string::npos);
}

TEST(LiveScene, TheTextTellsTheHealth) {
  LiveScene scene(smallMap(), "the drive");
  LiveMoment moment = knownMoment();
  scene.show(moment);
  std::string text = legendOf(scene.scene());
  for (const char* part :
       {"ok\n", "the drive\n", "time 1.2 s, scan 12\n", "matched 75 %, now 1 of 2\n",
        "spread 0.100 m", "particles 3, effective 2\n", "10.00 0.00 m, 90.0 deg"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " is not in:\n" << text;
  moment.health.state = HealthState::degraded;
  moment.health.reason = HealthReason::noPoles;
  scene.show(moment);
  text = legendOf(scene.scene());
  EXPECT_NE(text.find(std::string("degraded: ") + name(HealthReason::noPoles)), std::string::npos);
  EXPECT_EQ(text.find("degraded"), 0u);  // the first line
  EXPECT_EQ(text.find("found by the search"), std::string::npos);
  moment.relocalized = true;
  scene.show(moment);
  EXPECT_NE(legendOf(scene.scene()).find("found by the search"), std::string::npos);
}

TEST(LiveScene, TheCameraFollowsFromBehindAndTurnsGently) {
  LiveScene scene(smallMap(), "");
  LiveMoment moment = knownMoment();
  scene.show(moment);
  EXPECT_NEAR(scene.camera().getAzimuthDegrees(), 270, 1e-3);  // it stands at -y
  EXPECT_NEAR(scene.camera().getPointingAtX(), 10, 1e-3);
  EXPECT_GT(scene.camera().getPointingAtY(), 5);
  moment.estimate->mean.yaw = 0;
  scene.show(moment);  // turned on the spot
  EXPECT_NEAR(scene.camera().getAzimuthDegrees(), 270, 1e-3);
  moment.estimate->mean.x += 3;
  scene.show(moment);
  EXPECT_LT(scene.camera().getAzimuthDegrees(), 260);
  EXPECT_GT(scene.camera().getAzimuthDegrees(), 190);
}

TEST(LiveScene, ViewersTakeItsCamera) {
  LiveScene scene(smallMap(), "");
  scene.show(knownMoment());
  EXPECT_TRUE(scene.scene()->followCamera());
}

TEST(LiveScene, MapsInUtmKeepTheirCentimetres) {
  auto map = smallMap();
  for (MapPole& pole : map) pole.x += 352000.25, pole.y += 4027000.5;
  LiveMoment moment = knownMoment();
  moment.estimate->mean.x += 352000.25, moment.estimate->mean.y += 4027000.5;
  for (Pose2D& particle : moment.particles) particle.x += 352000.25, particle.y += 4027000.5;
  for (WayPoint& point : moment.way) point.x += 352000.25, point.y += 4027000.5;
  LiveScene near(smallMap(), "drive"), far(map, "drive");
  near.show(knownMoment());
  far.show(moment);
  for (const char* name : {"way", "vehicle", "ellipse", "particles"}) {
    EXPECT_NEAR(boxOf(far.scene(), name).min.x, boxOf(near.scene(), name).min.x + 0.25, 1e-3)
        << name;
    EXPECT_NEAR(boxOf(far.scene(), name).max.y, boxOf(near.scene(), name).max.y + 0.5, 1e-3)
        << name;
  }
  EXPECT_NEAR(cylindersOf(far.scene(), "map")[1]->getPose().x, 20.25, 1e-4);
  EXPECT_NEAR(cylindersOf(far.scene(), "matched")[0]->getPose().y, -4.5, 1e-4);
  EXPECT_NE(legendOf(far.scene()).find("x 352000, y 4027000"), std::string::npos);
}

TEST(LiveScene, TheFileHoldsStockObjectsAndComesBack) {
  const testing_apps::TempFolder folder;
  LiveScene scene(smallMap(), "drive");
  scene.show(knownMoment());
  polemcl::scene::save(*scene.scene(), folder / "a.3Dscene");
  EXPECT_EQ(bytesOf(folder / "a.3Dscene").find("polemcl"), std::string::npos);
  mrpt::opengl::COpenGLScene loaded;
  ASSERT_TRUE(loaded.loadFromFile((folder / "a.3Dscene").string()));
  for (const char* name :
       {"ground", "map", "way", "vehicle", "ellipse", "particles", "matched", "unmatched"})
    EXPECT_TRUE(loaded.getViewport()->getByName(name)) << name;
  EXPECT_FALSE(loaded.getViewport("text")->getTextMessages().messages.empty());
}

TEST(LiveScene, RefusesAMapWithoutPoles) {
  EXPECT_THROW(LiveScene({}, ""), Error);
}

TEST(LiveMoment, TheWayIsThinnedAndBrokenWhereTheEstimateJumps) {
  Way way;
  LocalizationUpdate update;
  way.add(update);  // no pose yet
  EXPECT_TRUE(way.points().empty());
  const auto at = [&](double x) {
    update.estimate = PoseWithCovariance{{x, 0, 0}, Eigen::Matrix3d::Identity()};
    way.add(update);
  };
  for (int i = 0; i <= 100; ++i) at(0.125 * i);  // 12.5 m
  ASSERT_EQ(way.points().size(), 14u);           // every metre, and where it is now
  EXPECT_EQ(way.points()[3].x, 3);
  EXPECT_EQ(way.points().back().x, 12.5);
  EXPECT_FALSE(way.points()[0].joined);
  EXPECT_TRUE(way.points()[1].joined);
  update.relocalized = true;
  at(100);
  update.relocalized = false;
  EXPECT_EQ(way.points().size(), 15u);
  EXPECT_FALSE(way.points().back().joined);
  at(100.1);
  EXPECT_EQ(way.points().size(), 16u);
  at(100.2);
  EXPECT_EQ(way.points().size(), 16u);
}

}  // namespace
}  // namespace polemcl::report::test_live_scene
