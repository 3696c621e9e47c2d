#include <gtest/gtest.h>

#include "core/extraction/scan_line/TiltEstimation.h"

namespace polemcl::test_tilt_estimation {

using namespace polemcl;

namespace {

using Vector = Eigen::Vector2f;

/// A pole that was seen to lean by `seen`, shrunk by the prior towards `upright`.
PoleLean leaning(const Vector& seen, float prior, const Vector& upright = Vector::Zero()) {
  PoleLean pole;
  pole.lean = prior * upright + (1 - prior) * seen;
  pole.prior = prior;
  pole.step = -2;
  return pole;
}

void expectNear(const Vector& value, const Vector& expected, float tolerance) {
  EXPECT_NEAR(value.x(), expected.x(), tolerance);
  EXPECT_NEAR(value.y(), expected.y(), tolerance);
}

}  // namespace

TEST(CommonLean, WithoutPolesWhatWasKnownBefore) {
  expectNear(commonLean({}, {0.01f, -0.02f}), {0.01f, -0.02f}, 1e-7f);
}

TEST(CommonLean, ManyPolesThatLeanAlikeDecide) {
  const std::vector<PoleLean> poles(30, leaning({0.02f, -0.01f}, 0.2f));
  expectNear(commonLean(poles, Vector::Zero()), {0.02f, -0.01f}, 1e-3f);
  const Vector known(0.1f, 0.3f);  // a camera that looks down is tilted far, and that is known
  const std::vector<PoleLean> seen(30, leaning({0.12f, 0.29f}, 0.2f, known));
  expectNear(commonLean(seen, known), {0.12f, 0.29f}, 2e-3f);
}

TEST(CommonLean, OnePoleIsSharedBetweenItselfAndTheSensor) {
  const PoleLean pole = leaning({0.005f, 0}, 0.2f);
  // By hand: variances 0.0004 / 4 + 0.0009 of the pole, 0.0016 of the sensor.
  const double share = (1 / 0.001) / (1 / 0.001 + 1 / 0.0016);
  const Vector common = commonLean({pole}, Vector::Zero());
  EXPECT_NEAR(common.x(), share * 0.005, 1e-5);
  PoleLean doubtful = pole;
  doubtful.weight = 0.5f;
  const double half = (0.5 / 0.001) / (0.5 / 0.001 + 1 / 0.0016);
  EXPECT_NEAR(commonLean({doubtful}, Vector::Zero()).x(), half * 0.005, 1e-5);
}

TEST(CommonLean, ATrunkThatLeansDoesNotTiltTheWorld) {
  std::vector<PoleLean> poles(10, leaning({0.01f, 0}, 0.2f));
  const float without = commonLean(poles, Vector::Zero()).x();
  poles.push_back(leaning({0.5f, 0.3f}, 0.1f));
  expectNear(commonLean(poles, Vector::Zero()), {without, 0}, 2e-4f);
}

TEST(CommonLean, WhatIsMostlyThePriorTellsNothing) {
  expectNear(commonLean({leaning({0.3f, 0.3f}, 0.7f)}, Vector::Zero()), Vector::Zero(), 1e-7f);
}

TEST(CommonLean, MovesWhatThePriorHeldUpright) {
  PoleLean pole = leaning({0, 0}, 0.25f);
  expectNear(shiftBy(pole, Vector::Zero(), {0.02f, 0.04f}), {-0.01f, -0.02f}, 1e-6f);
  pole.gap = -0.5f;  // seen from half a metre above the sensor's height on
  expectNear(shiftBy(pole, Vector::Zero(), {0.02f, 0.04f}), {-0.02f, -0.04f}, 1e-6f);
  expectNear(shiftBy(pole, {0.02f, 0.04f}, {0.02f, 0.04f}), {-0.01f, -0.02f}, 1e-6f);
}

}  // namespace polemcl::test_tilt_estimation
