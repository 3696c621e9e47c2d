// Rawlogs written object by object, for tests of pole sequences.
#pragma once

#include <gtest/gtest.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <fstream>

#include "mrpt/rawlog/PoleSequence.h"
#include "support/ExtractionSamples.h"

namespace polemcl::tests::sequence {

using namespace mrpt::obs;
using mrpt::poses::CPose2D;

inline SequenceOptions options() {
  SequenceOptions o;
  o.extraction.sensor.model = "vlp16";
  o.extraction.sensor.height = 1.2;
  o.extraction.sensor.columns = 900;
  return o;
}

inline mrpt::math::CMatrixDouble33 diagonal(double xx, double yy, double aa) {
  mrpt::math::CMatrixDouble33 C;
  C.setDiagonal(std::vector<double>{xx, yy, aa});
  return C;
}

inline std::string action(const CPose2D& pose, double variance = 0.01) {
  CActionRobotMovement2D move;
  move.estimationMethod = CActionRobotMovement2D::emScan2DMatching;
  move.poseChange =
      mrpt::poses::CPosePDFGaussian::Create(pose, diagonal(variance, 2 * variance, 3 * variance));
  CActionCollection actions;
  actions.insert(move);
  return samples::bytesOf(actions);
}

template <class Observation>
inline std::string frame(const Observation& observation) {
  CSensoryFrame frame;
  frame.insert(std::make_shared<Observation>(observation));
  return samples::bytesOf(frame);
}

inline CObservationPoles poles(double time, double x = 5) {
  CObservationPoles scan = samples::observation();
  scan.timestamp = mrpt::Clock::fromDouble(time);
  scan.poles[0].x = x;
  return scan;
}

/// The test place seen from (x, 0).
inline CObservationPointCloud cloud(double time, double x) {
  const Eigen::Isometry3d T_robot_lidar(Eigen::Translation3d(x, 0, 1.2));
  CObservationPointCloud observation = *samples::observationOf(
      samples::castScan(options().extraction.sensor, T_robot_lidar, samples::testPoles()), {});
  observation.sensorLabel.clear();
  observation.timestamp = mrpt::Clock::fromDouble(time);
  return observation;
}

inline CObservationPointCloud emptyCloud(double time) {
  CObservationPointCloud observation;
  observation.timestamp = mrpt::Clock::fromDouble(time);
  return observation;
}

inline std::string odometry(double time, const CPose2D& pose) {
  CObservationOdometry odo;
  odo.timestamp = mrpt::Clock::fromDouble(time);
  odo.odometry = pose;
  return samples::bytesOf(odo);
}

struct Bench {
  testing_apps::TempFolder folder;
  std::string path = folder / "s.rawlog";
  PoleSequence read(const std::string& bytes, const SequenceOptions& o = options()) const {
    std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<long>(bytes.size()));
    return readPoleSequence(path, o);
  }
  std::string refusal(const std::string& bytes, const SequenceOptions& o = options()) const {
    return tests::messageOf([&] { read(bytes, o); });
  }
};

struct BenchTest : testing::Test {
  const Bench bench{};
};

inline void expectMotion(const PoleScan& frame, double x, double y, double yaw) {
  ASSERT_TRUE(frame.motion);
  EXPECT_NEAR(frame.motion->mean.x, x, 1e-6);
  EXPECT_NEAR(frame.motion->mean.y, y, 1e-6);
  EXPECT_NEAR(frame.motion->mean.yaw, yaw, 1e-6);
}

}  // namespace polemcl::tests::sequence
