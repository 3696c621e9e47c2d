#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/common/PoleIndex.h"
#include "core/common/Transform.h"
#include "core/localization/MapAssociation.h"
#include "support/Poles.h"

namespace polemcl::test_map_association {

using namespace polemcl::tests;

namespace {

MapPole mapPole(double x, double y, double sigma) {
  return mapPoleAt(x, y, sigma * sigma);
}

PoleDetection detection(double x, double y, double sigma, double confidence = 1) {
  PoleDetection pole = detectionAt(x, y, sigma * sigma);
  pole.confidence = confidence;
  return pole;
}

const AssociationOptions kExact{0.05, 3.5, 1.0};

}  // namespace

TEST(MapAssociation, SquaredDistanceAddsUpAllCovariances) {
  const PoleIndex index({mapPole(10, 0, 0.04)});
  PoseWithCovariance robot;
  robot.covariance = Eigen::Vector3d(0.01, 0.0025, 1e-4).asDiagonal();
  const auto matches = associate({detection(10.1, 0.2, 0.03, 0.7)}, robot, index, kExact);
  ASSERT_EQ(matches.size(), 1u);
  EXPECT_TRUE(matches[0].matched);
  EXPECT_EQ(matches[0].confidence, 0.7);
  // By hand: heading moves the pole by (-0.2, 10.1) m per rad.
  const double common = 0.04 * 0.04 + 0.03 * 0.03 + 0.05 * 0.05;
  const double xx = common + 0.01 + 1e-4 * 0.04, yy = common + 0.0025 + 1e-4 * 10.1 * 10.1,
               xy = -1e-4 * 0.2 * 10.1;
  const double determinant = xx * yy - xy * xy;
  const double expected = (0.01 * yy - 2 * 0.1 * 0.2 * xy + 0.04 * xx) / determinant;
  EXPECT_NEAR(matches[0].squared, expected, 1e-12);
}

TEST(MapAssociation, TurnsDetectionsAndTheirCovariances) {
  const PoleIndex index({mapPole(3, 7, 0)});
  PoseWithCovariance robot;
  robot.mean = {3, 2, M_PI / 2};  // ahead is +y
  PoleDetection seen = detection(5.2, 0, 0.1);
  seen.covariance << 0.04, 0, 0, 0.0001;  // uncertain ahead
  const auto matches = associate({seen}, robot, index, kExact);
  EXPECT_NEAR(matches[0].squared, 0.04 / (0.04 + 0.0025), 1e-12);
}

TEST(MapAssociation, EachMapPoleCountsOnceAndTheNearerPairWins) {
  const PoleIndex index({mapPole(5, 0, 0.1), mapPole(5.4, 0, 0.1)});
  const auto matches =
      associate({detection(5.15, 0, 0.1), detection(5.01, 0, 0.1)}, {}, index, kExact);
  EXPECT_TRUE(matches[0].matched);
  EXPECT_EQ(matches[0].pole, 1u);  // the first map pole is taken by the second detection
  EXPECT_TRUE(matches[1].matched);
  EXPECT_EQ(matches[1].pole, 0u);
  const auto lone = associate({detection(5.05, 0, 0.1)}, {}, index, kExact);
  EXPECT_EQ(lone[0].pole, 0u);  // both are within reach
  EXPECT_NEAR(lone[0].squared, 0.05 * 0.05 / (0.1 * 0.1 + 0.1 * 0.1 + 0.05 * 0.05), 1e-12);
  const auto crowd = associate({detection(5.01, 0, 0.1), detection(5.02, 0, 0.1)}, {},
                               PoleIndex({mapPole(5, 0, 0.1)}), kExact);
  EXPECT_TRUE(crowd[0].matched);
  EXPECT_FALSE(crowd[1].matched);
}

TEST(MapAssociation, NothingBeyondTheGateOrTheReach) {
  const PoleIndex index({mapPole(5, 0, 0)});
  const AssociationOptions tight{0.1, 2, 1};
  EXPECT_TRUE(associate({detection(5.19, 0, 0)}, {}, index, tight)[0].matched);
  EXPECT_FALSE(associate({detection(5.21, 0, 0)}, {}, index, tight)[0].matched);
  PoseWithCovariance vague;
  vague.covariance = 100 * Eigen::Matrix3d::Identity();
  EXPECT_TRUE(associate({detection(5.9, 0, 0)}, vague, index, tight)[0].matched);
  EXPECT_FALSE(associate({detection(6.1, 0, 0)}, vague, index, tight)[0].matched);
}

TEST(MapAssociation, WhatIsNotFiniteMatchesNothing) {
  const PoleIndex index({mapPole(0, 0, 0.1)});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(associate({detection(nan, 0, 0.1)}, {}, index, kExact)[0].matched);
  EXPECT_FALSE(associate({detection(0, 0, nan)}, {}, index, kExact)[0].matched);
  EXPECT_TRUE(associate({}, {}, index, kExact).empty());
}

namespace {

/// Poles all round a robot at (100, 50), heading 1 rad.
const Pose2D kRobot{100, 50, 1};
const double kCentres[][2] = {{8, 3}, {14, -6}, {25, 9}, {-7, 4}, {-12, -8}, {-21, 2}, {-30, 11}};

/// What the robot sees of them; those behind from a LiDAR that has moved.
std::vector<PoleDetection> seenWith(const Pose2D& motion, std::size_t count = 7) {
  std::vector<PoleDetection> poles;
  for (std::size_t i = 0; i < count; ++i) {
    const PoleDetection pole = detection(kCentres[i][0], kCentres[i][1], 0.02);
    poles.push_back(pole.x < 0 ? moved(motion, pole) : pole);
  }
  return poles;
}

RivalPose rivalOf(const std::vector<PoleDetection>& poles_robot) {
  std::vector<MapPole> map;
  for (const auto& centre : kCentres) {
    const Pose2D at = compose(kRobot, {centre[0], centre[1], 0});
    map.push_back(mapPole(at.x, at.y, 0.02));
  }
  const PoleIndex index(map);
  PoseWithCovariance robot;
  robot.mean = kRobot;
  return findRival(poles_robot, associate(poles_robot, robot, index, kExact), kRobot, index,
                   kExact);
}

}  // namespace

TEST(RivalPose, IsThatOfALidarThatHasMoved) {
  const Pose2D motion{0.3, -0.4, 0.05};
  const RivalPose rival = rivalOf(seenWith(motion));
  EXPECT_EQ(rival.pairs, 4);
  const Pose2D back = compose(motion, rival.motion);  // map = rival (motion (map))
  const Pose2D other = compose(rival.motion, motion);
  EXPECT_NEAR(other.x, 0, 1e-6);
  EXPECT_NEAR(other.y, 0, 1e-6);
  EXPECT_NEAR(back.yaw, 0, 1e-6);
}

TEST(RivalPose, NeedsPolesWithoutAMatchOnBothSides) {
  EXPECT_EQ(rivalOf(seenWith({})).pairs, 0);                    // all match
  EXPECT_EQ(rivalOf(seenWith({0.3, -0.4, 0.05}, 4)).pairs, 0);  // one does not
  EXPECT_EQ(rivalOf({}).pairs, 0);
  // Two detections of each pole ahead: the second has no match, but the pole of the map has one.
  auto twice = seenWith({}, 3);
  for (std::size_t i = 0; i < 3; ++i) {
    twice.push_back(twice[i]);
    twice.back().x += 0.1;
  }
  EXPECT_EQ(rivalOf(twice).pairs, 0);
}

TEST(RivalPose, LiesNearTheEstimate) {
  EXPECT_EQ(rivalOf(seenWith({1.2, 0.8, 0})).pairs, 4);  // 1.44 m
  EXPECT_LT(rivalOf(seenWith({1.3, 0.9, 0})).pairs, 3);  // 1.58 m
  EXPECT_EQ(rivalOf(seenWith({0, 0, 0.11})).pairs, 4);
  EXPECT_LT(rivalOf(seenWith({0, 0, 0.13})).pairs, 3);
}

TEST(RivalPose, DetectionsWithoutConfidenceOrValueDoNotCount) {
  auto poles = seenWith({0.3, -0.4, 0.05});
  poles[3].confidence = 0;
  poles[4].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(rivalOf(poles).pairs, 2);
}

}  // namespace polemcl::test_map_association
