#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/common/PoleIndex.h"
#include "core/localization/MapAssociation.h"
#include "support/Poles.h"

namespace polemcl::test_map_association {
namespace {

using namespace polemcl::tests;

MapPole mapPole(double x, double y, double sigma) {
  return mapPoleAt(x, y, sigma * sigma);
}

PoleDetection detection(double x, double y, double sigma, double confidence = 1) {
  PoleDetection pole = detectionAt(x, y, sigma * sigma);
  pole.confidence = confidence;
  return pole;
}

const AssociationOptions kExact{0.05, 3.5, 1.0};

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

TEST(MapAssociation, NearPolesAreThoseThatTheScanCouldSee) {
  // The robot at (100, 0) faces +y; its sensor stands 2 m ahead, at (100, 2).
  const std::vector<MapPole> poles{mapPole(100, 12, 0.1), mapPole(90, 2, 0.1),
                                   mapPole(100, -15, 0.1), mapPole(100, 21, 0.1),
                                   mapPole(125, 0, 0.1)};
  const PoleIndex index(poles);
  PoleScan scan;
  scan.pose_robot_sensor = {2, 0, 0};
  scan.poles_robot = {detection(12, 0, 0.1, 0.5), detection(0, 10, 0.1, 0.25),
                      detection(25, 0, 0.1, 1)};
  std::vector<PoleMatch> matches(3);
  for (std::size_t i = 0; i < 3; ++i) matches[i].confidence = scan.poles_robot[i].confidence;
  matches[0].matched = matches[2].matched = true;
  const Pose2D robot{100, 0, M_PI / 2};
  NearPoles near = nearPoles(scan, matches, robot, index, poles);
  EXPECT_EQ(near.seen, 0.75) << "one is farther than 20 m";
  EXPECT_EQ(near.matched, 0.5);
  EXPECT_EQ(near.expected, 3) << "two are farther than 20 m";
  scan.visibilityRange.assign(256, 50);
  for (std::size_t i = 120; i < 136; ++i) scan.visibilityRange[i] = 8;  // a wall 8 m ahead
  near = nearPoles(scan, matches, robot, index, poles);
  EXPECT_EQ(near.expected, 2) << "one stands behind the wall";
}

}  // namespace
}  // namespace polemcl::test_map_association
