#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/common/PoseEstimate.h"

namespace polemcl::test_pose_estimate {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void expectPose(const Pose2D& pose, double x, double y, double yaw) {
  EXPECT_NEAR(pose.x, x, 1e-12);
  EXPECT_NEAR(pose.y, y, 1e-12);
  EXPECT_NEAR(wrapAngle(pose.yaw - yaw), 0, 1e-12);
}

TEST(PoseEstimate, WeightedMeanByHand) {
  // Weights 1 and 3.
  const auto estimate = weightedMean({{0, 0, 0.2}, {4, 8, 0.2}}, {std::log(1.0), std::log(3.0)});
  expectPose(estimate.mean, 3, 6, 0.2);
  // Deviations (-3, -6) and (1, 2): Cxx = (9 + 3)/4, Cyy = (36 + 12)/4, Cxy = (18 + 6)/4.
  EXPECT_NEAR(estimate.covariance(0, 0), 3, 1e-12);
  EXPECT_NEAR(estimate.covariance(1, 1), 12, 1e-12);
  EXPECT_NEAR(estimate.covariance(0, 1), 6, 1e-12);
  EXPECT_NEAR(estimate.covariance(2, 2), 0, 1e-12);
}

TEST(PoseEstimate, HeadingsAreAveragedOnTheCircle) {
  const auto estimate = weightedMean({{0, 0, M_PI - 0.1}, {0, 0, -M_PI + 0.3}}, {0, 0});
  expectPose(estimate.mean, 0, 0, -M_PI + 0.1);
  EXPECT_NEAR(estimate.covariance(2, 2), 0.04, 1e-12);
}

TEST(PoseEstimate, CrossTermsKeepTheSignOfTheHeadingError) {
  // Farther to the left goes with a heading turned to the right, across ±pi.
  const auto estimate = weightedMean(
      {{1, 0, M_PI + 0.1}, {-1, 0, M_PI - 0.1}, {0, 2, M_PI - 0.2}, {0, -2, M_PI + 0.2}},
      {0, 0, 0, 0});
  EXPECT_NEAR(estimate.covariance(0, 2), 2 * 0.1 / 4, 1e-12);
  EXPECT_NEAR(estimate.covariance(1, 2), -2 * 0.4 / 4, 1e-12);
  EXPECT_NEAR(estimate.covariance(2, 1), estimate.covariance(1, 2), 0);
}

TEST(PoseEstimate, HeadingsThatCancelOutAreTheHeaviests) {
  const auto estimate = weightedMean({{0, 0, 0}, {0, 0, M_PI}, {0, 0, M_PI / 2}, {0, 0, -M_PI / 2}},
                                     {0, 0, std::log(2.0), std::log(2.0)});
  EXPECT_NEAR(estimate.mean.yaw, M_PI / 2, 1e-12);
}

TEST(PoseEstimate, AnOffsetOfTheWeightsChangesNothing) {
  const std::vector<Pose2D> particles{{1, 2, 0.5}, {2, 1, 0.7}, {5, 5, -1}};
  const auto plain = weightedMean(particles, {0, -1, -2});
  for (double offset : {-1000.0, 1000.0}) {
    const auto shifted = weightedMean(particles, {offset, offset - 1, offset - 2});
    EXPECT_EQ(shifted.mean.x, plain.mean.x);
    EXPECT_EQ(shifted.covariance, plain.covariance);
  }
}

TEST(PoseEstimate, LosesNoDigitsFarFromTheOrigin) {
  const auto estimate =
      weightedMean({{4e6 + 0.25, -5e6, 0}, {4e6 + 0.75, -5e6, 0}, {4e6 + 0.5, -5e6, 0}}, {0, 0, 0});
  EXPECT_DOUBLE_EQ(estimate.mean.x, 4e6 + 0.5);
  EXPECT_NEAR(estimate.covariance(0, 0), 0.125 / 3, 1e-9);
}

TEST(PoseEstimate, BestShareTakesAtLeastOneAndNoMoreThanTold) {
  const std::vector<Pose2D> particles{{1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}};
  const std::vector<double> logWeights{-1, 0, 0, -2};
  expectPose(bestShareMean(particles, logWeights, 0.01).mean, 2, 0,
             0);  // of the tie the lower index
  const double w = std::exp(-1.0), v = std::exp(-2.0);
  const auto half = bestShareMean(particles, logWeights, 0.5);
  expectPose(half.mean, 2.5, 0, 0);
  // The covariance tells of all particles, about this mean.
  EXPECT_NEAR(half.covariance(0, 0), (0.5 + 2.25 * (w + v)) / (2 + w + v), 1e-12);
  expectPose(bestShareMean(particles, logWeights, 0.74).mean, 2.5, 0, 0);
  expectPose(bestShareMean(particles, logWeights, 0.75).mean, (5 + w) / (2 + w), 0, 0);
  const auto all = bestShareMean(particles, logWeights, 1),
             mean = weightedMean(particles, logWeights);
  EXPECT_EQ(all.mean.x, mean.mean.x);
  // 0.29 times 100 is 28.999999999999996 in binary.
  std::vector<Pose2D> hundred(100);
  for (int i = 0; i < 100; ++i) hundred[i].x = i;
  expectPose(bestShareMean(hundred, std::vector<double>(100, 0.0), 0.29).mean, 14, 0, 0);
}

TEST(PoseEstimate, AWeightOfZeroCountsForNothing) {
  const auto estimate = weightedMean({{1, 1, 0}, {100, 100, 3}}, {0, -kInfinity});
  expectPose(estimate.mean, 1, 1, 0);
  EXPECT_EQ(estimate.covariance.norm(), 0);
}

TEST(PoseEstimate, EffectiveShareByHand) {
  EXPECT_DOUBLE_EQ(effectiveShare({3, 3, 3, 3}), 1);
  EXPECT_DOUBLE_EQ(effectiveShare({0, -kInfinity, -kInfinity, -kInfinity}), 0.25);
  // Weights 1 1 2: 16 / 6 / 3.
  EXPECT_NEAR(effectiveShare({-500, -500, -500 + std::log(2.0)}), 16.0 / 18, 1e-12);
}

TEST(PoseEstimate, RefusesBadInput) {
  EXPECT_THROW(weightedMean({}, {}), Error);
  EXPECT_THROW(effectiveShare({}), Error);
  EXPECT_THROW(weightedMean({{0, 0, 0}}, {0, 0}), Error);
  EXPECT_THROW(weightedMean({{}, {}}, {0, std::nan("")}), Error);
  EXPECT_THROW(weightedMean({{}, {}}, {0, kInfinity}), Error);
  EXPECT_THROW(effectiveShare({-kInfinity, -kInfinity}), Error);
  for (double share : {0.0, -0.1, 1.01, std::nan("")})
    EXPECT_THROW(bestShareMean({{}}, {0}, share), Error);
}

}  // namespace
}  // namespace polemcl::test_pose_estimate
