#include <gtest/gtest.h>

#include <cmath>

#include "core/common/PoseInterpolation.h"

namespace polemcl::test_pose_interpolation {

namespace {
const std::vector<StampedPose2D> kTrack{
    {10.0, {0, 0, 3.0}}, {11.0, {4, -2, -3.0}}, {15.0, {8, 2, -3.0}}, {16.0, {9, 2, 0}}};
}

TEST(PoseInterpolation, IsLinearAndTurnsTheShortWay) {
  const auto pose = poseAt(kTrack, 10.25, 2.0);
  ASSERT_TRUE(pose);
  EXPECT_DOUBLE_EQ(pose->x, 1.0);
  EXPECT_DOUBLE_EQ(pose->y, -0.5);
  // From 3.0 to -3.0 is 2pi - 6 = 0.28319 to the left; a quarter of it is 0.07080.
  EXPECT_NEAR(pose->yaw, 3.0 + (2 * M_PI - 6) / 4, 1e-12);
}

TEST(PoseInterpolation, SamplesAreThemselves) {
  for (const auto& sample : kTrack) {
    const auto pose = poseAt(kTrack, sample.time, 2.0);
    ASSERT_TRUE(pose);
    EXPECT_EQ(pose->x, sample.pose.x);
    EXPECT_EQ(pose->yaw, sample.pose.yaw);
  }
}

TEST(PoseInterpolation, RoundedClocksStillHit) {
  ASSERT_TRUE(poseAt(kTrack, 10.0 - 1e-6, 2.0));
  ASSERT_TRUE(poseAt(kTrack, 16.0 + 1e-6, 2.0));
  const auto pose = poseAt(kTrack, 15.0 - 1e-6, 2.0);  // its other side is a gap
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->x, 8);
}

TEST(PoseInterpolation, KnowsNothingOutsideAndInGaps) {
  EXPECT_FALSE(poseAt(kTrack, 9.99, 2.0));
  EXPECT_FALSE(poseAt(kTrack, 16.01, 2.0));
  EXPECT_FALSE(poseAt(kTrack, 13.0, 2.0));
  EXPECT_TRUE(poseAt(kTrack, 13.0, 4.0));
  EXPECT_FALSE(poseAt({}, 1.0, 2.0));
}

TEST(PoseInterpolation, VelocityIsThatOfTheRobot) {
  const std::vector<StampedPose2D> north{{0, {0, 0, M_PI / 2}}, {1, {0, 5, M_PI / 2}}};
  for (const double time : {0.0, 0.5, 1.0}) {
    const Velocity velocity = velocityAt(north, time, 0.25, 2.0);
    EXPECT_NEAR(velocity.x, 5, 1e-9);
    EXPECT_NEAR(velocity.y, 0, 1e-9);
    EXPECT_NEAR(velocity.yaw, 0, 1e-9);
  }
  EXPECT_EQ(velocityAt(north, 3, 0.25, 2.0).x, 0);
  EXPECT_EQ(velocityAt(north, 0.5, 0.25, 0.5).x, 0) << "a gap";
}

}  // namespace polemcl::test_pose_interpolation
