#include <gtest/gtest.h>

#include <cmath>

#include "core/common/Angles.h"
#include "sim/drive/WheelOdometry.h"

namespace polemcl::test_wheel_odometry {

using namespace polemcl::sim;

namespace {

/// What 400 m in steps of 0.5 m read, with turns of 0.01 rad each.
struct Sums {
  double metres = 0, turns = 0;
  explicit Sums(const OdometryBias& bias, double step = 0.5) {
    WheelOdometry odometry(bias, Random(1));
    for (int i = 0; i < 800; ++i) {
      const OdometryStep read = odometry.read({step, 0.01, 0.01});
      metres += read.dx;
      turns += read.dyaw;
      EXPECT_EQ(read.dy, 0) << "wheels do not see sideways motion";
    }
  }
};

}  // namespace

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

TEST(WheelOdometry, DistancesAreWholeTicks) {
  WheelOdometry odometry({0.01, 0, 0.2, 0, 0.02}, Random(1));
  double sum = 0;
  for (int i = 0; i < 100; ++i) {
    sum += odometry.read({0.013, 0, 0}).dx;
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

}  // namespace polemcl::test_wheel_odometry
