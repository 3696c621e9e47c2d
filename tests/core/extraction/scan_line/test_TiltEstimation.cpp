#include <gtest/gtest.h>

#include "core/extraction/scan_line/TiltEstimation.h"

namespace polemcl::test_tilt_estimation {
namespace {

using Vector = Eigen::Vector2f;

/// A pole that was seen to tilt by `seen`, shrunk by the prior towards `upright`.
PoleTilt tilted(const Vector& seen, float prior, const Vector& upright = Vector::Zero()) {
  PoleTilt pole;
  pole.tilt = prior * upright + (1 - prior) * seen;
  pole.prior = prior;
  pole.step = -2;
  return pole;
}

void expectNear(const Vector& value, const Vector& expected, float tolerance) {
  EXPECT_NEAR(value.x(), expected.x(), tolerance);
  EXPECT_NEAR(value.y(), expected.y(), tolerance);
}

TEST(TiltEstimation, WithoutPolesWhatWasKnownBefore) {
  expectNear(estimateTilt({}, {0.01f, -0.02f}), {0.01f, -0.02f}, 1e-7f);
}

TEST(TiltEstimation, ManyPolesThatLeanAlikeDecide) {
  const std::vector<PoleTilt> poles(30, tilted({0.02f, -0.01f}, 0.2f));
  expectNear(estimateTilt(poles, Vector::Zero()), {0.02f, -0.01f}, 1e-3f);
  const Vector known(0.1f, 0.3f);  // a camera that looks down is tilted far, and that is known
  const std::vector<PoleTilt> seen(30, tilted({0.12f, 0.29f}, 0.2f, known));
  expectNear(estimateTilt(seen, known), {0.12f, 0.29f}, 2e-3f);
}

TEST(TiltEstimation, OnePoleIsSharedBetweenItselfAndTheSensor) {
  const PoleTilt pole = tilted({0.005f, 0}, 0.2f);
  // By hand: variances 0.0004 / 4 + 0.0009 of the pole, 0.0016 of the sensor.
  const double share = (1 / 0.001) / (1 / 0.001 + 1 / 0.0016);
  const Vector common = estimateTilt({pole}, Vector::Zero());
  EXPECT_NEAR(common.x(), share * 0.005, 1e-5);
  PoleTilt doubtful = pole;
  doubtful.weight = 0.5f;
  const double half = (0.5 / 0.001) / (0.5 / 0.001 + 1 / 0.0016);
  EXPECT_NEAR(estimateTilt({doubtful}, Vector::Zero()).x(), half * 0.005, 1e-5);
}

TEST(TiltEstimation, ATrunkThatLeansDoesNotTiltTheWorld) {
  std::vector<PoleTilt> poles(10, tilted({0.01f, 0}, 0.2f));
  const float without = estimateTilt(poles, Vector::Zero()).x();
  poles.push_back(tilted({0.5f, 0.3f}, 0.1f));
  expectNear(estimateTilt(poles, Vector::Zero()), {without, 0}, 2e-4f);
}

TEST(TiltEstimation, WhatIsMostlyThePriorTellsNothing) {
  expectNear(estimateTilt({tilted({0.3f, 0.3f}, 0.7f)}, Vector::Zero()), Vector::Zero(), 1e-7f);
}

TEST(TiltEstimation, MovesWhatThePriorHeldUpright) {
  PoleTilt pole = tilted({0, 0}, 0.25f);
  expectNear(shiftBy(pole, Vector::Zero(), {0.02f, 0.04f}), {-0.01f, -0.02f}, 1e-6f);
  pole.gap = -0.5f;  // seen from half a metre above the sensor's height on
  expectNear(shiftBy(pole, Vector::Zero(), {0.02f, 0.04f}), {-0.02f, -0.04f}, 1e-6f);
  expectNear(shiftBy(pole, {0.02f, 0.04f}, {0.02f, 0.04f}), {-0.01f, -0.02f}, 1e-6f);
}

}  // namespace
}  // namespace polemcl::test_tilt_estimation
