#include <gtest/gtest.h>

#include <limits>

#include "core/common/PoleIndex.h"
#include "core/common/Transform.h"
#include "core/localization/RivalPose.h"
#include "support/Poles.h"

namespace polemcl::test_rival_pose {
namespace {

using namespace polemcl::tests;

const AssociationOptions kExact{0.05, 3.5, 1.0};

/// Poles all round a robot at (100, 50), heading 1 rad.
const Pose2D kRobot{100, 50, 1};
const double kCentres[][2] = {{8, 3},    {14, -6}, {25, 9},   {-7, 4},
                              {-12, -8}, {-21, 2}, {-30, 11}, {9, 4.5}};

/// What the robot sees of them, but for the last; those behind from a LiDAR that has moved.
std::vector<PoleDetection> seenWith(const Pose2D& motion, std::size_t count = 7) {
  std::vector<PoleDetection> poles;
  for (std::size_t i = 0; i < count; ++i) {
    const PoleDetection pole = detectionAt(kCentres[i][0], kCentres[i][1], 4e-4);
    poles.push_back(pole.x < 0 ? moved(motion, pole) : pole);
  }
  return poles;
}

RivalPose rivalOf(const std::vector<PoleDetection>& poles_robot) {
  std::vector<MapPole> map;
  for (const auto& centre : kCentres) {
    const Pose2D at = compose(kRobot, {centre[0], centre[1], 0});
    map.push_back(mapPoleAt(at.x, at.y, 4e-4));
  }
  const PoleIndex index(map);
  PoseWithCovariance robot;
  robot.mean = kRobot;
  return findRival(poles_robot, associate(poles_robot, robot, index, kExact), kRobot, index,
                   kExact);
}

TEST(RivalPose, IsThatOfALidarThatHasMoved) {
  const Pose2D motion{0.3, -0.4, 0.05};
  const RivalPose rival = rivalOf(seenWith(motion));
  EXPECT_EQ(rival.poles, (std::vector<std::size_t>{3, 4, 5, 6}));
  const Pose2D none = compose(rival.motion, motion);
  EXPECT_NEAR(none.x, 0, 1e-6);
  EXPECT_NEAR(none.y, 0, 1e-6);
  EXPECT_NEAR(none.yaw, 0, 1e-6);
}

TEST(RivalPose, NeedsPolesWithoutAMatchOnBothSides) {
  EXPECT_TRUE(rivalOf(seenWith({})).poles.empty());                    // all match
  EXPECT_TRUE(rivalOf(seenWith({0.3, -0.4, 0.05}, 4)).poles.empty());  // one does not
  EXPECT_TRUE(rivalOf({}).poles.empty());
  // Two detections of each pole ahead: the second has no match, but the pole of the map has one.
  auto twice = seenWith({}, 3);
  for (std::size_t i = 0; i < 3; ++i) {
    twice.push_back(twice[i]);
    twice.back().x += 0.3;
  }
  EXPECT_TRUE(rivalOf(twice).poles.empty());
  const Pose2D motion{0.3, -0.4, 0.05};
  auto both = seenWith(motion);
  both.push_back(moved(motion, both[0]));
  EXPECT_EQ(rivalOf(both).poles, (std::vector<std::size_t>{3, 4, 5, 6}));
}

TEST(RivalPose, LiesNearTheEstimateButNotAtIt) {
  const auto count = [](const Pose2D& motion) { return rivalOf(seenWith(motion)).poles.size(); };
  EXPECT_EQ(count({1.2, 0.8, 0}), 4u);  // 1.44 m
  EXPECT_LT(count({1.3, 0.9, 0}), 3u);  // 1.58 m
  EXPECT_EQ(count({0, 0, 0.11}), 4u);
  EXPECT_LT(count({0, 0, 0.13}), 3u);
  EXPECT_EQ(count({0, 0.22, 0}), 4u);
  EXPECT_EQ(count({0, 0.14, 0}), 0u);
}

TEST(RivalPose, DetectionsWithoutConfidenceOrValueDoNotCount) {
  auto poles = seenWith({0.3, -0.4, 0.05});
  poles[3].confidence = 0;
  poles[4].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(rivalOf(poles).poles, (std::vector<std::size_t>{5, 6}));
}

// The search takes 24 poles of the map: the nearest, wherever they stand in the file.
TEST(RivalPose, IsFoundAmongManyPolesOfTheMap) {
  std::vector<MapPole> map;
  for (int i = 0; i < 60; ++i) map.push_back(mapPoleAt(-12 - 0.02 * i, 14 + 0.1 * i, 4e-4));
  for (const auto& centre : kCentres) map.push_back(mapPoleAt(centre[0], centre[1], 4e-4));
  const PoleIndex index(map);
  const auto poles = seenWith({0.3, -0.4, 0.05});
  EXPECT_EQ(findRival(poles, associate(poles, {}, index, kExact), {}, index, kExact).poles.size(),
            4u);
}

}  // namespace
}  // namespace polemcl::test_rival_pose
