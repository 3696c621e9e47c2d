#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/localization/WholeSteps.h"

namespace polemcl::test_whole_steps {
namespace {

double speedOf(const std::optional<TimedMotion>& step) {
  return step ? step->motion.x / step->seconds : -1;
}

TEST(WholeSteps, RegularStepsAreHandedOutAsTheyAre) {
  for (const double seconds : {0.05, 0.1, 0.5, 3.0}) {
    WholeSteps steps;
    for (int i = 0; i < 5; ++i) {
      const auto step = steps.add({10 * seconds, 0.1, 0.01}, seconds);
      ASSERT_TRUE(step) << seconds;
      EXPECT_EQ(step->motion.x, 10 * seconds);
      EXPECT_EQ(step->seconds, seconds);
    }
  }
}

TEST(WholeSteps, AStepTooShortIsJoinedWithTheNext) {
  WholeSteps steps;
  steps.add({1, 0, 0}, 0.1);
  EXPECT_FALSE(steps.add({1, 0, 0.2}, 0.005));
  EXPECT_EQ(steps.joined({1, 0, 0}, 0.195).seconds, 0.2);
  const auto step = steps.add({1, 0, 0}, 0.195);
  ASSERT_TRUE(step);
  EXPECT_NEAR(step->motion.x, 1 + std::cos(0.2), 1e-12);
  EXPECT_NEAR(step->motion.yaw, 0.2, 1e-12);
  EXPECT_NEAR(speedOf(steps.add({1, 0, 0}, 0.1)), 10, 1e-9);
}

/// Key frames: the vehicle slows down before a junction.
TEST(WholeSteps, AStepOfSecondsTellsThatTheVehicleIsSlower) {
  WholeSteps steps;
  for (int i = 0; i < 3; ++i) steps.add({4, 0, 0}, 0.5);
  EXPECT_NEAR(speedOf(steps.add({3, 0, 0}, 4)), 0.75, 1e-9);
}

/// Scans are kept each metre, so they come seldom while the vehicle hardly moves, and often again.
TEST(WholeSteps, AfterAHaltWithFewScansTheSpeedIsSoonTold) {
  for (const std::vector<double>& halts : {std::vector<double>{0.7, 0.9, 0.9},
                                           {2.0, 5.0, 3.0, 9.0},
                                           {0.3, 0.45, 0.65, 0.9, 0.9, 0.9}}) {
    WholeSteps steps;
    for (int i = 0; i < 5; ++i) steps.add({0.8, 0, 0}, 0.2);
    for (const double seconds : halts) steps.add({0.05, 0, 0}, seconds);
    double untold = 0, speed = 0;
    for (int i = 0; i < 10; ++i) {
      speed += 0.2 * 2;  // m/s²
      untold += 0.2;
      const auto step = steps.add({0.2 * speed, 0, 0}, 0.2);
      EXPECT_LE(untold, 0.41) << i;
      if (!step) continue;
      EXPECT_NEAR(speedOf(step), speed, 0.41);
      untold = 0;
    }
  }
}

TEST(WholeSteps, TheFirstStepMayBeTooShort) {
  WholeSteps steps;
  EXPECT_FALSE(steps.add({0.1, 0, 0}, 0.005));
  EXPECT_NEAR(speedOf(steps.add({0.1, 0, 0}, 0.195)), 1, 1e-9);
}

TEST(WholeSteps, FasterScansAreFollowed) {
  WholeSteps steps;
  for (int i = 0; i < 5; ++i) steps.add({1, 0, 0}, 0.1);
  int told = 0;
  for (int i = 0; i < 20; ++i) {
    const double speed = speedOf(steps.add({0.1, 0, 0}, 0.01));
    told += speed > 0;
    EXPECT_TRUE(speed < 0 || std::abs(speed - 10) < 1e-9) << i;
  }
  EXPECT_GE(told, 17);
}

TEST(WholeSteps, AfterALongGapTheStepsBeforeAreUsual) {
  WholeSteps steps;
  for (const double seconds : {0.1, 0.1, 2.0, 0.1, 0.1})
    EXPECT_NEAR(speedOf(steps.add({seconds, 0, 0}, seconds)), 1, 1e-9) << seconds;
}

TEST(WholeSteps, AJumpTellsNoSpeed) {
  WholeSteps steps;
  steps.add({1, 0, 0}, 0.1);
  EXPECT_FALSE(steps.isOpen({500, 0, 0}, 0.1));
  EXPECT_TRUE(steps.isOpen({1, 0, 0}, 0.005)) << "the stamp is wrong, not the motion";
  EXPECT_FALSE(steps.add({500, 0, 0}, 0.1));
  EXPECT_FALSE(steps.add({1, 0, 0}, 0.1));
  EXPECT_NEAR(speedOf(steps.add({1, 0, 0}, 0.1)), 10, 1e-9);
}

// The scans of a stall come at its end, 1 ms apart. Gaps of right length are no stalls.
TEST(WholeSteps, ABurstAfterAStallIsOneStep) {
  for (const double speed : {0.5, 5.0, 20.0})
    for (const int burst : {2, 3, 6, 9}) {
      SCOPED_TRACE(testing::Message() << speed << " m/s, " << burst << " scans");
      WholeSteps steps;
      int told = 0;
      const auto add = [&](double seconds) {
        const auto step = steps.add({0.1 * speed, 0, 0}, seconds);
        if (!step) return;
        ++told;
        EXPECT_NEAR(speedOf(step), speed, 1e-6);
      };
      for (int round = 0; round < 5; ++round) {
        for (int i = 0; i < 10; ++i) add(0.1);
        EXPECT_FALSE(steps.isOpen({0.1 * speed, 0, 0}, 0.1));
        EXPECT_TRUE(steps.isOpen({0.1 * speed, 0, 0}, 0.1 * burst));
        add(0.1 * burst - 0.001 * (burst - 1));
        EXPECT_TRUE(steps.isOpen({0.1 * speed, 0, 0}, 0.001));
        for (int i = 1; i < burst; ++i) add(0.001);
      }
      EXPECT_EQ(told, 50) << "one of ten ends the burst before";
    }
  WholeSteps steps;
  for (int i = 0; i < 10; ++i) steps.add({1, 0, 0}, 0.1);
  EXPECT_NEAR(speedOf(steps.add({4, 0, 0}, 0.4)), 10, 1e-9);
}

TEST(WholeSteps, ABurstLeavesTheUsualLength) {
  WholeSteps standing;
  for (int i = 0; i < 10; ++i) standing.add({}, 0.1);
  standing.add({}, 0.892);
  for (int i = 0; i < 8; ++i) EXPECT_TRUE(standing.add({}, 0.001));
  EXPECT_FALSE(standing.tellsSpeed({{0.001, 0, 0}, 0.01}));
  EXPECT_TRUE(standing.tellsSpeed({{0.005, 0, 0}, 0.1}));
  WholeSteps first;  // what was before the burst is forgotten
  for (int i = 0; i < 19; ++i) EXPECT_FALSE(first.add({1, 0, 0}, 0.001));
  EXPECT_FALSE(first.add({1, 0, 0}, 0.1)) << "too fast";
  EXPECT_FALSE(first.tellsSpeed({{0.1, 0, 0}, 0.01}));
  EXPECT_NEAR(speedOf(first.add({1, 0, 0}, 0.1)), 10, 1e-9);
}

}  // namespace
}  // namespace polemcl::test_whole_steps
