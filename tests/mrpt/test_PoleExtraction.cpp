#include <gtest/gtest.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <polemcl/mrpt/PoleExtraction.h>
#include <polemcl/mrpt/RawlogReader.h>

#include <cstdlib>
#include <fstream>

#include "mrpt/Samples.h"
#include "mrpt/TestClouds.h"

namespace polemcl {
namespace {

using mrpt::poses::CPose3D;
using namespace mrpt::obs;
using samples::TestCloud;

PoleExtractionOptions hdl32(double height) {
  PoleExtractionOptions options;
  options.sensor.model = "hdl32e";
  options.sensor.height = height;
  return options;
}

Eigen::Isometry3d isometry(const CPose3D& pose) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = pose.getRotationMatrix().asEigen();
  T.translation() = Eigen::Vector3d(pose.x(), pose.y(), pose.z());
  return T;
}

/// The cloud as MRPT holds it, after moving its points by T_cloud_lidar.
CObservationPointCloud::Ptr observationOf(
    const TestCloud& cloud, const CPose3D& sensorPose,
    const Eigen::Isometry3d& T_cloud_lidar = Eigen::Isometry3d::Identity()) {
  auto observation = CObservationPointCloud::Create();
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

std::vector<PoleDetection> corePoles(const PoleExtractionOptions& options, const PointsView& view) {
  PoleExtractor extractor(options.sensor, options.extraction);
  return extractor.extract(view);
}

void expectSame(const std::vector<PoleDetection>& a, const std::vector<PoleDetection>& b,
                double tolerance) {
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

/// Poles of the place that were found within the tolerance, robot frame.
int found(const CObservationPoles& scan, double tolerance) {
  int count = 0;
  const auto poles_robot = scan.polesInRobotFrame();
  for (const auto& truth : samples::testPoles())
    for (const auto& pole : poles_robot)
      if (std::hypot(pole.x - truth.x, pole.y - truth.y) < tolerance) {
        ++count;
        break;
      }
  return count;
}

std::string refusal(PoleExtraction& extraction, const CObservation& observation) {
  try {
    extraction.process(observation);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TestCloud plainCloud(const PoleExtractionOptions& options) {
  return samples::castScan(options.sensor,
                           Eigen::Isometry3d(Eigen::Translation3d(0, 0, options.sensor.height)),
                           samples::testPoles());
}

// Sensor at the robot's origin, level: nothing is moved, and the poles are the core's, bit for bit.
TEST(PoleExtraction, LevelCloudsGoThroughUntouched) {
  const auto options = hdl32(1.5);
  const TestCloud cloud = plainCloud(options);
  PoleExtraction extraction(options);
  const auto scan = extraction.process(*observationOf(cloud, CPose3D()));
  expectSame(scan->poles, corePoles(options, cloud.view()), 0);
  EXPECT_EQ(scan->sensorLabel, "TEST");
  EXPECT_EQ(scan->timestamp, mrpt::Clock::fromDouble(1000.5));
  EXPECT_EQ(scan->points, cloud.x.size());
  EXPECT_EQ(extraction.report().points, cloud.x.size());
  EXPECT_GE(found(*scan, 0.05), 6);
}

// The planar sensor frame moves with the sensor pose; what is seen in it stays the same.
TEST(PoleExtraction, SensorPoseDoesNotChangeWhatTheSensorSees) {
  const auto options = hdl32(1.5);
  const TestCloud cloud = plainCloud(options);
  PoleExtraction extraction(options);
  const auto there = extraction.process(*observationOf(cloud, CPose3D(1, -2, 1.5, 0.7, 0, 0)));
  expectSame(there->poles, corePoles(options, cloud.view()), 1e-9);
  EXPECT_NEAR(there->sensorPose.yaw(), 0.7, 1e-12);
}

TEST(PoleExtraction, FindsPolesFromAPlaceOnTheRobot) {
  const auto options = hdl32(1.8);
  const CPose3D pose(0.8, -0.4, 1.8, 0.5, 0, 0);
  const TestCloud cloud = samples::castScan(options.sensor, isometry(pose), samples::testPoles());
  PoleExtraction extraction(options);
  EXPECT_GE(found(*extraction.process(*observationOf(cloud, pose)), 0.05), 6);
}

// NCLT: points in a body frame with z down; the sensor hangs upside down 0.957 m above its origin.
TEST(PoleExtraction, BodyFrameWithZDown) {
  auto options = hdl32(0.957 + 0.3);
  options.sensor.upsideDown = true;
  options.sensor.originZ = 0.957;
  const Eigen::Isometry3d T_robot_lidar(Eigen::Translation3d(0, 0, 1.257));
  const TestCloud cloud = samples::castScan(options.sensor, T_robot_lidar, samples::testPoles());
  const CPose3D bodyInRobot(0, 0, 0, 0, 0, M_PI);
  // The body frame's origin is 0.957 m below the lidar, 0.3 m above the ground.
  Eigen::Isometry3d T_body_lidar = isometry(bodyInRobot).inverse();
  T_body_lidar = T_body_lidar * Eigen::Translation3d(0, 0, 0.957);
  PoleExtraction extraction(options);
  const auto scan = extraction.process(*observationOf(cloud, bodyInRobot, T_body_lidar));
  EXPECT_GE(found(*scan, 0.05), 6);
  expectSame(scan->poles, corePoles(options, cloud.view()), 1e-3);  // but for rounding to floats

  EXPECT_NEAR(extraction.report().ground, -1.257, 0.05);  // below the sensor, not the body
}

TEST(PoleExtraction, OriginIsAlongTheRobotsAxes) {
  auto options = hdl32(1.5);
  options.sensor.originX = 0.6;
  options.sensor.originY = -0.3;
  // Clouds in a frame turned by 90° at the robot's origin; the lidar stands at (0.6, -0.3).
  const CPose3D cloudInRobot(0, 0, 0, M_PI / 2, 0, 0);
  const Eigen::Isometry3d T_robot_lidar =
      Eigen::Translation3d(0.6, -0.3, 1.5) * Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ());
  const TestCloud cloud = samples::castScan(options.sensor, T_robot_lidar, samples::testPoles());
  Eigen::Isometry3d T_cloud_lidar = isometry(cloudInRobot).inverse() * T_robot_lidar;
  T_cloud_lidar.translation().z() = 0;
  PoleExtraction extraction(options);
  EXPECT_GE(found(*extraction.process(*observationOf(cloud, cloudInRobot, T_cloud_lidar)), 0.05),
            6);
}

// Poles stand upright in the robot frame, askew in the lidar's. What is seen at 13 m is 1 m higher
// or lower there than it would be level; taken for that height, poles would be off by 7 cm.
TEST(PoleExtraction, TiltedMounting) {
  const auto options = hdl32(1.5);
  const CPose3D pose(0, 0, 1.5, 0, mrpt::DEG2RAD(4.0), mrpt::DEG2RAD(-2.0));
  const TestCloud cloud = samples::castScan(options.sensor, isometry(pose), samples::testPoles());
  PoleExtraction extraction(options);
  EXPECT_GE(found(*extraction.process(*observationOf(cloud, pose)), 0.03), 8);
}

// A camera's optical frame: z ahead, x to the right. It is stood up before extraction.
TEST(PoleExtraction, CloudOnItsSide) {
  const auto options = hdl32(1.5);
  const TestCloud cloud = plainCloud(options);
  const CPose3D optical(0, 0, 1.5, -M_PI / 2, 0, -M_PI / 2);
  PoleExtraction extraction(options);
  Eigen::Isometry3d T_optical_lidar = Eigen::Isometry3d::Identity();
  T_optical_lidar.linear() = isometry(optical).linear().transpose();
  const auto scan = extraction.process(*observationOf(cloud, optical, T_optical_lidar));
  EXPECT_GE(found(*scan, 0.05), 6);
}

TEST(PoleExtraction, CountsInvalidPoints) {
  const auto options = hdl32(1.5);
  TestCloud cloud = plainCloud(options);
  const auto clean = corePoles(options, cloud.view());
  const float nan = std::nanf("");
  for (int i = 0; i < 10; ++i) {
    cloud.x.push_back(i % 2 ? nan : 0);
    cloud.y.push_back(i % 2 ? 1 : 0);
    cloud.z.push_back(i == 9 ? INFINITY : 0);
  }
  PoleExtraction extraction(options);
  for (const double originX : {0.0, 0.5}) {  // as it is, and moved: zeros stay no returns
    auto moved = options;
    moved.sensor.originX = originX;
    PoleExtraction other(moved);
    const auto scan = other.process(*observationOf(cloud, CPose3D()));
    EXPECT_EQ(other.report().invalid, 10u);
    EXPECT_EQ(scan->points, cloud.x.size() - 10);
    if (originX == 0) expectSame(scan->poles, clean, 0);
  }
}

TEST(PoleExtraction, EmptyScansGiveNoPoles) {
  PoleExtraction extraction(hdl32(1.5));
  const auto plain = extraction.process(*observationOf(plainCloud(hdl32(1.5)), CPose3D()));
  EXPECT_GT(plain->points, 0u);
  const auto none = extraction.process(CObservationPointCloud());  // no cloud at all
  EXPECT_TRUE(none->poles.empty());
  EXPECT_EQ(none->points, 0u);
  const auto empty = extraction.process(*observationOf(TestCloud(), CPose3D()));
  EXPECT_TRUE(empty->poles.empty());
  EXPECT_EQ(empty->points, 0u);
  EXPECT_EQ(extraction.report().points, 0u);  // not those of the scan before
}

TEST(PoleExtraction, RefusesOtherObservations) {
  PoleExtraction extraction(hdl32(1.5));
  const CObservationOdometry odometry;
  EXPECT_FALSE(PoleExtraction::canProcess(odometry));
  EXPECT_FALSE(PoleExtraction::canProcess(samples::observation()));
  EXPECT_HAS(refusal(extraction, odometry), "mrpt::obs::CObservationOdometry");
  EXPECT_TRUE(PoleExtraction::canProcess(CObservationPointCloud()));
  EXPECT_TRUE(PoleExtraction::canProcess(CObservationVelodyneScan()));
  EXPECT_TRUE(PoleExtraction::canProcess(CObservation3DRangeScan()));
  EXPECT_TRUE(PoleExtraction::canProcess(CObservationRotatingScan()));
}

TEST(PoleExtraction, RefusesBadOptions) {
  auto options = hdl32(1.5);
  options.sensor.model = "hdl3000";
  EXPECT_THROW(PoleExtraction{options}, Error);
}

void writeKitti(const std::string& path, const TestCloud& cloud) {
  std::ofstream out(path, std::ios::binary);
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    const float xyzi[4] = {cloud.x[i], cloud.y[i], cloud.z[i], 0.5F};
    out.write(reinterpret_cast<const char*>(xyzi), sizeof xyzi);
  }
}

TEST(PoleExtraction, ReadsExternalKittiFiles) {
  using Format = CObservationPointCloud::ExternalStorageFormat;
  const samples::Folder folder("PoleExtraction");
  const auto options = hdl32(1.5);
  TestCloud cloud = plainCloud(options);
  const auto expected = corePoles(options, cloud.view());
  cloud.x.push_back(std::nanf(""));
  cloud.y.push_back(0);
  cloud.z.push_back(0);
  writeKitti(folder / "0.bin", cloud);
  CObservationPointCloud observation;
  observation.setAsExternalStorage(folder / "0.bin", Format::KittiBinFile);
  PoleExtraction extraction(options);
  const auto scan = extraction.process(observation);
  expectSame(scan->poles, expected, 0);
  EXPECT_EQ(extraction.report().invalid, 1u);
  EXPECT_EQ(scan->points, cloud.x.size() - 1);
  EXPECT_FALSE(observation.pointcloud);  // nothing stays in memory

  std::filesystem::resize_file(folder / "0.bin", 16 * 100 + 5);
  EXPECT_HAS(refusal(extraction, observation), "0.bin");
  std::filesystem::remove(folder / "0.bin");
  EXPECT_HAS(refusal(extraction, observation), "0.bin");
}

TEST(PoleExtraction, LoadsAndUnloadsOtherExternalFiles) {
  using Format = CObservationPointCloud::ExternalStorageFormat;
  const samples::Folder folder("PoleExtractionGz");
  const auto options = hdl32(1.5);
  const TestCloud cloud = plainCloud(options);
  {
    mrpt::io::CFileGZOutputStream file(folder / "0.gz");
    auto archive = mrpt::serialization::archiveFrom(file);
    archive << *observationOf(cloud, CPose3D())->pointcloud;
  }
  CObservationPointCloud observation;
  observation.setAsExternalStorage(folder / "0.gz", Format::MRPT_Serialization);
  PoleExtraction extraction(options);
  expectSame(extraction.process(observation)->poles, corePoles(options, cloud.view()), 0);
  EXPECT_FALSE(observation.pointcloud);
  observation.load();  // what the caller loaded stays loaded
  extraction.process(observation);
  EXPECT_TRUE(observation.pointcloud);

  CObservationPointCloud missing;
  missing.setAsExternalStorage(folder / "1.gz", Format::MRPT_Serialization);
  EXPECT_HAS(refusal(extraction, missing), "1.gz");
}

const std::string datasets = "/usr/share/mrpt/datasets/";

CObservation::Ptr firstOf(const std::string& file) {
  RawlogReader reader(datasets + file);
  RawlogEntry entry;
  while (reader.next(entry))
    if (entry.observation && PoleExtraction::canProcess(*entry.observation))
      return entry.observation;
  return nullptr;
}

PoleExtractionOptions vlp16() {
  PoleExtractionOptions options;
  options.sensor.model = "vlp16";
  options.sensor.height = 1;
  return options;
}

TEST(PoleExtraction, GeneratesVelodyneCloudsOnACopy) {
  if (!std::filesystem::exists(datasets)) GTEST_SKIP() << datasets << " is not there";
  const auto scan =
      std::dynamic_pointer_cast<CObservationVelodyneScan>(firstOf("test_velodyne_VLP16.rawlog"));
  ASSERT_TRUE(scan);
  ASSERT_EQ(scan->point_cloud.size(), 0u);
  PoleExtraction extraction(vlp16());
  const auto poles = extraction.process(*scan);
  EXPECT_EQ(scan->point_cloud.size(), 0u);
  EXPECT_EQ(extraction.report().points, 11305u);  // all its returns, as MRPT counts them
  EXPECT_EQ(extraction.report().outOfView, 0u);
  scan->generatePointCloud();
  EXPECT_EQ(extraction.process(*scan)->poles.size(), poles->poles.size());
}

// MRPT's sample of a rotating scan is the same scan as its Velodyne sample, sparse and with its
// rows in firing order: range and height of what is found must agree with the Velodyne cloud.
TEST(PoleExtraction, RotatingScanMatchesTheVelodyneScanItCameFrom) {
  if (!std::filesystem::exists(datasets)) GTEST_SKIP() << datasets << " is not there";
  const auto velodyne = firstOf("test_velodyne_VLP16.rawlog");
  const auto rotating = firstOf("rot_scan_velodyne.rawlog");
  ASSERT_TRUE(velodyne && rotating);
  PoleExtraction extraction(vlp16());
  const auto expected = extraction.process(*velodyne);
  const auto scan = extraction.process(*rotating);
  EXPECT_EQ(extraction.report().points, 11305u);
  EXPECT_EQ(extraction.report().outOfView, 0u);
  ASSERT_GT(expected->poles.size(), 0u);
  std::size_t matched = 0;
  for (const auto& a : expected->poles)
    for (const auto& b : scan->poles)
      if (std::hypot(a.x - b.x, a.y - b.y) < 0.1) {
        ++matched;
        break;
      }
  EXPECT_GE(matched * 10, expected->poles.size() * 8);
}

/// A rotating scan of the place: rows as given, columns counter-clockwise from the back.
CObservationRotatingScan rotatingScan(const SensorOptions& sensor, const std::vector<int>& rows,
                                      const CPose3D& pose) {
  const SensorModel model(sensor);
  CObservationRotatingScan scan;
  scan.rowCount = static_cast<std::uint16_t>(rows.size());
  scan.columnCount = static_cast<std::uint16_t>(model.columns());
  scan.rangeResolution = 0.002;
  scan.startAzimuth = -M_PI;
  scan.azimuthSpan = 2 * M_PI;
  scan.rangeImage.setZero(scan.rowCount, scan.columnCount);
  scan.sensorPose = pose;
  const Eigen::Isometry3d T_robot_sensor = isometry(pose);
  for (int column = 0; column < model.columns(); ++column)
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto [start, along] =
          samples::ray(model, rows[i], 2 * M_PI * column / model.columns() - M_PI);
      scan.rangeImage(static_cast<int>(i), column) = static_cast<std::uint16_t>(
          samples::castRay(T_robot_sensor * start, T_robot_sensor.linear() * along,
                           samples::testPoles()) /
              scan.rangeResolution +
          0.5);
    }
  return scan;
}

const CPose3D up(0, 0, 1.5, 0, 0, 0);

TEST(PoleExtraction, RotatingScanWithKnownElevations) {
  auto options = hdl32(1.5);
  std::vector<int> topDown(32);
  for (int i = 0; i < 32; ++i) topDown[static_cast<std::size_t>(i)] = i;
  PoleExtraction byModel(options);
  EXPECT_GE(found(*byModel.process(rotatingScan(options.sensor, topDown, up)), 0.05), 6);

  // Rows in another order: only a table can tell it.
  std::vector<int> mixed;
  auto table = options;
  table.sensor.model = "table";
  table.sensor.columns = SensorModel(options.sensor).columns();
  const SensorModel model(options.sensor);
  for (int i = 0; i < 32; ++i) {
    mixed.push_back((i * 7) % 32);
    table.sensor.elevations.push_back(std::atan(model.beam(mixed.back()).slope));
  }
  const auto scan = rotatingScan(options.sensor, mixed, up);
  PoleExtraction byTable(table);
  EXPECT_GE(found(*byTable.process(scan), 0.05), 6);
  EXPECT_LT(found(*byModel.process(scan), 0.05), 3);
}

// Rows keep the elevations of the sensor itself; its pose turns them over.
TEST(PoleExtraction, RotatingScanUpsideDown) {
  auto options = hdl32(1.5);
  std::vector<int> topDown(32);
  for (int i = 0; i < 32; ++i) topDown[static_cast<std::size_t>(i)] = i;
  const auto scan = rotatingScan(options.sensor, topDown, CPose3D(0.5, 0.2, 1.5, 0.3, 0, M_PI));
  options.sensor.upsideDown = true;
  PoleExtraction extraction(options);
  EXPECT_GE(found(*extraction.process(scan), 0.05), 6);
}

TEST(PoleExtraction, RotatingScanClockwise) {
  const auto options = hdl32(1.5);
  std::vector<int> topDown(32);
  for (int i = 0; i < 32; ++i) topDown[static_cast<std::size_t>(i)] = i;
  const auto ccw = rotatingScan(options.sensor, topDown, up);
  auto cw = ccw;
  cw.azimuthSpan = -2 * M_PI;
  cw.startAzimuth = M_PI;
  const int n = cw.columnCount;
  for (int column = 0; column < n; ++column)
    for (int row = 0; row < 32; ++row)
      cw.rangeImage(row, column) = ccw.rangeImage(row, (n - column) % n);
  PoleExtraction extraction(options);
  const auto expected = extraction.process(ccw)->poles;
  expectSame(extraction.process(cw)->poles, expected, 1e-4);
}

TEST(PoleExtraction, RefusesRotatingScansOfUnknownElevations) {
  CObservationRotatingScan scan;
  scan.rowCount = 40;
  scan.columnCount = 100;
  scan.rangeResolution = 0.01;
  scan.rangeImage.setZero(40, 100);
  scan.rangeImage(0, 0) = 500;
  PoleExtraction extraction(hdl32(1.5));
  const std::string text = refusal(extraction, scan);
  EXPECT_HAS(text, "40 rows");
  EXPECT_HAS(text, "model = hdl32e has 32 beams");
  EXPECT_HAS(text, "elevations_deg");
}

TEST(PoleExtraction, UnprojectsDepthImagesOnACopy) {
  if (!std::filesystem::exists(datasets)) GTEST_SKIP() << datasets << " is not there";
  const auto depth =
      std::dynamic_pointer_cast<CObservation3DRangeScan>(firstOf("tests_rgbd.rawlog"));
  ASSERT_TRUE(depth && depth->hasRangeImage);
  PoleExtractionOptions options;
  options.sensor.model = "uniform";
  options.sensor.rows = 240;
  options.sensor.fovUp = 0.5;
  options.sensor.fovDown = -0.5;
  options.sensor.columns = 2000;
  PoleExtraction extraction(options);
  extraction.process(*depth);
  EXPECT_EQ(extraction.report().points, 273225u);
  depth->hasPoints3D = false;
  depth->resizePoints3DVectors(0);
  extraction.process(*depth);
  EXPECT_EQ(extraction.report().points, 273225u);
  EXPECT_FALSE(depth->hasPoints3D);
}

TEST(PoleExtraction, RealKittiScan) {
  const char* data = std::getenv("POLEMCL_DATA");
  if (!data) GTEST_SKIP() << "POLEMCL_DATA is not set";
  CObservationPointCloud observation;
  observation.setAsExternalStorage(std::string(data) + "/kitti_raw_0005/velodyne/0000000000.bin",
                                   CObservationPointCloud::ExternalStorageFormat::KittiBinFile);
  PoleExtraction extraction(PoleExtractionOptions{});
  const auto scan = extraction.process(observation);
  EXPECT_GE(scan->poles.size(), 8u);
  EXPECT_GT(scan->points, 100000u);
}

}  // namespace
}  // namespace polemcl
