#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <vector>

#include "core/localization/OdometryDrift.h"
#include "sim/common/Random.h"

namespace polemcl::test_odometry_drift {
namespace {

Eigen::Matrix3d diagonal(double x, double y, double yaw) {
  return Eigen::Vector3d(x, y, yaw).asDiagonal();
}

TEST(OdometryDrift, AStepsPositionNoiseTurnsWithTheRobot) {
  const OdometryDrift then;
  OdometryDrift now;
  now.add({0, 2}, M_PI / 2,
          diagonal(0.04, 0.01, 0));  // driven to +y: its length is uncertain there
  const Eigen::Matrix2d covariance = OdometryDrift::between(then, now, {7, 3});
  EXPECT_NEAR(covariance(0, 0), 0.01, 1e-12);
  EXPECT_NEAR(covariance(1, 1), 0.04, 1e-12);
  EXPECT_NEAR(covariance(0, 1), 0, 1e-12);
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
}

TEST(OdometryDrift, CountsOnlyTheStepsBetween) {
  OdometryDrift then;
  then.add({100, 0}, 0, diagonal(1, 1, 1));
  OdometryDrift now = then;
  EXPECT_EQ(OdometryDrift::between(then, now, {3, 4}).norm(), 0);
  now.add({101, 0}, 0, diagonal(0.01, 0.01, 0));
  EXPECT_NEAR(OdometryDrift::between(then, now, {3, 4})(0, 0), 0.01, 1e-12);
}

/// The oracle: many noisy drives, and where the place lies as seen from their ends.
TEST(OdometryDrift, AgreesWithDrivesDrawnAtRandom) {
  const std::vector<Pose2D> steps{
      {2, 0, 0.3}, {3, 0.1, 0.4}, {2, 0, -0.2}, {4, -0.2, -0.6}, {3, 0, 0.1}};
  const Eigen::Matrix3d noise = diagonal(0.0025, 0.0004, 1e-4);
  const std::size_t fixedAfter = 2;  // the place is known from the pose after two steps
  const Pose2D place_then{6, -9, 0};
  OdometryDrift drift, then;
  Pose2D pose, fixedFrom;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double yaw = pose.yaw;
    pose = compose(pose, steps[i]);
    drift.add({pose.x, pose.y}, yaw, noise);
    if (i + 1 == fixedAfter) then = drift, fixedFrom = pose;
  }
  const Pose2D place = compose(fixedFrom, place_then);
  sim::Random random(5);
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  const int draws = 40000;
  for (int draw = 0; draw < draws; ++draw) {
    Pose2D since;  // true motion since the place was fixed
    for (std::size_t i = fixedAfter; i < steps.size(); ++i)
      since =
          compose(since, {steps[i].x + 0.05 * random.normal(), steps[i].y + 0.02 * random.normal(),
                          steps[i].yaw + 0.01 * random.normal()});
    const Pose2D seen = relative(since, place_then), expected = relative(pose, place);
    const Eigen::Vector2d error =
        Eigen::Rotation2Dd(pose.yaw) * Eigen::Vector2d(seen.x - expected.x, seen.y - expected.y);
    sum += error * error.transpose() / draws;
  }
  const Eigen::Matrix2d predicted = OdometryDrift::between(then, drift, {place.x, place.y});
  EXPECT_LT((sum - predicted).norm(), 0.03 * predicted.norm()) << sum << "\n\n" << predicted;
}

}  // namespace
}  // namespace polemcl::test_odometry_drift
