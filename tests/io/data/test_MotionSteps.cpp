#include <gtest/gtest.h>

#include "io/data/PlanarMotion.h"

namespace polemcl::test_motion_steps {

using namespace polemcl::io;

TEST(MotionSteps, ComposesStepsInProportion) {
  MotionSteps steps;
  const Eigen::Matrix3d first = Eigen::Vector3d(1, 2, 4).asDiagonal(),
                        second = Eigen::Vector3d(3, 0, 0).asDiagonal();
  steps.add(10, 12, {{}, first});
  steps.add(12, 13, {{}, second});
  EXPECT_TRUE(steps.covarianceBetween(10, 13)->isApprox(first + second));
  EXPECT_TRUE(steps.covarianceBetween(11, 12.5)->isApprox(0.5 * first + 0.5 * second));
  // The gap from 13 to 14 counts as the step before it.
  EXPECT_TRUE(steps.covarianceBetween(12, 14)->isApprox(2 * second));
  EXPECT_FALSE(steps.covarianceBetween(12, 14.1));
}

TEST(MotionSteps, ForgetsWhatEnded) {
  MotionSteps steps;
  for (const double begin : {0, 1, 2})
    steps.add(begin, begin + 1, {{}, Eigen::Matrix3d::Identity()});
  steps.forgetBefore(1.5);
  EXPECT_FALSE(steps.covarianceBetween(0, 1));
  EXPECT_TRUE(steps.covarianceBetween(1, 3)->isApprox(2 * Eigen::Matrix3d::Identity()));
}

TEST(MotionSteps, TurnsMoveTheEnd) {
  MotionSteps steps;
  steps.add(0, 1, {{0, 0, 0}, Eigen::Vector3d(0, 0, 0.01).asDiagonal()});
  steps.add(1, 2, {{5, 0, 0}, Eigen::Matrix3d::Zero()});
  const auto covariance = *steps.covarianceBetween(0, 2);
  EXPECT_NEAR(covariance(1, 1), 25 * 0.01, 1e-12);
  EXPECT_NEAR(covariance(1, 2), 5 * 0.01, 1e-12);
}

/// An odometry errs across its way too, and its heading on straight streets.
TEST(MotionSteps, DefaultsAreSharesOfWayAndTurn) {
  const double perMetre = M_PI / 180;
  EXPECT_TRUE(
      assumedCovariance({4, -3, 0.5}, 0.1)
          .isApprox(Eigen::Matrix3d(
              Eigen::Vector3d(0.25, 0.25, 0.0025 + 0.25 * perMetre * perMetre).asDiagonal())));
  EXPECT_EQ(floorCovariance().diagonal(), Eigen::Vector3d(1e-6, 1e-6, 1e-8));
}

}  // namespace polemcl::test_motion_steps
