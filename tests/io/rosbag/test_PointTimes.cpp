#include <algorithm>

#include <polemcl/io/rosbag/PackedCloud.h>
#include "io/rosbag/RosMessages.h"
#include "support/IoFiles.h"
#include "support/RosBags.h"

namespace polemcl::test_point_times {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;
using namespace polemcl::tests;

RosCloud turn(int sign, double cut, double begin, double seconds = 0.1) {
  return decodeCloud(turningCloud(100, sign, cut, begin, seconds).message(), "", true);
}

/// The scan with its points in another order than that of measuring.
RosCloud mixed(const RosCloud& ordered) {
  RosCloud result = ordered;
  for (std::size_t i = 0; i < result.cloud.size(); ++i) {
    const std::size_t from = i * 7919 % result.cloud.size();
    result.cloud.x[i] = ordered.cloud.x[from];
    result.cloud.y[i] = ordered.cloud.y[from];
    result.offsets[i] = ordered.offsets[from];
  }
  return result;
}

TimingEstimate estimateOf(const std::vector<RosCloud>& scans) {
  TimingEstimate estimate;
  for (const RosCloud& scan : scans) estimate.add(scan);
  return estimate;
}

/// The model of the timing gives each point its time, apart from the points next to the cut.
void expectTimesOf(const RosCloud& scan, const ScanTiming& timing, double tolerance) {
  for (std::size_t i = 20; i + 20 < scan.cloud.size(); ++i)
    ASSERT_NEAR(timing.offset(std::atan2(scan.cloud.y[i], scan.cloud.x[i])), scan.offsets[i],
                tolerance)
        << i;
}

TEST(PointTimes, FindsBothDirectionsAndAnyStamp) {
  for (const int sign : {-1, 1})
    for (const double cut : {-3.0, 0.0, 2.0})
      for (const double begin : {0.0, -0.05, -0.1}) {
        const auto estimate = estimateOf({turn(sign, cut, begin), turn(sign, cut + 0.1, begin)});
        const ScanTiming timing = estimate.timing();
        EXPECT_EQ(timing.turn, sign > 0 ? Turn::counterclockwise : Turn::clockwise);
        EXPECT_NEAR(timing.seconds, 0.1, 1e-5);
        EXPECT_NEAR(timing.stamp, -10 * begin, 0.001);
        EXPECT_NEAR(std::remainder(timing.cut - cut - 0.05, 2 * M_PI), 0, 0.01);
        EXPECT_EQ(timing.clock, 0);
        expectTimesOf(turn(sign, cut + 0.05, begin), timing, 1e-4);
      }
}

TEST(PointTimes, StampsAtTheBeginAreNotMinusZero) {
  EXPECT_FALSE(std::signbit(estimateOf({turn(1, 1, 0.0001)}).timing().stamp));
}

TEST(PointTimes, StampsOutsideTheTurnBecomeAnOffsetOfTheClock) {
  const RosCloud scan = turn(1, 1, -0.12, 0.1);  // stamped 20 ms after the end of the turn
  const ScanTiming timing = estimateOf({scan}).timing();
  EXPECT_EQ(timing.stamp, 1);
  EXPECT_NEAR(timing.clock, -0.02, 1e-4);
  expectTimesOf(scan, timing, 1e-4);
}

TEST(PointTimes, FalsePointsAreLeftAside) {
  RosCloud scan = turn(-1, 2, 0);
  for (std::size_t i = 0; i < scan.cloud.size(); i += 25) scan.cloud.y[i] = -scan.cloud.y[i];
  scan.offsets[7] = 3;
  const ScanTiming timing = estimateOf({scan}).timing();
  EXPECT_EQ(timing.turn, Turn::clockwise);
  EXPECT_NEAR(timing.seconds, 0.1, 5e-4);
  EXPECT_NEAR(timing.stamp, 0, 0.005);
  EXPECT_NEAR(timing.cut, 2, 0.03);
}

TEST(PointTimes, SaysWhyNothingIsFound) {
  const auto expectNone = [](const std::vector<RosCloud>& scans, const std::string& why) {
    const auto estimate = estimateOf(scans);
    EXPECT_EQ(estimate.timing().turn, Turn::automatic);
    expectIn(estimate.note(), "when points were measured is not known: ", why);
  };
  RosCloud scan = turn(1, 0, 0);
  const RosCloud good = scan;
  scan.offsets.assign(scan.offsets.size(), 0.5);
  expectNone({scan}, "no times of their own, or one for all");
  scan.offsets.clear();
  expectNone({scan}, "no times of their own, or one for all");
  scan = good;
  for (float& y : scan.cloud.y) y = std::abs(y);
  expectNone({scan}, "no scan is a full turn");
  scan = good;
  for (std::size_t i = 0; i < scan.offsets.size(); ++i)
    scan.offsets[i] = 0.1 * static_cast<double>(i * 7919 % 1800) / 1800;
  expectNone({good, scan}, "do not follow their azimuths");
  expectNone({good, mixed(turn(1, 1, 0))},
             "begin at different azimuths or have more than a turn, and their points are not in");
  expectNone({good, turn(-1, 0, 0)}, "turn in different ways");
  expectNone({turn(1, 0, 0, 100)}, "turns of 100 s; uint32 in ns, float32 and float64 in s");
  expectNone({turn(1, 0, 0, 0.0001)}, "turns of 0.0001 s");
  expectNone({turn(1, 0, 4000)}, "far from the stamps");
}

// As of a driver that cuts after a number of packets: seen in the first scans only if it moves
// fast.
TEST(PointTimes, ScansThatBeginAtAMovingAzimuth) {
  TimingEstimate estimate;
  for (int i = 0; i < 5; ++i) estimate.add(turn(-1, 2 - 0.05 * i, 0));
  EXPECT_TRUE(estimate.complete());
  EXPECT_FALSE(estimate.timing().movingCut);
  estimate.add(turn(-1, 2 - 0.05 * 40, 0));
  const ScanTiming timing = estimate.timing();
  EXPECT_TRUE(timing.movingCut);
  EXPECT_EQ(timing.turn, Turn::clockwise);
  EXPECT_NEAR(timing.seconds, 0.1, 1e-5);
  EXPECT_NEAR(timing.stamp, 0, 0.001);
  expectIn(estimate.note(), "clockwise, each from its first point on, stamped at 0 of the turn");
}

/// A turn, and more of the next one.
RosCloud longScan(double begin) {
  RosCloud scan = turn(-1, 2, begin);
  const RosCloud next = turn(-1, 2, begin + 0.1);
  const std::size_t more = next.cloud.size() / 8;
  const auto add = [&](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.begin() + static_cast<std::ptrdiff_t>(more));
  };
  add(scan.cloud.x, next.cloud.x);
  add(scan.cloud.y, next.cloud.y);
  add(scan.cloud.z, next.cloud.z);
  add(scan.cloud.intensity, next.cloud.intensity);
  add(scan.offsets, next.offsets);
  return scan;
}

