#include <gtest/gtest.h>

#include <cmath>

#include "core/sensor/TimingSearch.h"
#include "support/TimedDrive.h"

namespace polemcl::test_timing_search {
namespace {

double turned(double a, double b) {
  return std::abs(std::remainder(a - b, 2 * M_PI));
}

TEST(TimingSearch, FindsDirectionAndCut) {
  for (const ScanTiming& truth : {ScanTiming{Turn::clockwise, 0.1, M_PI, 0.5},
                                  ScanTiming{Turn::counterclockwise, 0.1, M_PI / 2, 0.5}}) {
    const TimingEstimate found = searchTiming(tests::timedDrive(truth), 0.1);
    EXPECT_EQ(found.timing.turn, truth.turn);
    EXPECT_LE(turned(found.timing.cut, truth.cut), 16 * M_PI / 180);
    EXPECT_EQ(found.timing.clock, 0);
    EXPECT_GT(found.turnSignificance, 10);
    EXPECT_LT(found.after, found.before);
    EXPECT_GT(found.pairs, 1000u);
  }
}

TEST(TimingSearch, LeavesCompensatedScansAlone) {
  const TimingEstimate found = searchTiming(tests::timedDrive({Turn::compensated}), 0.1);
  EXPECT_EQ(found.timing.turn, Turn::compensated);
  EXPECT_EQ(found.timing.clock, 0);
  EXPECT_EQ(found.before, found.after);
}

TEST(TimingSearch, TellsTheBestTurnOfADriveThatIsTooShort) {
  const ScanTiming truth{Turn::clockwise, 0.1, M_PI, 0.5};
  std::vector<TimedScan> scans = tests::timedDrive(truth);
  EXPECT_FALSE(searchTiming(scans, 0.1).candidate.known());
  scans.resize(30);
  const TimingEstimate found = searchTiming(scans, 0.1);
  EXPECT_EQ(found.timing.turn, Turn::compensated);
  EXPECT_GT(found.turnSignificance, 2);
  EXPECT_LT(found.turnSignificance, kEnoughErrors);
  EXPECT_EQ(found.candidate.turn, truth.turn);
  EXPECT_LE(turned(found.candidate.cut, truth.cut), 31 * M_PI / 180);
  EXPECT_LT(found.withCandidate, found.after);
}

TEST(TimingSearch, FindsTheOffsetOfTheClocks) {
  ScanTiming late{Turn::compensated};
  late.clock = 0.08;
  const TimingEstimate alone = searchTiming(tests::timedDrive(late), 0.1);
  EXPECT_EQ(alone.timing.turn, Turn::compensated);
  EXPECT_NEAR(alone.timing.clock, 0.08, 0.011);
  const TimingEstimate both =
      searchTiming(tests::timedDrive({Turn::clockwise, 0.1, M_PI, 0.5, -0.05}), 0.1);
  EXPECT_EQ(both.timing.turn, Turn::clockwise);
  EXPECT_NEAR(both.timing.clock, -0.05, 0.016);
}

// Stamped at the end of the turn: the same as in the middle, half a turn later.
TEST(TimingSearch, FindsStampsAtTheEndsOfTheTurn) {
  for (const double stamp : {0.0, 1.0}) {
    const ScanTiming truth{Turn::clockwise, 0.1, M_PI, stamp};
    const ScanTiming found = searchTiming(tests::timedDrive(truth), 0.1).timing;
    for (const double azimuth : {-2.0, 0.0, 2.0})
      EXPECT_NEAR(found.offset(azimuth), truth.offset(azimuth), 0.016) << stamp << ' ' << azimuth;
  }
}

TEST(TimingSearch, KeepsAStatedTimingUnlessAnotherIsClearlyBetter) {
  const ScanTiming truth{Turn::clockwise, 0.1, M_PI, 1};
  const auto scans = tests::timedDrive(truth);
  const TimingEstimate kept = searchTiming(scans, 0.1, truth);
  EXPECT_TRUE(kept.isStated);
  EXPECT_EQ(kept.timing.stamp, 1);
  EXPECT_EQ(kept.timing.clock, 0);
  EXPECT_LT(kept.turnSignificance, kEnoughErrors);
  EXPECT_LT(kept.after, kept.before);
  const ScanTiming wrong{Turn::counterclockwise, 0.1, M_PI, 0};
  const TimingEstimate found = searchTiming(scans, 0.1, wrong);
  EXPECT_FALSE(found.isStated);
  EXPECT_EQ(found.timing.turn, Turn::clockwise);
  ScanTiming late = truth;  // its clock may still be wrong
  late.clock = 0.06;
  const TimingEstimate clocked = searchTiming(tests::timedDrive(late), 0.1, truth);
  EXPECT_TRUE(clocked.isStated);
  EXPECT_NEAR(clocked.timing.clock, 0.06, 0.011);
}

TEST(TimingSearch, FindsRangesThatAreOff) {
  const ScanTiming timing{Turn::clockwise, 0.1, M_PI, 0.5};
  const Eigen::Vector2d lidar(1.5, 0.3);
  std::vector<TimedScan> scans = tests::timedDrive(timing);
  const RangeCorrection none = searchRangeCorrection(scans, timing, lidar).value();
  EXPECT_NEAR(none.offset, 0, 0.004);
  EXPECT_NEAR(none.scale, 1, 0.0003);
  EXPECT_LT(none.significance, 4);
  EXPECT_FALSE(none.isClear());
  for (TimedScan& scan : scans) {
    for (TimedPole& pole : scan.poles_robot) {
      const Eigen::Vector2d ray = Eigen::Vector2d(pole.x, pole.y) - lidar;
      const Eigen::Vector2d measured =
          lidar + ray.normalized() * (ray.norm() - 0.06) / 0.998;  // scale * measured + offset
      pole.x = measured.x();
      pole.y = measured.y();
    }
  }
  const RangeCorrection found = searchRangeCorrection(scans, timing, lidar).value();
  EXPECT_NEAR(found.offset, 0.06, 0.005);
  EXPECT_NEAR(found.scale, 0.998, 0.0004);
  EXPECT_GT(found.significance, 10);
  EXPECT_TRUE(found.isClear());
  EXPECT_FALSE((RangeCorrection{0.6, 1, 0.1, 0.05, 20}.isClear()));  // [sensor] would refuse them
  EXPECT_FALSE((RangeCorrection{0, 1.2, 0.1, 0.05, 20}.isClear()));
  EXPECT_NEAR(found.after, none.before, 0.002);
  EXPECT_GT(found.before, found.after + 0.002);
}

TEST(TimingSearch, TheRobotMayDriveSideways) {
  const ScanTiming timing{Turn::clockwise, 0.1, M_PI, 0.5};
  std::vector<TimedScan> scans = tests::timedDrive(timing);
  const RangeCorrection ahead = searchRangeCorrection(scans, timing, {1.5, 0.3}).value();
  const Pose2D quarter{0, 0, M_PI / 2};  // of a turn, by which the robot's axes are turned
  for (TimedScan& scan : scans) {
    scan.pose_map_robot = compose(scan.pose_map_robot, quarter);
    for (TimedPole& pole : scan.poles_robot) {
      const Pose2D seen = relative(quarter, {pole.x, pole.y, 0});
      pole.x = seen.x;
      pole.y = seen.y;
    }
  }
  const RangeCorrection aside = searchRangeCorrection(scans, timing, {0.3, -1.5}).value();
  EXPECT_NEAR(aside.before, ahead.before, 1e-6);
  EXPECT_NEAR(aside.offset, ahead.offset, 1e-6);
  EXPECT_NEAR(aside.scale, ahead.scale, 1e-6);
}

TEST(TimingSearch, SaysNothingWithoutPairs) {
  const TimingEstimate none = searchTiming({}, 0.1);
  EXPECT_EQ(none.pairs, 0u);
  EXPECT_EQ(none.timing.turn, Turn::compensated);
  EXPECT_EQ(searchTiming({{0, {}, {{5, 5, 0}}}}, 0.1).pairs, 0u);
  EXPECT_FALSE(searchRangeCorrection({}, {}, {0, 0}));
}

}  // namespace
}  // namespace polemcl::test_timing_search
