#include <gtest/gtest.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <map>
#include <numeric>

#include "core/common/Angles.h"
#include "support/ExpectHas.h"
#include "support/ExtractionSamples.h"

namespace polemcl::test_observation_pole_extractor {
namespace {

using mrpt::poses::CPose3D;
using namespace mrpt::obs;
using namespace samples;

// Sensor at the robot's origin, level: no transformation; the poles equal the core's, bit for bit.
TEST(ObservationPoleExtractor, LevelCloudsGoThroughUntouched) {
  const auto options = hdl32(1.5);
  const TestCloud cloud = plainCloud(options);
  ObservationPoleExtractor extraction(options);
  const auto scan = extraction.process(*observationOf(cloud, CPose3D()));
  expectSamePoles(scan->poles, corePoles(options, cloud.view()), 0);
  EXPECT_EQ(scan->sensorLabel, "TEST");
  EXPECT_EQ(scan->timestamp, mrpt::Clock::fromDouble(1000.5));
  EXPECT_EQ(scan->points, cloud.x.size());
  EXPECT_EQ(extraction.report().points, cloud.x.size());
  EXPECT_GE(found(*scan, 0.05), 6);
}

/// The share of a turn clockwise from `begin` to a place.
double turnedTo(double begin, double x, double y) {
  const double share = (begin - std::atan2(y, x)) / (2 * M_PI);
  return share - std::floor(share);
}

/// The same points in another order: smallest value first.
TestCloud sorted(const TestCloud& cloud,
                 const std::function<double(float x, float y, float z)>& value) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < cloud.x.size(); ++i)
    order.emplace_back(value(cloud.x[i], cloud.y[i], cloud.z[i]), i);
  std::sort(order.begin(), order.end());
  TestCloud result = cloud;
  for (std::size_t i = 0; i < order.size(); ++i) {
    result.x[i] = cloud.x[order[i].second];
    result.y[i] = cloud.y[order[i].second];
    result.z[i] = cloud.z[order[i].second];
  }
  return result;
}

TEST(ObservationPoleExtractor, AMovingCutIsAtTheFirstPoint) {
  auto options = hdl32(1.5);
  options.sensor.timing = {Turn::clockwise, 0.1, M_PI, 0, 0, true};
  const TestCloud cloud = plainCloud(options);
  ObservationPoleExtractor extraction(options);
  const auto process = [&](const std::function<double(float x, float y, float z)>& value) {
    return extraction.process(*observationOf(sorted(cloud, value), CPose3D()));
  };
  for (const double begin : {0.3, -2.5}) {
    const auto scan = process([&](float x, float y, float) { return turnedTo(begin, x, y); });
    EXPECT_GE(scan->poles.size(), 6u);
    for (const PoleDetection& pole : scan->poles)
      EXPECT_NEAR(std::remainder(pole.timeOffset - 0.1 * turnedTo(begin, pole.x, pole.y), 0.1), 0,
                  1e-3);
  }
  EXPECT_THROW(process([](float, float, float z) { return z; }), Error);
}

// Its second sight of a pole has another time than its azimuth tells: the vehicle has moved on.
TEST(ObservationPoleExtractor, AMovingCutOfMoreThanATurnUsesTheTurnOfTheStamp) {
  auto options = hdl32(1.5);
  const TestCloud cloud = plainCloud(options);
  const auto once = ObservationPoleExtractor(options).process(*observationOf(cloud, CPose3D()));
  const PoleDetection& pole = once->poles.front();
  const double begin = std::atan2(pole.y, pole.x) + 20 * M_PI / 180;
  const auto share = [&](float x, float y, float) { return turnedTo(begin, x, y); };
  TestCloud both = sorted(cloud, share);
  for (std::size_t i = 0; i < cloud.x.size() && share(both.x[i], both.y[i], 0) < 40. / 360; ++i) {
    both.x.push_back(1.1f * both.x[i]);
    both.y.push_back(1.1f * both.y[i]);
    both.z.push_back(1.1f * both.z[i]);
  }
  const auto distances = [&](double stamp) {
    options.sensor.timing = {Turn::clockwise, 0.1, M_PI, stamp, 0, true};
    const auto scan = ObservationPoleExtractor(options).process(*observationOf(both, CPose3D()));
    std::vector<double> found;
    for (const PoleDetection& p : scan->poles)
      if (std::abs(wrapAngle(std::atan2(p.y, p.x) - std::atan2(pole.y, pole.x))) < 0.01)
        found.push_back(std::hypot(p.x, p.y) / std::hypot(pole.x, pole.y));
    return found;
  };
  const auto first = distances(0), last = distances(1);
  ASSERT_EQ(first.size(), 1u);
  EXPECT_NEAR(first.front(), 1, 0.01);
  ASSERT_EQ(last.size(), 1u);
  EXPECT_NEAR(last.front(), 1.1, 0.01);
}

