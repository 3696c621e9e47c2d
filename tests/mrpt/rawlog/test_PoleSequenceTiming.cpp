#include <gtest/gtest.h>
#include <mrpt/obs/CObservationComment.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "support/ExpectHas.h"
#include "support/SequenceFiles.h"

namespace polemcl::test_pole_sequence_timing {

using namespace tests::sequence;

TEST(PoleSequenceTiming, TheFirstScanHasTheVelocityToTheSecond) {
  const Bench bench;
  const auto frames = bench
                          .read(action({9, 9, 1}) + frame(poles(10.5)) + action({1, 0, 0.1}) +
                                frame(poles(11)) + action({2, 0, 0}) + frame(poles(11.5)))
                          .frames;
  ASSERT_EQ(frames.size(), 3u);
  ASSERT_TRUE(frames[0].velocity);
  EXPECT_NEAR(frames[0].velocity->yaw, 0.2, 1e-6);
  const Pose2D way = motionAfter(*frames[0].velocity, 0.5);
  EXPECT_NEAR(way.x, 1, 1e-6);
  EXPECT_NEAR(way.y, 0, 1e-6);
  EXPECT_FALSE(frames[1].velocity) << "the motion to it tells";
  EXPECT_FALSE(bench.read(action({0, 0, 0}) + frame(poles(1))).frames[0].velocity);
}

TEST(PoleSequenceTiming, ReadingsAroundAScanGiveItsVelocity) {
  const Bench bench;
  std::string log;
  for (int i = 0; i <= 20; ++i)  // stands, then 10 m/s
    log += odometry(10 + 0.05 * i, {i < 10 ? 0 : 0.5 * (i - 10), 0, 0}) +
           (i == 4 || i == 16 ? samples::bytesOf(poles(10 + 0.05 * i)) : "");
  const auto frames = bench.read(log).frames;
  ASSERT_EQ(frames.size(), 2u);
  ASSERT_TRUE(frames[0].velocity && frames[1].velocity);
  EXPECT_NEAR(frames[0].velocity->x, 0, 1e-6);
  EXPECT_NEAR(frames[1].velocity->x, 10, 1e-6) << "not the mean of the way";
}

TEST(PoleSequenceTiming, TheCommentTellsTheTimesOfPoles) {
  const Bench bench;
  mrpt::obs::CObservationComment comment;
  comment.text = "driven by A. [scan_timing]\nturn = clockwise\nturn_s = 0.2\n";
  const std::string scan = samples::bytesOf(cloud(10, 0));
  const auto frames = bench.read(samples::bytesOf(comment) + scan).frames;
  ASSERT_GE(frames.at(0).poles_robot.size(), 4u);
  for (const PoleDetection& pole : frames[0].poles_robot)
    EXPECT_NEAR(pole.timeOffset, -0.2 * std::atan2(pole.y, pole.x) / (2 * M_PI), 1e-9);
  comment.text = "[scan_timing]\nturn = upwards\n";
  EXPECT_HAS(bench.refusal(samples::bytesOf(comment) + scan), "[scan_timing] turn = upwards");
}

/// Points of a raw scan of the test place, ordered by azimuth from this one on, clockwise.
CObservationPointCloud rawCloud(double time, double begin, double share = 1) {
  CObservationPointCloud scan = cloud(time, 0);
  auto& points = *scan.pointcloud;
  std::vector<std::pair<double, mrpt::math::TPoint3Df>> turn;
  for (std::size_t i = 0; i < points.size(); ++i) {
    mrpt::math::TPoint3Df p;
    points.getPoint(i, p.x, p.y, p.z);
    const double turned = (begin - std::atan2(p.y, p.x)) / (2 * M_PI);
    turn.emplace_back(turned - std::floor(turned), p);
  }
  std::sort(turn.begin(), turn.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < turn.size(); ++i)
    points.setPointFast(i, turn[i].second.x, turn[i].second.y, turn[i].second.z);
  points.resize(static_cast<std::size_t>(share * static_cast<double>(points.size())));
  scan.sensorLabel = "roof";
  return scan;
}

TEST(PoleSequenceTiming, RawScansThatBeginAnywhereAreNoticed) {
  const Bench bench;
  const auto found = [&](double step, const SequenceOptions& o, std::size_t scans = 5) {
    std::string log;
    for (std::size_t i = 0; i < scans; ++i) {
      const auto scan = static_cast<double>(i);
      log += action({1, 0, 0}) + frame(rawCloud(10 + scan, 0.3 + step * scan));
    }
    return bench.read(log, o).counts.untoldTurns;
  };
  const auto turns = found(0.1, options());
  ASSERT_EQ(turns.count("roof"), 1u);
  EXPECT_EQ(turns.at("roof").turn, Turn::clockwise);
  EXPECT_NEAR(turns.at("roof").arc, 0.3, 0.02) << "from the second scan to the fifth";
  EXPECT_TRUE(found(0, options()).empty()) << "a fixed cut";
  EXPECT_TRUE(found(0.3, options(), 3).empty()) << "two scans";
  std::string log;  // ordinals 1, 2, 4, 8 are looked at
  for (int i = 0; i < 9; ++i)
    log += action({1, 0, 0}) + frame(rawCloud(10 + i, 0.3 + 0.1 * i, i == 4 ? 0.6 : 1));
  EXPECT_EQ(bench.read(log, options()).counts.untoldTurns.count("roof"), 1u)
      << "returns are missing in one scan";
  SequenceOptions told = options();
  told.extraction.sensor.timing.turn = Turn::compensated;
  EXPECT_TRUE(found(0.1, told).empty());
}

}  // namespace polemcl::test_pole_sequence_timing
