#include <gtest/gtest.h>

#include "core/common/DetectionFusion.h"
#include "core/common/Transform.h"
#include "support/Poles.h"

namespace polemcl::test_detection_fusion {

using namespace polemcl::tests;

namespace {

PoleDetection pole(double x, double y, double variance, double time = 0) {
  PoleDetection p = detectionAt(x, y, variance);
  p.timeOffset = time;
  return p;
}

/// A standing pole as seen at some moment from a vehicle that moves; `place` is seen at the stamp.
PoleDetection seenAt(double time, const Pose2D& place, const Velocity& velocity) {
  const Pose2D seen = relative(motionAfter(velocity, time), place);
  return pole(seen.x, seen.y, 1e-4, time);
}

TEST(DetectionFusion, APoleThatBothSeeIsOneWithTheMeanByCovariance) {
  std::vector<PoleDetection> fused{pole(10, 0, 0.01)};
  PoleDetection other = pole(10.05, 0, 0.04);
  other.bottom = 0.2;
  other.top = 5;
  other.radius = 0.2;
  other.confidence = 0.4;
  fused[0].bottom = 0.5;
  fused[0].top = 3;
  fused[0].confidence = 0.9;
  const auto agreement = fuseDetections(fused, {other}, {});
  ASSERT_EQ(fused.size(), 1u);
  EXPECT_NEAR(fused[0].x, 10.01, 1e-6) << "a fifth of the way";
  EXPECT_NEAR(fused[0].covariance(0, 0), 0.008, 1e-6) << "1 / (1 / 0.01 + 1 / 0.04)";
  EXPECT_NEAR(fused[0].radius, 0.12, 1e-6);
  EXPECT_EQ(fused[0].bottom, 0.2);
  EXPECT_EQ(fused[0].top, 5);
  EXPECT_EQ(fused[0].confidence, 0.9);
  EXPECT_EQ(fused[0].points, 20u);
  EXPECT_EQ(agreement.poles, 1u);
  EXPECT_NEAR(agreement.squaredMetres, 0.0025, 1e-9);
  EXPECT_NEAR(agreement.squaredSigmas, 0.05, 1e-6) << "0.05² / (0.01 + 0.04)";
}

TEST(DetectionFusion, OtherPolesStayTwo) {
  std::vector<PoleDetection> fused{pole(10, 0, 0.01), pole(0, 8, 0.01)};
  const auto agreement = fuseDetections(fused, {pole(10.41, 0, 0.01), pole(-5, -5, 0.01)}, {});
  EXPECT_EQ(fused.size(), 4u);
  EXPECT_EQ(agreement.poles, 0u);
}

TEST(DetectionFusion, TheClosestPairsComeFirst) {
  std::vector<PoleDetection> fused{pole(10, 0, 0.01), pole(10, 0.5, 0.01)};
  fuseDetections(fused, {pole(10, 0.35, 0.01)}, {});
  ASSERT_EQ(fused.size(), 2u);
  EXPECT_EQ(fused[0].y, 0);
  EXPECT_NEAR(fused[1].y, 0.425, 1e-9);
}

/// At 15 m/s and half a turn, the two places are 0.75 m apart, more than two poles may be.
TEST(DetectionFusion, TheMotionBetweenTheTwoMomentsCounts) {
  const Velocity velocity{15, 0, 0.5};
  const Pose2D place{12, 4, 0};
  std::vector<PoleDetection> fused{seenAt(-0.06, place, velocity)};
  const auto agreement = fuseDetections(fused, {seenAt(-0.01, place, velocity)}, velocity);
  ASSERT_EQ(fused.size(), 1u);
  EXPECT_NEAR(agreement.squaredMetres, 0, 1e-12);
  EXPECT_NEAR(fused[0].timeOffset, -0.035, 1e-9) << "the mean of the times";
  deskew(fused, velocity);
  EXPECT_NEAR(fused[0].x, place.x, 1e-9);
  EXPECT_NEAR(fused[0].y, place.y, 1e-9);

  std::vector<PoleDetection> still{seenAt(-0.06, place, velocity)};
  fuseDetections(still, {seenAt(-0.01, place, velocity)}, {});
  EXPECT_EQ(still.size(), 2u) << "without the motion it is taken for two";
}

/// The velocity is 5 % wrong when poles are fused, and right later.
TEST(DetectionFusion, AnErrorOfTheVelocityHasNoEffectInTheFirstOrder) {
  const Velocity velocity{10, 0, 0}, wrong{10.5, 0, 0};
  const Pose2D place{12, 4, 0};
  std::vector<PoleDetection> fused{seenAt(-0.06, place, velocity)};
  PoleDetection other = seenAt(0, place, velocity);
  other.covariance *= 3;
  fuseDetections(fused, {other}, wrong);
  ASSERT_EQ(fused.size(), 1u);
  deskew(fused, velocity);
  EXPECT_NEAR(fused[0].x, place.x, 1e-4);  // the 5 % of 0.06 s alone are 0.03 m
}

TEST(DetectionFusion, PlacesThatContradictEachOtherAreUncertain) {
  std::vector<PoleDetection> near{pole(10, 0, 1e-4)}, far = near;
  fuseDetections(near, {pole(10.02, 0, 1e-4)}, {});
  fuseDetections(far, {pole(10.2, 0, 1e-4)}, {});
  EXPECT_NEAR(near[0].covariance(0, 0), 5e-5, 1e-7);
  EXPECT_NEAR(far[0].covariance(0, 0), 5e-5 * (0.2 * 0.2 / 2e-4 / 5.991), 1e-6);
}

}  // namespace
}  // namespace polemcl::test_detection_fusion
