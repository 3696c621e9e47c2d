#include <gtest/gtest.h>

#include <cmath>

#include <polemcl/core/common/Types.h>
#include "core/common/Angles.h"
#include "sim/drive/Drive.h"

namespace polemcl::test_drive {
namespace {

using namespace polemcl::sim;

Pose2D planar(const Eigen::Isometry3d& pose) {
  return {pose.translation().x(), pose.translation().y(),
          std::atan2(pose.linear()(1, 0), pose.linear()(0, 0))};
}
TEST(Drive, KeepsSpacingTimeHeightAndUprightness) {
  SimulationOptions options;
  options.height = 1.7;
  const World world = makeWorld(options.world);
  const Drive drive = makeDrive(world, options);
  ASSERT_EQ(drive.time.size(), drive.T_map_sensor.size());
  ASSERT_EQ(drive.odometry.size() + 1, drive.time.size());
  EXPECT_EQ(drive.time.size(), 597u) << "298 m at 0.5 m";
  for (std::size_t i = 0; i < drive.time.size(); ++i) {
    EXPECT_NEAR(drive.time[i], 0.1 * static_cast<double>(i), 1e-9);
    const Eigen::Isometry3d& pose = drive.T_map_sensor[i];
    const double ground = world.terrain().height(pose.translation().x(), pose.translation().y());
    EXPECT_NEAR(pose.translation().z() - ground, 1.7, 0.06);
    EXPECT_GT(pose.linear()(2, 2), std::cos(0.1));
    EXPECT_LT(world.terrain().edge(pose.translation().x(), pose.translation().y()), -1.2)
        << "on the road";
    if (i == 0) continue;
    const Pose2D step = relative(planar(drive.T_map_sensor[i - 1]), planar(pose));
    EXPECT_NEAR(std::hypot(step.x, step.y), 0.5, 0.03);
    EXPECT_LT(std::abs(std::atan2(step.y, step.x)), 0.05) << "it drives where it looks";
  }
}

TEST(Drive, OdometryIsTheTrueMotionWithNoiseOfTheGivenShare) {
  SimulationOptions options;
  options.world.length = 1000;
  options.odometryNoise = 0.05;
  const Drive drive = makeDrive(makeWorld(options.world), options);
  double square = 0;
  for (std::size_t i = 0; i < drive.odometry.size(); ++i) {
    const Pose2D step = relative(planar(drive.T_map_sensor[i]), planar(drive.T_map_sensor[i + 1]));
    const OdometryStep& odometry = drive.odometry[i];
    EXPECT_NEAR(odometry.sx, 0.05 * std::abs(step.x), 1e-12);
    EXPECT_NEAR(odometry.syaw, 0.05 * std::abs(step.yaw), 1e-12);
    square += std::pow((odometry.dx - step.x) / odometry.sx, 2);
    EXPECT_LE(std::abs(odometry.dy - step.y), 5 * odometry.sy);
    EXPECT_LE(std::abs(odometry.dyaw - step.yaw), 5 * odometry.syaw);
  }
  EXPECT_NEAR(square / static_cast<double>(drive.odometry.size()), 1, 0.12);
}

TEST(Drive, AnotherDayDrivesAnotherLineOnTheSameRoad) {
  SimulationOptions options;
  const Drive today = makeDrive(makeWorld(options.world), options);
  options.world.day = 1;
  const Drive later = makeDrive(makeWorld(options.world), options);
  double most = 0;
  for (std::size_t i = 0; i < today.time.size(); ++i)
    most = std::max(
        most, (today.T_map_sensor[i].translation() - later.T_map_sensor[i].translation()).norm());
  EXPECT_GT(most, 0.05);
  EXPECT_LT(most, 1.0);
}

TEST(Drive, ReverseComesFromTheFarEndInTheOtherLane) {
  SimulationOptions options;
  const World world = makeWorld(options.world);
  const Drive there = makeDrive(world, options);
  options.reverse = true;
  const Drive back = makeDrive(world, options);
  const Pose2D first = planar(back.T_map_sensor.front()), last = planar(there.T_map_sensor.back());
  const Pose2D seen = relative(last, first);  // about 3 m to the left, looking the other way
  EXPECT_NEAR(seen.x, 0, 1.5);
  EXPECT_NEAR(seen.y, 3, 0.8);
  EXPECT_GT(std::abs(seen.yaw), 3.0);
  EXPECT_GT(back.odometry[10].dx, 0.4) << "it drives forwards";
}

TEST(Drive, StopsAfterTheGivenNumberOfScans) {
  SimulationOptions options;
  options.scans = 7;
  EXPECT_EQ(makeDrive(makeWorld(options.world), options).time.size(), 7u);
}

TEST(Drive, RefusesAStreetShorterThanTwoScans) {
  SimulationOptions options;
  options.spacing = 50;
  options.world.length = 30;
  EXPECT_THROW(makeDrive(makeWorld(options.world), options), Error);
}

/// What 400 m in steps of 0.5 m read, with turns of 0.01 rad each.
struct Sums {
  double metres = 0, turns = 0;
  explicit Sums(const OdometryBias& bias, double step = 0.5) {
    WheelOdometry odometry(bias, Random(1));
    for (int i = 0; i < 800; ++i) {
      const OdometryStep read = odometry.read({step, 0.01, 0.01});
      metres += std::hypot(read.dx, read.dy);
      turns += read.dyaw;
    }
  }
};

TEST(WheelOdometry, ScaleYawBiasAndSlipAddUp) {
  const double length = 800 * std::hypot(0.5, 0.01);
  const Sums plain({0, 0, 0, 0, 0});
  EXPECT_NEAR(plain.metres, length, 0.5);
  EXPECT_NEAR(plain.turns, 8, 0.02);
  const Sums biased({0.03, 0.001, 0, 0.02, 0});
  EXPECT_NEAR(biased.metres, 1.03 * length, 0.5);
  EXPECT_NEAR(biased.turns, 8 * 1.02 + 0.001 * length, 0.02);
  EXPECT_NEAR(Sums({0.03, 0.001, 0, 0, 0}, -0.5).turns, 8 - 0.001 * length, 0.02) << "backwards";
}

TEST(WheelOdometry, FollowsABendWithoutErrors) {
  WheelOdometry odometry({0, 0, 0, 0, 0}, Random(1));
  const double turn = 0.07, radius = 10;  // 22 steps of 0.7 m, a quarter of a circle
  Pose2D truth, read;
  for (int i = 0; i < 22; ++i) {
    const Pose2D step{radius * std::sin(turn), radius * (1 - std::cos(turn)), turn};
    const OdometryStep motion = odometry.read(step);
    truth = compose(truth, step);
    read = compose(read, {motion.dx, motion.dy, motion.dyaw});
  }
  EXPECT_NEAR(read.x, truth.x, 0.05);
  EXPECT_NEAR(read.y, truth.y, 0.05);
}

TEST(WheelOdometry, DistancesAreWholeTicks) {
  WheelOdometry odometry({0.01, 0, 0.2, 0, 0.02}, Random(1));
  double sum = 0;
  for (int i = 0; i < 100; ++i) {
    const OdometryStep read = odometry.read({0.013, 0, 0});
    sum += std::hypot(read.dx, read.dy);
    EXPECT_NEAR(sum / 0.02, std::round(sum / 0.02), 1e-9);
  }
  EXPECT_NEAR(sum, 1.3, 0.05);
}

TEST(WheelOdometry, BiasesChangeSlowly) {
  const double length = 800 * std::hypot(0.5, 0.01);  // a whole wave of the scale
  EXPECT_NEAR(Sums({0.1, 0, 0.5, 0, 0}).metres, 1.1 * length, 1);
  WheelOdometry odometry({0.1, 0, 0.5, 0, 0}, Random(1));
  double quarter = 0;
  for (int i = 0; i < 400; ++i) quarter += odometry.read({0.5, 0, 0}).dx;
  EXPECT_NEAR(quarter, 200 * (1.1 + 0.05 * 2 / M_PI), 0.5) << "mean of half a wave";
}

}  // namespace

}  // namespace polemcl::test_drive
