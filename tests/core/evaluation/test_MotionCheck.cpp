#include <gtest/gtest.h>

#include <cmath>

#include "core/evaluation/MotionCheck.h"
#include "support/ExpectHas.h"
#include "support/PoleStreet.h"

namespace polemcl::test_motion_check {
namespace {
using tests::Dice;

using Places = std::vector<Eigen::Vector2d>;

/// 200 scans straight on, one each 0.1 s. \param step m, between two. \param missed Share of poles.
std::vector<SessionScan> driveAlong(const Places& poles, double step, double missed, Dice& dice) {
  std::vector<SessionScan> scans;
  for (int i = 0; i < 200; ++i) {
    SessionScan scan;
    scan.time = 100 + 0.1 * i;
    scan.pose_map_robot = {step * i, 0, 0};
    for (const Eigen::Vector2d& pole : poles) {
      if (std::abs(pole.x() - step * i) > 25 || dice.uniform() < missed) continue;
      PoleDetection seen;
      seen.x = pole.x() - step * i + 0.02 * dice.normal();
      seen.y = pole.y() + 0.02 * dice.normal();
      seen.covariance = 4e-4 * Eigen::Matrix2d::Identity();
      seen.confidence = 1;
      scan.poles_robot.push_back(seen);
    }
    scans.push_back(scan);
  }
  return scans;
}

/// 100 m with poles on both sides.
std::vector<SessionScan> drive(std::uint64_t seed) {
  Dice dice(seed);
  Places poles;
  for (double x = -30; x < 130; x += dice.uniform(4, 9))
    poles.emplace_back(x, (dice.uniform() < 0.5 ? -1 : 1) * dice.uniform(4, 9));
  return driveAlong(poles, 0.5, 0.1, dice);
}

TEST(MotionCheck, AgreesWithTruePoses) {
  const MotionCheck check = checkMotion(drive(1));
  EXPECT_GE(check.told(), 45u);
  EXPECT_EQ(check.steps(), 0u);
  EXPECT_FALSE(check.contradicts());
  EXPECT_NE(check.verdict().find("the poles agree"), std::string::npos) << check.verdict();
}

TEST(MotionCheck, ThatOnlyAPartAgreesIsSaid) {
  std::vector<SessionScan> scans = drive(1);
  EXPECT_EQ(checkMotion(scans).verdict().find("a part"), std::string::npos);
  for (std::size_t i = 0; i < scans.size(); i += 24) scans[i].pose_map_robot.x += 0.2;
  const MotionCheck check = checkMotion(scans);
  EXPECT_FALSE(check.contradicts());
  EXPECT_EQ(check.verdict().rfind("the poles agree with only a part of these poses (in ", 0), 0u)
      << check.verdict();
}

TEST(MotionCheck, TellsByHowMuchTheLidarIsTurned) {
  EXPECT_EQ(checkMotion(drive(1)).mountingDoubt(), "");
  for (const double degrees : {0.6, -4.0}) {
    std::vector<SessionScan> scans = drive(1);
    for (SessionScan& scan : scans) scan.pose_map_robot.yaw -= degrees * M_PI / 180;
    const std::string text = checkMotion(scans).mountingDoubt();
    EXPECT_HAS(text, degrees > 0 ? "farther left than its pose" : "farther right than its pose");
    const double told = std::stod(text.substr(text.find("points ") + 7));
    EXPECT_NEAR(told, std::abs(degrees), 0.1) << text;
  }
}

/// In a long bend, a LiDAR 1.5 m ahead of where it is said to stand drifts to one side as well.
TEST(MotionCheck, ALidarFartherAheadIsNotCalledTurned) {
  std::vector<SessionScan> scans = drive(1);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Pose2D heading{0, 0, 0.003 * static_cast<double>(i)};
    for (PoleDetection& pole : scans[i].poles_robot) {
      const Pose2D turned = relative(heading, {pole.x, pole.y, 0});
      pole.x = turned.x;
      pole.y = turned.y;
    }
    scans[i].pose_map_robot =
        compose(compose(scans[i].pose_map_robot, heading), Pose2D{-1.5, 0, 0});
  }
  EXPECT_EQ(checkMotion(scans).mountingDoubt(), "");
}

TEST(MotionCheck, TellsAStepAndWhereItIs) {
  for (const Pose2D& step : {Pose2D{0.5, 0, 0}, Pose2D{0, 1.5, 0}, Pose2D{-4, 3, 0}})
    for (const std::size_t at : {2, 101, 104, 195}) {
      SCOPED_TRACE(testing::Message() << step.x << ' ' << step.y << " at " << at);
      std::vector<SessionScan> scans = drive(2);
      for (std::size_t i = at; i < scans.size(); ++i) {
        scans[i].pose_map_robot.x += step.x;
        scans[i].pose_map_robot.y += step.y;
      }
      const MotionCheck check = checkMotion(scans);
      EXPECT_EQ(check.steps(), 1u);
      EXPECT_TRUE(check.contradicts());
      const double end = 100 + 0.4 * std::ceil(static_cast<double>(at) / 4);
      char time[64], share[64];
      std::snprintf(time, sizeof time, "most before %.3f s, by ", end);
      std::snprintf(share, sizeof share, "in 1 of %zu stretches", check.told());
      for (const char* part : {time, share})
        EXPECT_NE(check.verdict().find(part), std::string::npos) << check.verdict();
    }
}

/// The scans 100 and 104 tell the step, those beside them confirm it.
TEST(MotionCheck, ScansWithFewPolesDoNotDenyAStep) {
  const auto steps = [](const std::vector<std::size_t>& poor) {
    std::vector<SessionScan> scans = drive(4);
    for (std::size_t i = 101; i < scans.size(); ++i) scans[i].pose_map_robot.x += 0.5;
    for (const std::size_t i : poor) scans[i].poles_robot.resize(3);
    return checkMotion(scans).steps();
  };
  EXPECT_EQ(steps({}), 1u);
  EXPECT_EQ(steps({99}), 1u);
  EXPECT_EQ(steps({98, 99, 105}), 1u);
  EXPECT_EQ(steps({97, 98, 99}), 1u) << "one side is enough";
  EXPECT_EQ(steps({105, 106, 107}), 1u);
  EXPECT_EQ(steps({97, 98, 99, 105, 106, 107}), 0u) << "nothing confirms it";
}

/// The posts of a rail, half of them seen: the row fits as well, or better, a post farther on.
TEST(MotionCheck, ARowOfPostsIsNoStep) {
  for (const double distance : {2.0, 4.0})
    for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
      Dice dice(seed);
      Places row;
      for (double x = -30; x < 430; x += distance) row.emplace_back(x, -6);
      const MotionCheck check = checkMotion(driveAlong(row, 2, 0.7, dice));
      EXPECT_EQ(check.steps(), 0u) << distance << ' ' << seed;
    }
}

/// One scan whose poles are paired wrongly is no step.
TEST(MotionCheck, WhatOtherScansDoNotConfirmIsNoStep) {
  std::vector<SessionScan> scans = drive(3);
  for (PoleDetection& seen : scans[100].poles_robot) seen.x += 0.7;
  const MotionCheck check = checkMotion(scans);
  const std::string all = std::to_string(check.told());
  EXPECT_EQ(check.verdict().find("in " + all + " of " + all), std::string::npos);
  EXPECT_EQ(check.steps(), 0u);
  EXPECT_FALSE(check.contradicts());
}

}  // namespace
}  // namespace polemcl::test_motion_check