TEST(PointTimes, ScansOfMoreThanATurn) {
  for (const double stamp : {0.0, 0.5, 1.0}) {
    const TimingEstimate estimate =
        estimateOf({longScan(-0.1125 * stamp), longScan(-0.1125 * stamp)});
    const ScanTiming timing = estimate.timing();
    EXPECT_EQ(timing.turn, Turn::clockwise) << estimate.note();
    EXPECT_NEAR(timing.seconds, 0.1, 1e-5);
    EXPECT_TRUE(timing.movingCut);
    EXPECT_NEAR(timing.stamp, stamp, 0.005) << "of the scan";
  }
  RosCloud backwards = longScan(0);
  for (auto* values : {&backwards.cloud.x, &backwards.cloud.y})
    std::reverse(values->begin(), values->end());
  std::reverse(backwards.offsets.begin(), backwards.offsets.end());
  EXPECT_FALSE(estimateOf({backwards}).timing().known()) << "its first point was measured last";
}

// Points that are not in the order of measuring, and a cut that moves slowly.
TEST(PointTimes, ALaterScanRefutesATiming) {
  TimingEstimate estimate;
  for (int i = 0; i < 5; ++i) estimate.add(mixed(turn(-1, 2 - 0.02 * i, 0)));
  EXPECT_TRUE(estimate.timing().known());
  EXPECT_FALSE(estimate.timing().movingCut);
  estimate.add(mixed(turn(-1, 2 - 0.02 * 25, 0)));
  EXPECT_EQ(estimate.timing().turn, Turn::automatic);
  expectIn(estimate.note(), "begin at different azimuths", "not in the order of measuring");
  for (int i = 0; i < 5; ++i) estimate.add(mixed(turn(-1, 2, 0)));
  EXPECT_FALSE(estimate.timing().known());  // it stays refuted
}

TEST(PointTimes, WhatTheFirstScansDoNotTellLaterOnesDoNot) {
  TimingEstimate estimate;
  RosCloud untimed = turn(1, 0, 0);
  untimed.offsets.clear();
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(estimate.complete());
    estimate.add(untimed);
  }
  EXPECT_TRUE(estimate.complete());
  estimate.add(turn(1, 0, 0));
  EXPECT_FALSE(estimate.timing().known());
}

TEST(PointTimes, PartialScansAreNotUsed) {
  RosCloud half = turn(1, 0, 0);
  for (auto* values : {&half.cloud.x, &half.cloud.y, &half.cloud.z, &half.cloud.intensity})
    values->resize(900);
  half.offsets.resize(900);
  const auto estimate = estimateOf({half, turn(1, 0, 0)});
  EXPECT_EQ(estimate.timing().turn, Turn::counterclockwise);
  EXPECT_FALSE(estimate.complete());
  expectIn(estimate.note(), "turns of 0.1 s, counterclockwise, cut at", "stamped at 0 of the turn");
}

}  // namespace
}  // namespace polemcl::test_point_times
