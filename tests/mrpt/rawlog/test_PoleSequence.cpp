#include <gtest/gtest.h>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <cmath>
#include <numeric>
#include <thread>

#include "support/ExpectHas.h"
#include "support/Refusal.h"
#include "support/SequenceFiles.h"

namespace polemcl::test_pole_sequence {
namespace {

using namespace tests::sequence;
using PoleSequenceTest = BenchTest;

TEST_F(PoleSequenceTest, StoredPolesWithActions) {
  const auto sequence = bench.read(action({9, 9, 1}) + frame(poles(10.5)) + action({1, 0.5, 0.1}) +
                                   frame(poles(11, 6)));
  ASSERT_EQ(sequence.frames.size(), 2u);
  expectMotion(sequence.frames[0], 0, 0, 0);  // motions before the first scan are ignored
  EXPECT_TRUE(sequence.frames[0].motion->covariance.isZero());
  expectMotion(sequence.frames[1], 1, 0.5, 0.1);
  EXPECT_NEAR(sequence.frames[1].motion->covariance(1, 1), 0.02, 1e-12);
  EXPECT_NEAR(sequence.frames[1].time, 11, 1e-6);
  ASSERT_EQ(sequence.frames[1].poles_robot.size(), 2u);
  EXPECT_NEAR(sequence.frames[1].poles_robot[0].y, 8, 1e-9);  // 2 + 6 to the left
  EXPECT_EQ(sequence.frames[1].points, 1234u);
  EXPECT_EQ(sequence.counts.scans, 2u);
  EXPECT_EQ(sequence.counts.storedScans, 2u);
  EXPECT_EQ(sequence.counts.poles, 4u);
  EXPECT_EQ(sequence.counts.emptyScans, 0u);
  EXPECT_EQ(sequence.counts.unknownMotions, 0u);
}

TEST_F(PoleSequenceTest, ObservationsFromElsewhereGiveTheSameFrames) {
  bench.read(frame(poles(10.5)) + action({1, 0.5, 0.1}) + frame(poles(11, 6)));
  std::size_t scans = 0;
  streamPoles(bench.path, options(), [&](const ReadScan& scan) {
    const PoleScan streamed = frameOf(scan), own = frameOf(*scan.observation, scan.motion);
    EXPECT_EQ(own.time, streamed.time);
    EXPECT_EQ(own.motion->mean.y, scans == 0 ? 0 : 0.5);
    ASSERT_EQ(own.poles_robot.size(), streamed.poles_robot.size());
    EXPECT_EQ(own.poles_robot[0].y, streamed.poles_robot[0].y);
    EXPECT_EQ(own.pose_robot_sensor.y, streamed.pose_robot_sensor.y);
    EXPECT_EQ(own.points, 0u);
    ++scans;
  });
  EXPECT_EQ(scans, 2u);
}

TEST_F(PoleSequenceTest, SeveralActionsAreComposed) {
  const auto sequence =
      bench.read(frame(poles(1)) + action({1, 0, M_PI / 2}) + action({2, 0, 0}) + frame(poles(2)));
  ASSERT_EQ(sequence.frames.size(), 2u);
  expectMotion(sequence.frames[1], 1, 2, M_PI / 2);
  const PoseWithCovariance a{{1, 0, M_PI / 2}, Eigen::Vector3d(0.01, 0.02, 0.03).asDiagonal()};
  const PoseWithCovariance b{{2, 0, 0}, Eigen::Vector3d(0.01, 0.02, 0.03).asDiagonal()};
  EXPECT_NEAR((sequence.frames[1].motion->covariance - io::composeMotions(a, b).covariance).norm(),
              0, 1e-9);
}

TEST_F(PoleSequenceTest, CovarianceFactorAppliesToActions) {
  auto o = options();
  o.motion.covarianceFactor = 4;
  const auto sequence = bench.read(frame(poles(1)) + action({1, 0, 0}) + frame(poles(2)), o);
  EXPECT_NEAR(sequence.frames[1].motion->covariance(0, 0), 0.04, 1e-12);
}

// The default emOdometry is rebuilt from the file by a motion model; the reading must be kept.
TEST_F(PoleSequenceTest, OdometryActionsGiveTheirReading) {
  for (const auto model : {CActionRobotMovement2D::mmGaussian, CActionRobotMovement2D::mmThrun}) {
    CActionRobotMovement2D::TMotionModelOptions motionModel;
    motionModel.modelSelection = model;
    motionModel.thrunModel.nParticlesCount = 20;
    CActionRobotMovement2D move;
    move.computeFromOdometry(CPose2D(0.8, 0.1, 0.2), motionModel);
    CActionCollection actions;
    actions.insert(move);
    const auto sequence = bench.read(frame(poles(1)) + samples::bytesOf(actions) + frame(poles(2)));
    expectMotion(sequence.frames[1], 0.8, 0.1, 0.2);
    const Eigen::Matrix3d C = sequence.frames[1].motion->covariance;
    if (model == CActionRobotMovement2D::mmGaussian) {
      const auto stored = std::get<0>(move.poseChange->getCovarianceAndMean());
      EXPECT_NEAR((C - stored.asEigen()).norm(), 0, 1e-9);
    } else {  // samples: a different covariance on every run
      EXPECT_NEAR((C - motionCovariance({0.8, 0.1, 0.2}, MotionOptions())).norm(), 0, 1e-12);
    }
  }
}

TEST_F(PoleSequenceTest, SpatialActionsArePlanar) {
  CActionRobotMovement3D move;
  move.estimationMethod = CActionRobotMovement3D::emVisualOdometry;
  move.poseChange.mean = mrpt::poses::CPose3D(1, 2, 3, 0.4, 0, 0);
  move.poseChange.cov.setZero();
  for (int i = 0; i < 6; ++i) move.poseChange.cov(i, i) = 0.01 * (i + 1);
  CActionCollection actions;
  actions.insert(move);
  const auto sequence = bench.read(frame(poles(1)) + samples::bytesOf(actions) + frame(poles(2)));
  expectMotion(sequence.frames[1], 1, 2, 0.4);
  EXPECT_NEAR(sequence.frames[1].motion->covariance(2, 2), 0.04, 1e-9);  // yaw
}

TEST_F(PoleSequenceTest, WithoutOdometryTheMotionIsUnknown) {
  const auto sequence =
      bench.read(frame(poles(1)) + frame(poles(2)) + action({1, 0, 0}) + frame(poles(3)));
  ASSERT_EQ(sequence.frames.size(), 3u);
  EXPECT_TRUE(sequence.frames[0].motion);
  EXPECT_FALSE(sequence.frames[1].motion);
  expectMotion(sequence.frames[2], 1, 0, 0);
  EXPECT_EQ(sequence.counts.unknownMotions, 1u);
}

// A straight drive at 2 m/s, odometry at 10 Hz, scans at other times.
TEST_F(PoleSequenceTest, BareOdometryIsInterpolated) {
  std::string bytes;
  for (int i = 0; i < 30; ++i) {
    bytes += odometry(100 + 0.1 * i, {0.2 * i, 1, 0});
    if (i % 10 == 4) bytes += samples::bytesOf(poles(100 + 0.1 * i + 0.003 * i));
  }
  const auto sequence = bench.read(bytes);
  ASSERT_EQ(sequence.frames.size(), 3u);  // at 100.412, 101.442 and 102.472 s
  expectMotion(sequence.frames[1], 2.06, 0, 0);
  expectMotion(sequence.frames[2], 2.06, 0, 0);
  const Eigen::Matrix3d expected = motionCovariance({2.06, 0, 0}, MotionOptions());
  EXPECT_NEAR((sequence.frames[1].motion->covariance - expected).norm(), 0, 1e-6);
}

TEST_F(PoleSequenceTest, ScansInAGapOfTheOdometryAreLeftOut) {
  std::string bytes;
  for (int i = 0; i <= 80; ++i) {
    if (i <= 20 || i >= 50) bytes += odometry(100 + 0.1 * i, {0.2 * i, 1, 0});
    if (i % 10 == 5) bytes += samples::bytesOf(poles(100 + 0.1 * i));
  }
  const auto sequence = bench.read(bytes);  // without those at 102.5, 103.5 and 104.5 s
  expectMotion(sequence.frames.at(2), 8, 0, 0);
}

// As MRPT's rawlogs of frames are: an action that holds no motion comes before each.
TEST_F(PoleSequenceTest, ActionsWithoutAMotionDoNotKeepScansFromLaterOdometry) {
  const std::string empty = samples::bytesOf(CActionCollection());
  std::string bytes;
  for (int i = 0; i < 10; ++i)  // 2 m a second, then 4
    bytes += empty + odometry(100 + i, {i < 5 ? 2.0 * i : 4.0 * i - 10, 0, 0}) +
             frame(poles(100.25 + i));
  const auto sequence = bench.read(bytes);
  ASSERT_EQ(sequence.frames.size(), 10u);
  expectMotion(sequence.frames[5], 2.5, 0, 0);  // to 105.25 s
}

TEST_F(PoleSequenceTest, OdometryThatTurns) {
  const auto sequence = bench.read(odometry(0, {3, 4, M_PI / 2}) + samples::bytesOf(poles(0)) +
                                   odometry(2, {3, 6, M_PI}) + samples::bytesOf(poles(2)));
  expectMotion(sequence.frames[1], 2, 0, M_PI / 2);
}

TEST_F(PoleSequenceTest, OdometryFarFromTheScanIsUnknown) {
  const auto sequence = bench.read(samples::bytesOf(poles(1)) + samples::bytesOf(poles(2)) +
                                   odometry(2.4, {0, 0, 0}) + odometry(3, {1, 0, 0}) +
                                   samples::bytesOf(poles(3)) + samples::bytesOf(poles(5)));
  ASSERT_EQ(sequence.frames.size(), 4u);
  EXPECT_FALSE(sequence.frames[1].motion);
  // The first motion went on in the 0.4 s before the first reading.
  expectMotion(sequence.frames[2], 1 + 0.4 / 0.6, 0, 0);
  EXPECT_FALSE(sequence.frames[3].motion);
  EXPECT_EQ(sequence.counts.unknownMotions, 2u);
}

// A vehicle does not stand still because its odometry begins a little late, or ends early.
TEST_F(PoleSequenceTest, BeyondTheOdometryTheVehicleDrivesOn) {
  for (const int rate : {1, 10}) {  // readings a scan
    std::string bytes;
    for (int i = 0; i <= 20; ++i) {
      for (int k = 0; k < rate; ++k) {
        const double at = i + static_cast<double>(k) / rate;
        if (i >= 4 && i <= 16) bytes += odometry(0.1 * at + 0.05, {0.5 * at, 0, 0.02 * at});
      }
      bytes += samples::bytesOf(poles(0.1 * i));
    }
    const auto sequence = bench.read(bytes);
    ASSERT_EQ(sequence.frames.size(), 21u);
    EXPECT_EQ(sequence.counts.unknownMotions, 0u);
    for (std::size_t i = 1; i < 21; ++i) {
      const Pose2D& motion = sequence.frames[i].motion->mean;
      EXPECT_NEAR(std::hypot(motion.x, motion.y), 0.5, 2e-3) << i;
      EXPECT_NEAR(motion.yaw, 0.02, 1e-6) << i;
    }
  }
}

// A pulse of an encoder just before the end is no speed.
TEST_F(PoleSequenceTest, ReadingsCloseToEachOtherTellNoSpeed) {
  std::string bytes;
  for (int i = 0; i <= 10; ++i) bytes += odometry(0.1 * i, {0.1 * i, 0, 0});
  bytes += odometry(1.001, {1.05, 0, 0});
  for (const double time : {0.5, 1.4}) bytes += samples::bytesOf(poles(time));
  const auto sequence = bench.read(bytes);
  ASSERT_EQ(sequence.frames.size(), 2u);
  EXPECT_NEAR(sequence.frames[1].motion->mean.x, 0.55 + 0.399 * 1.5, 0.02);
}

TEST_F(PoleSequenceTest, OfSeveralOdometriesTheFirstIsUsed) {
  const auto wheels = [](const std::string& label, double time, double x) {
    mrpt::obs::CObservationOdometry reading;
    reading.sensorLabel = label;
    reading.timestamp = mrpt::Clock::fromDouble(time);
    reading.odometry = mrpt::poses::CPose2D(x, 0, 0);
    return samples::bytesOf(reading);
  };
  std::string bytes;
  for (int i = 0; i < 10; ++i)
    bytes +=
        wheels("wheels", i, 2 * i) + wheels("camera", i, 1000 + i) + samples::bytesOf(poles(i));
  const auto sequence = bench.read(bytes);
  ASSERT_EQ(sequence.frames.size(), 10u);
  for (std::size_t i = 1; i < 10; ++i) expectMotion(sequence.frames[i], 2, 0, 0);
  EXPECT_EQ(sequence.counts.odometryJumps, 0u);
  EXPECT_EQ(sequence.counts.otherSensors, 0u);
  EXPECT_EQ(sequence.counts.otherOdometry, (std::set<std::string>{"camera"}));
}

TEST_F(PoleSequenceTest, ManyScansWithoutOdometryDoNotPileUp) {
  std::string bytes;
  for (int i = 0; i < 100; ++i) bytes += samples::bytesOf(poles(i));
  const auto sequence = bench.read(bytes);
  EXPECT_EQ(sequence.frames.size(), 100u);
  EXPECT_EQ(sequence.counts.unknownMotions, 99u);
}

TEST_F(PoleSequenceTest, ExtractsClouds) {
  const auto sequence = bench.read(action({0, 0, 0}) + frame(cloud(1, 0)) + action({0.5, 0, 0}) +
                                   frame(cloud(2, 0.5)));
  ASSERT_EQ(sequence.frames.size(), 2u);
  EXPECT_EQ(sequence.counts.storedScans, 0u);
  ObservationPoleExtractor extraction(options().extraction);
  const auto expected = extraction.process(cloud(2, 0.5))->polesInRobotFrame();
  ASSERT_GE(expected.size(), 4u);
  ASSERT_EQ(sequence.frames[1].poles_robot.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(sequence.frames[1].poles_robot[i].x, expected[i].x);
  EXPECT_EQ(sequence.frames[1].points, extraction.report().points);
}

// Scans with very different run times, on any number of threads: the same frames in the same order.
TEST_F(PoleSequenceTest, ThreadsDoNotMatter) {
  std::string bytes;
  for (int i = 0; i < 24; ++i)
    bytes += action({0.1, 0, 0}) +
             (i % 3 == 1 ? frame(emptyCloud(i + 1)) : frame(cloud(i + 1, 0.1 * i)));
  std::vector<PoleSequence> results;
  for (const int threads : {1, 2, 5}) {
    auto o = options();
    o.threads = threads;
    results.push_back(bench.read(bytes, o));
  }
  for (const auto& result : results) {
    ASSERT_EQ(result.frames.size(), 24u);
    EXPECT_EQ(result.counts.emptyScans, 8u);
    EXPECT_EQ(result.counts.poles, results[0].counts.poles);
    for (std::size_t i = 0; i < 24; ++i) {
      const auto &a = result.frames[i], &b = results[0].frames[i];
      EXPECT_NEAR(a.time, static_cast<double>(i) + 1, 1e-6);
      ASSERT_EQ(a.poles_robot.size(), b.poles_robot.size());
      for (std::size_t k = 0; k < a.poles_robot.size(); ++k) {
        EXPECT_EQ(a.poles_robot[k].x, b.poles_robot[k].x);
        EXPECT_EQ(a.poles_robot[k].covariance, b.poles_robot[k].covariance);
      }
    }
  }
}

TEST_F(PoleSequenceTest, RefusesRawlogsOfPlanarScansAndSaysWhy) {
  mrpt::obs::CObservation2DRangeScan planar;
  planar.timestamp = mrpt::Clock::fromDouble(1);
  const std::string message = bench.refusal(samples::bytesOf(planar));
  EXPECT_HAS(message, "from a mrpt::obs::CObservation2DRangeScan: one plane does not show");
  EXPECT_HAS(message, bench.path);
  EXPECT_EQ(bench.read(samples::bytesOf(planar) + frame(poles(2))).frames.size(), 1u);
}

TEST_F(PoleSequenceTest, EmptyScansStayFrames) {
  CObservationPointCloud nothing;
  nothing.timestamp = mrpt::Clock::fromDouble(7);
  CObservationPointCloud invalid = nothing;
  auto points = mrpt::maps::CPointsMapXYZI::Create();
  points->resize(5);
  for (int i = 0; i < 5; ++i) points->setPointFast(i, 0, 0, 0);
  invalid.pointcloud = points;
  const auto sequence = bench.read(frame(nothing) + frame(invalid));
  ASSERT_EQ(sequence.frames.size(), 2u);
  EXPECT_EQ(sequence.counts.emptyScans, 2u);
  EXPECT_EQ(sequence.counts.invalidPoints, 5u);
  EXPECT_EQ(sequence.counts.points, 0u);
  EXPECT_TRUE(sequence.frames[1].poles_robot.empty());
}

TEST_F(PoleSequenceTest, OneSensorOnly) {
  CObservationPoles other = poles(1.5);
  other.sensorLabel = "REAR";
  const auto sequence = bench.read(frame(poles(1)) + frame(other) + frame(poles(2)));
  EXPECT_EQ(sequence.frames.size(), 2u);
  EXPECT_EQ(sequence.counts.otherSensors, 1u);
}

TEST_F(PoleSequenceTest, PrefersPolesToTheCloudTheyCameFrom) {
  CSensoryFrame both;
  both.insert(std::make_shared<CObservationPointCloud>(cloud(1, 0)));
  both.insert(std::make_shared<CObservationPoles>(poles(1)));
  const auto sequence = bench.read(samples::bytesOf(both));
  ASSERT_EQ(sequence.frames.size(), 1u);
  EXPECT_EQ(sequence.counts.storedScans, 1u);
  EXPECT_EQ(sequence.counts.otherSensors, 1u);
}

TEST_F(PoleSequenceTest, TruncatedFiles) {
  const std::string bytes = frame(poles(1)) + frame(poles(2));
  EXPECT_HAS(bench.refusal(bytes.substr(0, bytes.size() - 10)), "truncated");
  auto o = options();
  o.allowTruncated = true;
  const auto sequence = bench.read(bytes.substr(0, bytes.size() - 10), o);
  EXPECT_EQ(sequence.frames.size(), 1u);
  EXPECT_TRUE(sequence.counts.truncated);
  EXPECT_FALSE(bench.read(bytes, o).counts.truncated);
}

// For any length of the rawlog, only the scans in process are in memory.
TEST_F(PoleSequenceTest, ScansAreLetGoOnceTheyAreConsumed) {
  std::string bytes;
  for (int i = 0; i < 300; ++i)
    bytes += action({0.1, 0, 0}) + (i % 2 ? frame(poles(i + 1)) : frame(poles(i + 1, 7)));
  bench.read(bytes);
  for (const int threads : {1, 2}) {
    auto o = options();
    o.threads = threads;
    std::vector<std::weak_ptr<CObservationPoles>> consumed;
    std::size_t alive = 0;
    streamPoles(bench.path, o, [&](const ReadScan& scan) {
      // One may still be leaving the pipeline.
      for (std::size_t i = 0; i + 1 < consumed.size(); ++i) alive += !consumed[i].expired();
      consumed.push_back(scan.observation);
    });
    EXPECT_EQ(consumed.size(), 300u);
    EXPECT_EQ(alive, 0u);
  }
}

TEST_F(PoleSequenceTest, ThePaceSeesEachScanInOrderBeforeItIsConsumed) {
  std::string bytes;
  for (int i = 0; i < 20; ++i) bytes += frame(poles(i + 1));
  bench.read(bytes);
  std::vector<double> asked;
  const ScanClock::time_point begin = ScanClock::now();
  auto o = options();
  o.pace = [&](double time, const auto&) {
    asked.push_back(time);
    return begin + std::chrono::seconds(asked.size());
  };
  std::size_t consumed = 0;
  streamPoles(bench.path, o, [&](const ReadScan& scan) {
    EXPECT_EQ(scan.arrival, begin + std::chrono::seconds(++consumed));
    EXPECT_GE(scan.readSeconds, 0);
  });
  ASSERT_EQ(asked.size(), 20u);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_NEAR(asked[i], double(i + 1), 1e-6);
  o.pace = [](double, const auto&) -> ScanClock::time_point { throw std::domain_error("enough"); };
  EXPECT_THROW(streamPoles(bench.path, o, [](const ReadScan&) {}), std::domain_error);
}

/// \return Whether the failure of the first scan ends the work before the waits do, 60 s later.
bool endsSoon(const std::string& rawlog, const SequenceOptions& options) {
  const auto begin = ScanClock::now();
  const auto fail = [](const ReadScan&) {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));  // the next read waits by then
    throw Error("enough");
  };
  EXPECT_THROW(streamPoles(rawlog, options, fail), Error);
  return ScanClock::now() - begin < std::chrono::seconds(30);
}

TEST_F(PoleSequenceTest, AFailureEndsTheWaits) {
  bench.read(frame(poles(1)) + action({1, 0, 0}) + frame(poles(2)));
  auto paced = options();
  paced.pace = [](double time, const auto& goesOn) {
    const auto end = ScanClock::now() + std::chrono::seconds(time > 1.5 ? 60 : 0);
    while (goesOn() && ScanClock::now() < end)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return ScanClock::now();
  };
  EXPECT_TRUE(endsSoon(bench.path, paced));
  auto followed = options();
  followed.follow = 60;
  EXPECT_TRUE(endsSoon(bench.path, followed));
}

// The first error of the file is reported, after the scans before it, with any number of threads.
TEST_F(PoleSequenceTest, ErrorsComeInTheirPlace) {
  using Format = CObservationPointCloud::ExternalStorageFormat;
  CObservationPointCloud first, second;
  first.setAsExternalStorage(bench.folder / "first.bin", Format::KittiBinFile);
  second.setAsExternalStorage(bench.folder / "second.bin", Format::KittiBinFile);
  std::string bytes = frame(cloud(1, 0)) + frame(first) + frame(second);
  for (int i = 0; i < 10; ++i) bytes += frame(second);
  bytes.resize(bytes.size() - 5);
  std::ofstream(bench.path, std::ios::binary).write(bytes.data(), static_cast<long>(bytes.size()));
  for (const int threads : {1, 4}) {
    auto o = options();
    o.threads = threads;
    std::size_t handedOut = 0;
    const std::string text = tests::messageOf(
        [&] { streamPoles(bench.path, o, [&](const ReadScan&) { ++handedOut; }); });
    EXPECT_EQ(handedOut, 1u);
    EXPECT_HAS(text, "s.rawlog: scan 1: ");
    EXPECT_HAS(text, "first.bin");
  }
}

TEST_F(PoleSequenceTest, WhatTheConsumerThrowsComesThrough) {
  bench.read(frame(poles(1)) + frame(poles(2)));
  EXPECT_THROW(streamPoles(bench.path, options(),
                           [](const ReadScan&) { throw std::domain_error("enough"); }),
               std::domain_error);
}

TEST_F(PoleSequenceTest, RelativeExternalFiles) {
  using Format = CObservationPointCloud::ExternalStorageFormat;
  std::filesystem::create_directory(bench.folder / "s_Images");
  CObservationPointCloud external;
  external.setAsExternalStorage("0.bin", Format::KittiBinFile);
  for (const char* place : {"0.bin", "s_Images/0.bin"}) {
    std::filesystem::remove_all(bench.folder / "s_Images");
    std::filesystem::create_directories(std::filesystem::path(bench.folder / place).parent_path());
    const float point[4] = {5, 0, 0, 0};
    std::ofstream(bench.folder / place, std::ios::binary)
        .write(reinterpret_cast<const char*>(point), sizeof point);
    EXPECT_EQ(bench.read(frame(external)).counts.points, 1u) << place;
    std::filesystem::remove(bench.folder / place);
  }
}

TEST_F(PoleSequenceTest, RefusesBadMotions) {
  EXPECT_HAS(bench.refusal(frame(poles(1)) + action({std::nan(""), 0, 0}) + frame(poles(2))),
             "before scan 1: the odometry is not finite");
  EXPECT_HAS(bench.refusal(frame(poles(1)) + action({1, 0, 0}, -0.01) + frame(poles(2))),
             "before scan 1: the covariance of the odometry is not positive semidefinite");
}

TEST_F(PoleSequenceTest, RefusesScansWithoutTimeOrSensorPose) {
  CObservationPoles scan = poles(1);
  scan.timestamp = INVALID_TIMESTAMP;
  EXPECT_HAS(bench.refusal(frame(scan)), "scan 0 has no time");
  scan = poles(1);
  scan.setSensorPose(mrpt::poses::CPose3D(NAN, 0, 0, 0, 0, 0));
  EXPECT_HAS(bench.refusal(frame(scan)), "scan 0: the sensor pose of its poles is not a finite");
}

TEST_F(PoleSequenceTest, RefusesBadOptions) {
  const std::string bytes = frame(poles(1));
  auto o = options();
  o.threads = -1;
  EXPECT_HAS(bench.refusal(bytes, o), "threads = -1");
  o = options();
  o.motion.xyPerMetre = -1;
  EXPECT_HAS(bench.refusal(bytes, o), "xy_per_m");
  o = options();
  o.extraction.sensor.model = "none";
  EXPECT_HAS(bench.refusal(bytes, o), "model");
}

TEST_F(PoleSequenceTest, ReportsProgress) {
  bench.read(frame(poles(1)) + frame(poles(2)) + frame(poles(3)));
  std::vector<std::size_t> calls;
  readPoleSequence(bench.path, options(),
                   [&](std::size_t done, std::size_t) { calls.push_back(done); });
  EXPECT_EQ(calls, (std::vector<std::size_t>{1, 2, 3}));
}

TEST_F(PoleSequenceTest, ExpectsAsManyScansAsTheFileIsLong) {
  CObservationPoles large = poles(1);
  large.visibilityRange.resize(20000);  // few are read ahead by bytes, but many by number
  std::iota(large.visibilityRange.begin(), large.visibilityRange.end(), 0.f);
  const std::string one = samples::bytesOf(large);
  const std::size_t scans = 8'000'000 / one.size();
  std::string bytes;
  for (std::size_t i = 0; i < scans; ++i) bytes += one;
  bench.read(bytes);
  std::size_t atHalf = 0, atEnd = 0;
  readPoleSequence(bench.path, options(), [&](std::size_t done, std::size_t total) {
    if (2 * done == scans || 2 * done == scans + 1) atHalf = total;
    atEnd = total;
  });
  // Reading ahead by at most 0.5 MB makes the estimate slightly too small.
  EXPECT_GT(atHalf, scans * 8 / 10);
  EXPECT_LE(atHalf, scans * 11 / 10);
  EXPECT_EQ(atEnd, scans);
}

}  // namespace
}  // namespace polemcl::test_pole_sequence
