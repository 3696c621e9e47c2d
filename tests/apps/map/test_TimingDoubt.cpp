// What pole-map build says of drives whose timing is wrong.

#include <gtest/gtest.h>

#include "map/TimingDoubt.h"
#include "support/ExpectHas.h"
#include "support/TimedDrive.h"

namespace polemcl::test_timing_doubt {
namespace {

using namespace polemcl::apps;

/// The poses are those of the simulator, so they are dead reckoning without an error.
MappingSession session(const ScanTiming& truth) {
  MappingSession result;
  for (const TimedScan& scan : tests::timedDrive(truth)) {
    SessionScan seen{scan.time, scan.pose_map_robot, {}, {}, {}};
    for (const TimedPole& pole : scan.poles_robot) {
      PoleDetection detection;
      detection.x = pole.x;
      detection.y = pole.y;
      seen.poles_robot.push_back(detection);
    }
    result.scans.push_back(seen);
  }
  return result;
}

TimingEstimate with(Turn turn, double clock, double significance = 0) {
  TimingEstimate result;
  result.timing.turn = turn;
  result.timing.clock = clock;
  result.turnSignificance = result.clockSignificance = significance;
  return result;
}

const TimingEstimate kNothing = with(Turn::compensated, 0);

TEST(TimingDoubt, SeesClocksThatDiffer) {
  ScanTiming late{Turn::compensated};
  late.clock = 0.08;
  const TimingEstimate found = remainingTiming(session(late), 0.1);
  EXPECT_NEAR(found.timing.clock, 0.08, 0.011);
  EXPECT_HAS(timingDoubt(found, kNothing, {}),
             "clocks of scans and of odometry or true poses differ");
  MappingSession alone = session(late);
  alone.filled.all = true;  // no odometry, no clock of it
  EXPECT_EQ(timingDoubt(remainingTiming(alone, 0.1), kNothing, {}), "");
}

TEST(TimingDoubt, SeesScansThatWereNotCorrected) {
  const TimingEstimate found = remainingTiming(session({Turn::clockwise, 0.1, M_PI, 0.5}), 0.1);
  EXPECT_EQ(found.timing.turn, Turn::clockwise);
  const std::string doubt = timingDoubt(found, kNothing, {});
  EXPECT_HAS(doubt, "not look corrected");
  EXPECT_HAS(doubt, "turn = clockwise fits best");
  EXPECT_EQ(timingDoubt(found, kNothing, {}, true), "") << "the order of the points tells the turn";
  // What is left after a correction is no turn to set.
  const std::string after = timingDoubt(found, kNothing, {Turn::clockwise, 0.2, M_PI, 0.5});
  EXPECT_HAS(after, "check turn, cut_deg, turn_s and the times of the scans");
  EXPECT_EQ(after.find("fits best"), std::string::npos);
}

TEST(TimingDoubt, OfTruePosesToo) {
  EXPECT_HAS(timingDoubtOfTruth(session({Turn::clockwise, 0.1, M_PI, 0.5}), {}),
             "not look corrected");
  EXPECT_EQ(timingDoubtOfTruth(session({Turn::compensated}), {}), "");
  ScanTiming late{Turn::compensated};  // may look like a turn at first
  late.clock = 0.1;
  EXPECT_EQ(timingDoubtOfTruth(session(late), {}).find("not look corrected"), std::string::npos);
}

TEST(TimingDoubt, LooksFromTheLidar) {
  MappingSession drive = session({Turn::clockwise, 0.1, M_PI, 0.5});
  for (SessionScan& scan : drive.scans) scan.pose_robot_sensor = {0, 0, M_PI / 2};
  const double cut = remainingTiming(drive, 0.1).timing.cut;
  EXPECT_NEAR(std::remainder(cut - M_PI / 2, 2 * M_PI), 0, 16 * M_PI / 180);
}

TEST(TimingDoubt, SaysNothingOfRightTiming) {
  const TimingEstimate found = remainingTiming(session({Turn::compensated}), 0.1);
  EXPECT_EQ(timingDoubt(found, found, {}), "");
  EXPECT_EQ(timingDoubt(with(Turn::compensated, 0.01, 5), kNothing, {}), "");
}

TEST(TimingDoubt, AddsTheOffsetToThatOfTheSettings) {
  ScanTiming set;
  set.clock = -0.02;
  EXPECT_HAS(timingDoubt(with(Turn::compensated, 0.05, 5.3), kNothing, set),
             "clock_offset_s = 0.03 (5.3 standard errors)");
  EXPECT_HAS(timingDoubt(with(Turn::compensated, 0.15, 9), kNothing, {}),
             "0.15 (9.0 standard errors), or one still farther off");
  EXPECT_EQ(timingDoubt(with(Turn::compensated, 0.14, 9), kNothing, {}).find("farther"),
            std::string::npos);
}

TEST(TimingDoubt, OfAdjustedPosesOnlyTheTurnCounts) {
  EXPECT_EQ(timingDoubt(kNothing, with(Turn::compensated, 0.05, 5), {}), "");
  EXPECT_HAS(timingDoubt(kNothing, with(Turn::clockwise, 0.03, 6.2), {}),
             "not look corrected for the motion during a turn (6.2 standard errors)");
}

}  // namespace
}  // namespace polemcl::test_timing_doubt