// Packets that are lost, or a first turn that is cut short, do not end a drive.
TEST(ObservationPoleExtractor, AMovingCutOfAScanWithFewPointsCorrectsNothing) {
  auto options = hdl32(1.5);
  options.sensor.timing = {Turn::clockwise, 0.1, M_PI, 0, 0, true};
  TestCloud cloud = plainCloud(options);
  for (auto* values : {&cloud.x, &cloud.y, &cloud.z}) values->resize(100);
  ObservationPoleExtractor extraction(options);
  const auto scan = extraction.process(*observationOf(cloud, CPose3D()));
  for (const PoleDetection& pole : scan->poles) EXPECT_EQ(pole.timeOffset, 0);
}

TEST(ObservationPoleExtractor, AContradictionIsNotForgotten) {
  auto options = hdl32(1.5);
  const TestCloud cloud = plainCloud(options);
  options.sensor.model = "hdl64e";
  ObservationPoleExtractor extraction(options);
  for (int i = 0; i < 5; ++i)
    EXPECT_THROW(extraction.process(*observationOf(cloud, CPose3D())), Error) << i;
}

// The LiDAR turns the other way, seen in the levelled frame of the poles.
TEST(ObservationPoleExtractor, OnItsHeadItTurnsTheOtherWay) {
  auto options = hdl32(1.5);
  options.sensor.upsideDown = true;
  options.sensor.timing = {Turn::clockwise, 0.1, M_PI, 0.5};
  const CPose3D onItsHead(0, 0, 1.5, 0, 0, M_PI);
  const TestCloud cloud = castScan(options.sensor, isometry(CPose3D(0, 0, 1.5)), testPoles());
  ObservationPoleExtractor extraction(options);
  const auto scan = extraction.process(*observationOf(
      cloud, onItsHead, isometry(onItsHead).inverse() * isometry(CPose3D(0, 0, 1.5))));
  EXPECT_GE(scan->poles.size(), 6u);
  for (const PoleDetection& pole : scan->poles) EXPECT_EQ(pole.turnRate, 20 * M_PI);
}

// Clockwise from the back, stamped at the front: what is at the left was measured before.
TEST(ObservationPoleExtractor, PolesHaveTheTimesOfTheirAzimuths) {
  auto options = hdl32(1.5);
  const TestCloud cloud = plainCloud(options);
  const auto offsetsFit = [&](ObservationPoleExtractor& extraction, const CPose3D& pose, int sign) {
    const auto scan = extraction.process(*observationOf(cloud, pose));
    EXPECT_GE(scan->poles.size(), 6u);
    for (const PoleDetection& pole : scan->poles) {
      EXPECT_EQ(pole.turnRate, sign * 20 * M_PI);
      EXPECT_NEAR(pole.timeOffset, sign * 0.1 * std::atan2(pole.y, pole.x) / (2 * M_PI), 1e-9);
    }
  };
  ObservationPoleExtractor recorded(options);
  offsetsFit(recorded, CPose3D(), 0);
  recorded.setRecordedTiming({Turn::clockwise, 0.1, M_PI, 0.5});
  offsetsFit(recorded, CPose3D(), -1);
  offsetsFit(recorded, CPose3D(1, 2, 1.5, 0.7, 0, 0), -1);
  options.sensor.timing.turn = Turn::compensated;  // settings come before the recording
  ObservationPoleExtractor set(options);
  set.setRecordedTiming({Turn::clockwise, 0.1, M_PI, 0.5});
  offsetsFit(set, CPose3D(), 0);
}

// The planar sensor frame moves with the sensor pose; positions in it stay the same.
TEST(ObservationPoleExtractor, SensorPoseDoesNotChangeWhatTheSensorSees) {
  const auto options = hdl32(1.5);
  const TestCloud cloud = plainCloud(options);
  ObservationPoleExtractor extraction(options);
  const auto there = extraction.process(*observationOf(cloud, CPose3D(1, -2, 1.5, 0.7, 0, 0)));
  expectSamePoles(there->poles, corePoles(options, cloud.view()), 1e-9);
  EXPECT_NEAR(there->sensorPose.yaw(), 0.7, 1e-12);
}

