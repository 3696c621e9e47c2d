#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "core/localization/OdometryDrift.h"

namespace polemcl::test_odometry_drift {
namespace {

Eigen::Matrix3d diagonal(double x, double y, double yaw) {
  return Eigen::Vector3d(x, y, yaw).asDiagonal();
}

TEST(OdometryDrift, AStepsPositionNoiseTurnsWithTheRobot) {
  const OdometryDrift then;
  OdometryDrift now;  // uncertain in the direction of the drive
  now.add({std::sqrt(3), 1}, M_PI / 6, diagonal(0.04, 0.01, 0));
  const Eigen::Matrix2d covariance = OdometryDrift::between(then, now, {7, 3});
  EXPECT_NEAR(covariance(0, 0), 0.75 * 0.04 + 0.25 * 0.01, 1e-12);
  EXPECT_NEAR(covariance(1, 1), 0.25 * 0.04 + 0.75 * 0.01, 1e-12);
  EXPECT_NEAR(covariance(0, 1), std::sqrt(3) / 4 * (0.04 - 0.01), 1e-12);
}

TEST(OdometryDrift, ATurnSwingsWhatLiesFar) {
  const OdometryDrift then;
  OdometryDrift now;
  now.add({5, 0}, 0, diagonal(0, 0, 1e-4));  // 0.01 rad
  EXPECT_NEAR(OdometryDrift::between(then, now, {5, 0}).norm(), 0, 1e-12);
  const Eigen::Matrix2d ahead = OdometryDrift::between(then, now, {25, 0});
  EXPECT_NEAR(ahead(1, 1), 0.04, 1e-12);  // 20 m · 0.01 sideways
  EXPECT_NEAR(ahead(0, 0), 0, 1e-12);
  const Eigen::Matrix2d across = OdometryDrift::between(then, now, {8, 4});  // along (-4, 3)
  EXPECT_NEAR(across(0, 0), 16e-4, 1e-12);
  EXPECT_NEAR(across(1, 1), 9e-4, 1e-12);
  EXPECT_NEAR(across(0, 1), -12e-4, 1e-12);
  EXPECT_EQ(across(1, 0), across(0, 1));
}

TEST(OdometryDrift, CountsOnlyTheStepsBetween) {
  OdometryDrift then;
  then.add({100, 0}, 0, diagonal(1, 1, 1));
  OdometryDrift now = then;
  EXPECT_EQ(OdometryDrift::between(then, now, {3, 4}).norm(), 0);
  now.add({101, 0}, 0, diagonal(0.01, 0.01, 0));
  EXPECT_NEAR(OdometryDrift::between(then, now, {3, 4})(0, 0), 0.01, 1e-12);
}

}  // namespace
}  // namespace polemcl::test_odometry_drift
