#pragma once
// Shared by the tests of extraction: clouds as MRPT observations, and the poles found in
// them.

#include <gtest/gtest.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <cmath>
#include <string>
#include <vector>

#include <polemcl/mrpt/observation/ObservationPoleExtractor.h>
#include "support/Refusal.h"
#include "support/Samples.h"
#include "support/TestClouds.h"

namespace polemcl::samples {

inline ObservationPoleExtractorOptions hdl32(double height) {
  ObservationPoleExtractorOptions options;
  options.sensor.model = "hdl32e";
  options.sensor.height = height;
  return options;
}

inline Eigen::Isometry3d isometry(const mrpt::poses::CPose3D& pose) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = pose.getRotationMatrix().asEigen();
  T.translation() = Eigen::Vector3d(pose.x(), pose.y(), pose.z());
  return T;
}

/// The cloud as an MRPT observation, after transforming its points by T_cloud_lidar.
inline mrpt::obs::CObservationPointCloud::Ptr observationOf(
    const TestCloud& cloud, const mrpt::poses::CPose3D& sensorPose,
    const Eigen::Isometry3d& T_cloud_lidar = Eigen::Isometry3d::Identity()) {
  auto observation = mrpt::obs::CObservationPointCloud::Create();
  auto points = mrpt::maps::CPointsMapXYZI::Create();
  points->resize(cloud.x.size());
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    const Eigen::Vector3d p = T_cloud_lidar * Eigen::Vector3d(cloud.x[i], cloud.y[i], cloud.z[i]);
    points->setPointFast(i, static_cast<float>(p.x()), static_cast<float>(p.y()),
                         static_cast<float>(p.z()));
  }
  observation->pointcloud = points;
  observation->sensorPose = sensorPose;
  observation->sensorLabel = "TEST";
  observation->timestamp = mrpt::Clock::fromDouble(1000.5);
  return observation;
}

inline std::vector<PoleDetection> corePoles(const ObservationPoleExtractorOptions& options,
                                            const PointsView& view) {
  PoleExtractor extractor(options.sensor, options.extraction);
  return extractor.extract(view);
}

inline void expectSamePoles(const std::vector<PoleDetection>& a,
                            const std::vector<PoleDetection>& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  ASSERT_GE(a.size(), 3u);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(a[i].x, b[i].x, tolerance);
    EXPECT_NEAR(a[i].y, b[i].y, tolerance);
    EXPECT_NEAR(a[i].radius, b[i].radius, tolerance);
    EXPECT_NEAR(a[i].top, b[i].top, tolerance);
    EXPECT_NEAR((a[i].covariance - b[i].covariance).norm(), 0, tolerance);
  }
}

/// Number of test poles that were found within the tolerance, robot frame.
inline int found(const CObservationPoles& scan, double tolerance) {
  int count = 0;
  const auto poles_robot = scan.polesInRobotFrame();
  for (const auto& truth : testPoles())
    for (const auto& pole : poles_robot)
      if (std::hypot(pole.x - truth.x, pole.y - truth.y) < tolerance) {
        ++count;
        break;
      }
  return count;
}

inline std::string refusal(ObservationPoleExtractor& extraction,
                           const mrpt::obs::CObservation& observation) {
  return tests::messageOf([&] { extraction.process(observation); });
}

inline TestCloud plainCloud(const ObservationPoleExtractorOptions& options) {
  return castScan(options.sensor,
                  Eigen::Isometry3d(Eigen::Translation3d(0, 0, options.sensor.height)),
                  testPoles());
}

}  // namespace polemcl::samples