// The points from which the poles were extracted, for drawing: extracting them again gives the same
// poles.
TEST(ObservationPoleExtractor, GivesThePointsInTheLidarFrame) {
  auto options = hdl32(1.257);
  options.sensor.upsideDown = true;
  options.sensor.originZ = 0.957;
  const TestCloud cloud =
      castScan(options.sensor, isometry(CPose3D(0, 0, 1.257, 0, 0, 0)), testPoles());
  const CPose3D bodyInRobot(0, 0, 0.3, 0, 0, M_PI);
  Eigen::Isometry3d T_body_lidar = Eigen::Isometry3d::Identity();
  T_body_lidar.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  T_body_lidar.translation().z() = -0.957;
  ObservationPoleExtractor extraction(options);
  const auto points = extraction.lidarPoints(*observationOf(cloud, bodyInRobot, T_body_lidar));
  ASSERT_EQ(points.size(), cloud.x.size());
  for (std::size_t i = 0; i < points.size(); i += 97) {
    EXPECT_NEAR(points.x[i], cloud.x[i], 1e-5);
    EXPECT_NEAR(points.y[i], cloud.y[i], 1e-5);
    EXPECT_NEAR(points.z[i], cloud.z[i], 1e-5);
  }
  EXPECT_THROW(extraction.lidarPoints(CObservationOdometry()), Error);
}

TEST(ObservationPoleExtractor, FindsPolesFromAPlaceOnTheRobot) {
  const auto options = hdl32(1.8);
  const CPose3D pose(0.8, -0.4, 1.8, 0.5, 0, 0);
  const TestCloud cloud = castScan(options.sensor, isometry(pose), testPoles());
  ObservationPoleExtractor extraction(options);
  EXPECT_GE(found(*extraction.process(*observationOf(cloud, pose)), 0.05), 6);
}

// NCLT: points in a body frame with z down; the sensor is upside down, 0.957 m above its origin.
TEST(ObservationPoleExtractor, BodyFrameWithZDown) {
  auto options = hdl32(0.957 + 0.3);
  options.sensor.upsideDown = true;
  options.sensor.originZ = 0.957;
  const Eigen::Isometry3d T_robot_lidar(Eigen::Translation3d(0, 0, 1.257));
  const TestCloud cloud = castScan(options.sensor, T_robot_lidar, testPoles());
  const CPose3D bodyInRobot(0, 0, 0, 0, 0, M_PI);
  // The body frame's origin is 0.957 m below the lidar, 0.3 m above the ground.
  Eigen::Isometry3d T_body_lidar = isometry(bodyInRobot).inverse();
  T_body_lidar = T_body_lidar * Eigen::Translation3d(0, 0, 0.957);
  ObservationPoleExtractor extraction(options);
  const auto scan = extraction.process(*observationOf(cloud, bodyInRobot, T_body_lidar));
  EXPECT_GE(found(*scan, 0.05), 6);
  expectSamePoles(scan->poles, corePoles(options, cloud.view()),
                  1e-3);  // except for rounding to floats

  EXPECT_NEAR(extraction.report().ground, -1.257, 0.05);  // relative to the sensor, not the body
}

// The authors' program projects NCLT's clouds from the origin of the body frame, 0.957 m below the
// sensor and here 0.3 m above the ground.
TEST(ObservationPoleExtractor, PaperMayProjectFromTheOriginOfClouds) {
  auto options = hdl32(0.957 + 0.3);
  options.sensor.upsideDown = true;
  options.sensor.originZ = 0.957;
  options.extraction.method = ExtractionMethod::rangeImage;
  auto& paper = options.extraction.rangeImage;
  paper.rows = 32;
  paper.columns = 1000;
  paper.fovUp = mrpt::DEG2RAD(30.67);
  paper.fovDown = mrpt::DEG2RAD(-10.67);
  paper.heightsAboveGround = true;
  paper.minZ = 0.3;
  const Eigen::Isometry3d T_robot_lidar(Eigen::Translation3d(0, 0, 1.257));
  const TestCloud cloud = castScan(options.sensor, T_robot_lidar, testPoles());
  const CPose3D bodyInRobot(0, 0, 0.3, 0, 0, M_PI);
  const Eigen::Isometry3d T_body_lidar = isometry(bodyInRobot).inverse() * T_robot_lidar;
  const auto scan = observationOf(cloud, bodyInRobot, T_body_lidar);
  for (const bool fromCloud : {false, true}) {
    paper.projectFrom = fromCloud ? "cloud" : "sensor";
    ObservationPoleExtractor extraction(options);
    const auto points = extraction.lidarPoints(*scan);
    for (std::size_t i = 0; i < points.size(); i += 97) {
      EXPECT_NEAR(points.x[i], cloud.x[i], 1e-5);
      EXPECT_NEAR(points.y[i], cloud.y[i], 1e-5);
      EXPECT_NEAR(points.z[i] - cloud.z[i], fromCloud ? 0.957 : 0, 1e-5);
    }
    EXPECT_GE(found(*extraction.process(*scan), 0.1), 3);
    EXPECT_NEAR(extraction.report().ground, fromCloud ? -0.3 : -1.257, 1e-9);
  }
}

