#include <gtest/gtest.h>

#include <cmath>

#include "core/common/Angles.h"
#include "sim/drive/WheelOdometry.h"

namespace polemcl::test_wheel_odometry {
namespace {

using namespace polemcl::sim;

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
}  // namespace polemcl::test_wheel_odometry
