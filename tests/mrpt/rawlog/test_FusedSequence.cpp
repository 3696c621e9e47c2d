// Rawlogs with the scans of several LiDARs.

#include <gtest/gtest.h>

#include <cmath>

#include "support/ExpectHas.h"
#include "support/ExtractionSamples.h"
#include "support/SequenceFiles.h"

namespace polemcl::test_fused_sequence {
namespace {

using namespace tests::sequence;
using FusedSequenceTest = BenchTest;
using mrpt::poses::CPose3D;

/// LiDARs `front` and `rear`, both as options() says.
SequenceOptions twoLidars() {
  SequenceOptions o = options();
  for (const char* label : {"front", "rear"})
    o.vehicle.lidars.push_back({label, o.extraction.sensor, o.extraction.extraction});
  return o;
}

/// The test place, robot at (x, 0), by a LiDAR there with this pose.
CObservationPointCloud scan(double time, const std::string& label, const CPose3D& pose, double x) {
  const Eigen::Isometry3d T_robot_lidar = samples::isometry(pose);
  const auto cast =
      samples::castScan(options().extraction.sensor, Eigen::Translation3d(x, 0, 0) * T_robot_lidar,
                        samples::testPoles());
  auto observation = *samples::observationOf(cast, pose);
  observation.sensorLabel = label;
  observation.timestamp = mrpt::Clock::fromDouble(time);
  return observation;
}

const CPose3D kFront(1, 0.3, 1.2, 0.2, 0, 0), kRear(-1, -0.2, 1.2, M_PI, 0, 0);

CObservationPoles stored(double time, const std::string& label) {
  CObservationPoles observation = poles(time);
  observation.sensorLabel = label;
  return observation;
}

/// Distance of the nearest detection from a place, m.
double missedBy(const std::vector<PoleDetection>& poles, double x, double y) {
  double best = 1e9;
  for (const auto& pole : poles) best = std::min(best, std::hypot(pole.x - x, pole.y - y));
  return best;
}

/// 10 m/s; the rear LiDAR is 40 ms behind the front one, so at the stamp the robot is at 0.4 m.
TEST_F(FusedSequenceTest, EachPoleOnceAtTheTimeOfTheLatestScan) {
  std::string bytes;
  for (int i = 0; i < 12; ++i) bytes += odometry(9.5 + 0.1 * i, {-5.0 + i, 0, 0});
  bytes += samples::bytesOf(scan(10, "front", kFront, 0)) +
           samples::bytesOf(scan(10.04, "rear", kRear, 0.4));
  const auto sequence = bench.read(bytes, twoLidars());
  ASSERT_EQ(sequence.frames.size(), 1u);
  const PoleScan& frame = sequence.frames[0];
  EXPECT_NEAR(frame.time, 10.04, 1e-6);
  EXPECT_EQ(frame.poles_robot.size(), samples::testPoles().size());
  auto poles = frame.poles_robot;
  deskew(poles, {10, 0, 0});
  for (const auto& pole : samples::testPoles())
    EXPECT_LT(missedBy(poles, pole.x - 0.4, pole.y), 0.03) << pole.x << " " << pole.y;
  ASSERT_EQ(sequence.counts.lidars.size(), 2u);
  EXPECT_EQ(sequence.counts.lidars[1].label, "rear");
  EXPECT_GE(sequence.counts.lidars[1].shared, 6u);
  EXPECT_LT(sequence.counts.lidars[1].apart, 0.04);
  EXPECT_GT(sequence.counts.lidars[1].apart, 0);
}

TEST_F(FusedSequenceTest, AWrongPoseOrClockShowsInTheDistanceBetweenTheLidars) {
  std::string bytes;
  for (int i = 0; i < 12; ++i) bytes += odometry(9.5 + 0.1 * i, {-5.0 + i, 0, 0});
  bytes += samples::bytesOf(scan(10, "front", kFront, 0)) +
           samples::bytesOf(scan(10.04, "rear", kRear, 0.4));
  const auto right = bench.read(bytes, twoLidars()).counts.lidars[1];
  SequenceOptions turned = twoLidars(), late = twoLidars();
  turned.vehicle.lidars[1].pose = {-1, -0.2, 1.2, 179, 0, 0};
  late.vehicle.lidars[1].sensor.timing.clock = -0.02;
  for (const auto& wrong : {turned, late}) {
    const auto counts = bench.read(bytes, wrong).counts.lidars[1];
    EXPECT_GT(counts.apart, 3 * right.apart);
    EXPECT_GT(counts.apart, 0.1);
    EXPECT_GT(counts.apartSigmas, 3);
  }
}

TEST_F(FusedSequenceTest, ThePoseOfTheSettingsTakesThePlaceOfThatOfTheScan) {
  const std::string bytes =
      samples::bytesOf(scan(10, "front", kFront, 0)) + samples::bytesOf(scan(10, "rear", kRear, 0));
  auto unknown = scan(10, "rear", kRear, 0);
  unknown.sensorPose = CPose3D();
  SequenceOptions o = twoLidars();
  o.vehicle.lidars[1].pose = {-1, -0.2, 1.2, 180, 0, 0};
  const auto expected = bench.read(bytes, twoLidars()).frames[0].poles_robot;
  const auto found =
      bench.read(samples::bytesOf(scan(10, "front", kFront, 0)) + samples::bytesOf(unknown), o)
          .frames[0]
          .poles_robot;
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i].x, expected[i].x, 1e-6);
}