TEST(ObservationPoleExtractor, OriginIsAlongTheRobotsAxes) {
  auto options = hdl32(1.5);
  options.sensor.originX = 0.6;
  options.sensor.originY = -0.3;
  // Clouds in a frame rotated by 90° at the robot's origin; the LiDAR is at (0.6, -0.3).
  const CPose3D cloudInRobot(0, 0, 0, M_PI / 2, 0, 0);
  const Eigen::Isometry3d T_robot_lidar =
      Eigen::Translation3d(0.6, -0.3, 1.5) * Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ());
  const TestCloud cloud = castScan(options.sensor, T_robot_lidar, testPoles());
  Eigen::Isometry3d T_cloud_lidar = isometry(cloudInRobot).inverse() * T_robot_lidar;
  T_cloud_lidar.translation().z() = 0;
  ObservationPoleExtractor extraction(options);
  EXPECT_GE(found(*extraction.process(*observationOf(cloud, cloudInRobot, T_cloud_lidar)), 0.05),
            6);
}

// Poles are vertical in the robot frame and tilted in the LiDAR frame. At 13 m, the tilt changes
// heights by 1 m. Without a correction, poles would be off by 7 cm.
TEST(ObservationPoleExtractor, TiltedMounting) {
  const auto options = hdl32(1.5);
  const CPose3D pose(0, 0, 1.5, 0, mrpt::DEG2RAD(4.0), mrpt::DEG2RAD(-2.0));
  const TestCloud cloud = castScan(options.sensor, isometry(pose), testPoles());
  ObservationPoleExtractor extraction(options);
  EXPECT_GE(found(*extraction.process(*observationOf(cloud, pose)), 0.03), 8);
}

// Upright poles lean by up to 20° in the LiDAR frame, more than `max_tilt_deg` allows a pole. From
// 16° on, some have too little of them in the field of view.
TEST(ObservationPoleExtractor, SteepMounting) {
  const auto options = hdl32(1.5);
  std::map<int, std::vector<double>> confidences;
  for (const auto& [tilt, least] : {std::pair(8, 8), {12, 8}, {16, 6}, {20, 5}})
    for (const double direction : {0.0, 0.7, 1.6, 2.4, 3.1, -2.0, -0.8}) {
      const double pitch = mrpt::DEG2RAD(tilt * std::cos(direction)),
                   roll = mrpt::DEG2RAD(tilt * std::sin(direction));
      const CPose3D pose(0, 0, 1.5, 0, pitch, roll);
      const TestCloud cloud = castScan(options.sensor, isometry(pose), testPoles());
      ObservationPoleExtractor extraction(options);
      const auto scan = extraction.process(*observationOf(cloud, pose));
      EXPECT_GE(found(*scan, 0.025), least) << tilt << ' ' << direction;
      EXPECT_EQ(found(*scan, 0.025), static_cast<int>(scan->poles.size()));
      for (const PoleDetection& pole : scan->poles) confidences[tilt].push_back(pole.confidence);
    }
  // Rows are asked where they meet the leaning pole; asked above its middle they lower this to
  // 0.96.
  const std::vector<double>& steep = confidences[20];
  EXPECT_GT(std::accumulate(steep.begin(), steep.end(), 0.0) / static_cast<double>(steep.size()),
            0.97);
}

// Optical frame of a camera: z forward, x right. It is rotated upright before extraction.
TEST(ObservationPoleExtractor, CloudOnItsSide) {
  const auto options = hdl32(1.5);
  const TestCloud cloud = plainCloud(options);
  const CPose3D optical(0, 0, 1.5, -M_PI / 2, 0, -M_PI / 2);
  ObservationPoleExtractor extraction(options);
  Eigen::Isometry3d T_optical_lidar = Eigen::Isometry3d::Identity();
  T_optical_lidar.linear() = isometry(optical).linear().transpose();
  const auto scan = extraction.process(*observationOf(cloud, optical, T_optical_lidar));
  EXPECT_GE(found(*scan, 0.05), 6);
}

TEST(ObservationPoleExtractor, CountsInvalidPoints) {
  const auto options = hdl32(1.5);
  TestCloud cloud = plainCloud(options);
  const auto clean = corePoles(options, cloud.view());
  const float nan = std::nanf("");
  for (int i = 0; i < 10; ++i) {
    cloud.x.push_back(i % 2 ? nan : 0);
    cloud.y.push_back(i % 2 ? 1 : 0);
    cloud.z.push_back(i == 9 ? INFINITY : 0);
  }
  ObservationPoleExtractor extraction(options);
  for (const double originX : {0.0, 0.5}) {  // as it is, and shifted: zeros must stay "no return"
    auto moved = options;
    moved.sensor.originX = originX;
    ObservationPoleExtractor other(moved);
    const auto scan = other.process(*observationOf(cloud, CPose3D()));
    EXPECT_EQ(other.report().invalid, 10u);
    EXPECT_EQ(scan->points, cloud.x.size() - 10);
    if (originX == 0) expectSamePoles(scan->poles, clean, 0);
  }
}

TEST(ObservationPoleExtractor, EmptyScansGiveNoPoles) {
  ObservationPoleExtractor extraction(hdl32(1.5));
  const auto plain = extraction.process(*observationOf(plainCloud(hdl32(1.5)), CPose3D()));
  EXPECT_GT(plain->points, 0u);
  const auto none = extraction.process(CObservationPointCloud());  // observation without a cloud
  EXPECT_TRUE(none->poles.empty());
  EXPECT_EQ(none->points, 0u);
  const auto empty = extraction.process(*observationOf(TestCloud(), CPose3D()));
  EXPECT_TRUE(empty->poles.empty());
  EXPECT_EQ(empty->points, 0u);
  EXPECT_EQ(extraction.report().points, 0u);  // not those of the previous scan
}

TEST(ObservationPoleExtractor, RefusesOtherObservations) {
  ObservationPoleExtractor extraction(hdl32(1.5));
  const CObservationOdometry odometry;
  EXPECT_FALSE(ObservationPoleExtractor::canProcess(odometry));
  EXPECT_FALSE(ObservationPoleExtractor::canProcess(samples::observation()));
  EXPECT_HAS(refusal(extraction, odometry), "mrpt::obs::CObservationOdometry");
  EXPECT_TRUE(ObservationPoleExtractor::canProcess(CObservationPointCloud()));
  EXPECT_TRUE(ObservationPoleExtractor::canProcess(CObservationVelodyneScan()));
  EXPECT_TRUE(ObservationPoleExtractor::canProcess(CObservation3DRangeScan()));
  EXPECT_TRUE(ObservationPoleExtractor::canProcess(CObservationRotatingScan()));
}

// MRPT reads a matrix as it is.
TEST(ObservationPoleExtractor, RefusesSensorPosesThatAreNoPoses) {
  const auto options = hdl32(1.5);
  const TestCloud cloud = plainCloud(options);
  ObservationPoleExtractor extraction(options);
  for (const CPose3D& pose :
       {CPose3D(NAN, 0, 0, 0, 0, 0), CPose3D(0, 0, INFINITY, 0, 0, 0), CPose3D(0, 0, 0, 0, NAN, 0)})
    EXPECT_HAS(refusal(extraction, *observationOf(cloud, pose)), "sensor pose");
  for (const double number : std::vector<double>{NAN, INFINITY, 0, -1, 1.1}) {
    mrpt::math::CMatrixDouble44 matrix = mrpt::math::CMatrixDouble44::Identity();
    matrix(1, 1) = number;
    EXPECT_HAS(refusal(extraction, *observationOf(cloud, CPose3D(matrix))), "sensor pose");
  }
  auto known = options;
  known.sensorPose = CPose3D();
  EXPECT_FALSE(ObservationPoleExtractor(known)
                   .process(*observationOf(cloud, CPose3D(NAN, 0, 0, 0, 0, 0)))
                   ->poles.empty());
}

TEST(ObservationPoleExtractor, RefusesBadOptions) {
  auto options = hdl32(1.5);
  options.sensor.model = "hdl3000";
  EXPECT_THROW(ObservationPoleExtractor{options}, Error);
}

}  // namespace
}  // namespace polemcl::test_observation_pole_extractor