/// Each LiDAR has frames of its own, with an action before each.
TEST_F(FusedSequenceTest, MotionsOfAllScansAddUp) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) {
    bytes += action({0.6, 0, 0}) + frame(stored(1 + 0.1 * i, "front"));
    if (i != 2) bytes += action({0.4, 0, 0}) + frame(stored(1.04 + 0.1 * i, "rear"));
  }
  const auto sequence = bench.read(bytes, twoLidars());
  ASSERT_EQ(sequence.frames.size(), 4u);
  expectMotion(sequence.frames[1], 1, 0, 0);
  expectMotion(sequence.frames[2], 0.6, 0, 0);
  expectMotion(sequence.frames[3], 1, 0, 0);
  EXPECT_EQ(sequence.counts.unknownMotions, 0u);
  EXPECT_EQ(sequence.counts.lidars[0].missing, 0u);
  EXPECT_EQ(sequence.counts.lidars[1].scans, 3u);
  EXPECT_EQ(sequence.counts.lidars[1].missing, 1u);
}

/// The clock of the rear LiDAR is wrong by more than `fuse_within_s`.
TEST_F(FusedSequenceTest, OneActionForBothKeepsThemTogether) {
  std::string bytes;
  for (int i = 0; i < 3; ++i)
    bytes += action({1, 0, 0}) + frame(stored(1 + 0.1 * i, "front")) +
             frame(stored(1.07 + 0.1 * i, "rear"));
  const auto sequence = bench.read(bytes, twoLidars());
  EXPECT_EQ(sequence.frames.size(), 3u);
  EXPECT_EQ(sequence.counts.unknownMotions, 0u);
}

TEST_F(FusedSequenceTest, ALateScanIsDroppedAndItsMotionIsNot) {
  const std::string bytes = action({}) + frame(stored(1, "front")) + action({1, 0, 0}) +
                            frame(stored(1.1, "rear")) + action({1, 0, 0}) +
                            frame(stored(1.0, "rear")) + action({1, 0, 0}) +
                            frame(stored(1.2, "front"));
  const auto sequence = bench.read(bytes, twoLidars());
  ASSERT_EQ(sequence.frames.size(), 3u);
  expectMotion(sequence.frames[1], 1, 0, 0);
  expectMotion(sequence.frames[2], 2, 0, 0);
  EXPECT_EQ(sequence.counts.lidars[1].late, 1u);
}

TEST_F(FusedSequenceTest, PolesThatWereFusedBeforeAreReadAsTheyAre) {
  const auto sequence = bench.read(
      frame(stored(1, "fused")) + action({1, 0, 0}) + frame(stored(1.1, "fused")), twoLidars());
  EXPECT_EQ(sequence.frames.size(), 2u);
  EXPECT_EQ(sequence.frames[0].poles_robot.size(), 2u);
  EXPECT_TRUE(sequence.counts.lidars.empty());
}

TEST_F(FusedSequenceTest, OneListedLidarIsUsedAlone) {
  SequenceOptions o = twoLidars();
  o.vehicle.lidars.erase(o.vehicle.lidars.begin());
  const auto sequence = bench.read(frame(stored(1, "front")) + frame(stored(1.01, "rear")), o);
  EXPECT_EQ(sequence.frames.size(), 1u);
  EXPECT_NEAR(sequence.frames[0].time, 1.01, 1e-6);
  EXPECT_EQ(sequence.counts.otherSensors, 1u);
}

TEST_F(FusedSequenceTest, SaysWhichLidarIsNotInTheRawlog) {
  const std::string end = bench.refusal(
      samples::bytesOf(scan(1, "front", kFront, 0)) + samples::bytesOf(scan(1, "back", kRear, 0)),
      twoLidars());
  EXPECT_HAS(end, "no scan of the LiDAR rear that [vehicle] lidars lists;");
  EXPECT_HAS(end, "CObservationPointCloud back");
  std::string bytes;
  for (int i = 0; i < 80; ++i) bytes += frame(stored(1 + i, "front"));
  EXPECT_HAS(bench.refusal(bytes, twoLidars()), "lists in the first 50 scans");
}

TEST_F(FusedSequenceTest, SaysWhoseScansAreNotUsedWithoutNames) {
  const auto sequence = bench.read(frame(stored(1, "front")) + frame(stored(1.01, "rear")));
  EXPECT_EQ(sequence.frames.size(), 1u);
  EXPECT_EQ(sequence.counts.otherLabels, std::set<std::string>{"polemcl::CObservationPoles rear"});
}

TEST_F(FusedSequenceTest, ErrorsNameTheLidar) {
  SequenceOptions o = twoLidars();
  o.vehicle.lidars[1].sensor.model = "hdl64e";
  const std::string bytes =
      samples::bytesOf(scan(10, "front", kFront, 0)) + samples::bytesOf(scan(10, "rear", kRear, 0));
  EXPECT_HAS(bench.refusal(bytes, o), "scan 0: LiDAR rear: ");
}

TEST_F(FusedSequenceTest, ThreadsDoNotMatter) {
  std::string bytes;
  for (int i = 0; i < 10; ++i)
    bytes += action({0.1, 0, 0}) + frame(scan(1 + 0.1 * i, "front", kFront, 0.1 * i)) +
             frame(scan(1.01 + 0.1 * i, "rear", kRear, 0.1 * i));
  SequenceOptions one = twoLidars(), many = one;
  one.threads = 1;
  const auto a = bench.read(bytes, one), b = bench.read(bytes, many);
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    const auto &p = a.frames[i].poles_robot, &q = b.frames[i].poles_robot;
    ASSERT_EQ(p.size(), q.size());
    for (std::size_t k = 0; k < p.size(); ++k) EXPECT_EQ(p[k].x, q[k].x);
  }
  EXPECT_EQ(a.counts.lidars[1].apart, b.counts.lidars[1].apart);
}

}  // namespace
}  // namespace polemcl::test_fused_sequence
