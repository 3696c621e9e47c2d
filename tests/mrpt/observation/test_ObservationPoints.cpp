#include <gtest/gtest.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <sys/stat.h>

#include <cstring>
#include <fstream>
#include <numeric>

#include "mrpt/observation/ObservationPoints.h"
#include "mrpt/rawlog/RawlogReader.h"
#include "support/ExpectHas.h"
#include "support/ExtractionSamples.h"

namespace polemcl::test_observation_points {
namespace {

using mrpt::poses::CPose3D;
using namespace mrpt::obs;
using namespace samples;

void writeKitti(const std::string& path, const TestCloud& cloud) {
  std::ofstream out(path, std::ios::binary);
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    const float xyzi[4] = {cloud.x[i], cloud.y[i], cloud.z[i], 0.5F};
    out.write(reinterpret_cast<const char*>(xyzi), sizeof xyzi);
  }
}

TEST(ObservationPoints, ReadsExternalKittiFiles) {
  using Format = CObservationPointCloud::ExternalStorageFormat;
  const testing_apps::TempFolder folder;
  const auto options = hdl32(1.5);
  TestCloud cloud = plainCloud(options);
  const auto expected = corePoles(options, cloud.view());
  cloud.x.push_back(std::nanf(""));
  cloud.y.push_back(0);
  cloud.z.push_back(0);
  writeKitti(folder / "0.bin", cloud);
  CObservationPointCloud observation;
  observation.setAsExternalStorage(folder / "0.bin", Format::KittiBinFile);
  ObservationPoleExtractor extraction(options);
  const auto scan = extraction.process(observation);
  expectSamePoles(scan->poles, expected, 0);
  EXPECT_EQ(extraction.report().invalid, 1u);
  EXPECT_EQ(scan->points, cloud.x.size() - 1);
  EXPECT_FALSE(observation.pointcloud);  // nothing stays in memory

  std::filesystem::resize_file(folder / "0.bin", 16 * 100 + 5);
  EXPECT_HAS(refusal(extraction, observation), "0.bin");
  std::filesystem::remove(folder / "0.bin");
  EXPECT_HAS(refusal(extraction, observation), "0.bin");
}

TEST(ObservationPoints, LoadsAndUnloadsOtherExternalFiles) {
  using Format = CObservationPointCloud::ExternalStorageFormat;
  const testing_apps::TempFolder folder;
  const auto options = hdl32(1.5);
  const TestCloud cloud = plainCloud(options);
  {
    mrpt::io::CFileGZOutputStream file(folder / "0.gz");
    auto archive = mrpt::serialization::archiveFrom(file);
    archive << *observationOf(cloud, CPose3D())->pointcloud;
  }
  CObservationPointCloud observation;
  observation.setAsExternalStorage(folder / "0.gz", Format::MRPT_Serialization);
  ObservationPoleExtractor extraction(options);
  expectSamePoles(extraction.process(observation)->poles, corePoles(options, cloud.view()), 0);
  EXPECT_FALSE(observation.pointcloud);
  observation.load();  // what the caller loaded stays loaded
  extraction.process(observation);
  EXPECT_TRUE(observation.pointcloud);

  CObservationPointCloud missing;
  missing.setAsExternalStorage(folder / "1.gz", Format::MRPT_Serialization);
  EXPECT_HAS(refusal(extraction, missing), "1.gz");
}

// A device may have no end, and a pipe no beginning.
TEST(ObservationPoints, RefusesExternalFilesThatAreNone) {
  using Format = CObservationPointCloud::ExternalStorageFormat;
  const testing_apps::TempFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  ObservationPoleExtractor extraction(hdl32(1.5));
  for (const Format format : {Format::KittiBinFile, Format::MRPT_Serialization})
    for (const std::string& file :
         {std::string("/dev/zero"), (folder / "pipe").string(), folder.path().string()}) {
      CObservationPointCloud observation;
      observation.setAsExternalStorage(file, format);
      EXPECT_HAS(refusal(extraction, observation),
                 file + ": a scan beside the rawlog must be a regular file");
    }
}

const std::string kDatasets = "/usr/share/mrpt/datasets/";

CObservation::Ptr firstOf(const std::string& file) {
  RawlogReader reader(kDatasets + file);
  RawlogEntry entry;
  while (reader.next(entry))
    if (entry.observation && ObservationPoleExtractor::canProcess(*entry.observation))
      return entry.observation;
  return nullptr;
}

ObservationPoleExtractorOptions vlp16() {
  ObservationPoleExtractorOptions options;
  options.sensor.model = "vlp16";
  options.sensor.height = 1;
  return options;
}

TEST(ObservationPoints, ReadsAllReturnsOfAVelodyne) {
  if (!std::filesystem::exists(kDatasets)) GTEST_SKIP() << kDatasets << " is not there";
  const auto scan =
      std::dynamic_pointer_cast<CObservationVelodyneScan>(firstOf("test_velodyne_VLP16.rawlog"));
  ASSERT_TRUE(scan);
  ASSERT_EQ(scan->point_cloud.size(), 0u);
  std::size_t returns = 0;
  for (const auto& packet : scan->scan_packets)
    for (const auto& block : packet.blocks)
      for (const auto& one : block.laser_returns)
        returns += one.distance() * 0.002 >= scan->minRange;
  ObservationPoleExtractor extraction(vlp16());
  extraction.process(*scan);
  EXPECT_EQ(scan->point_cloud.size(), 0u);
  EXPECT_EQ(extraction.report().points, returns);
  EXPECT_EQ(extraction.report().outOfView, 0u);
  scan->generatePointCloud();  // a cloud that is there is taken
  extraction.process(*scan);
  EXPECT_EQ(extraction.report().points, 11305u);
  scan->point_cloud = {};
  scan->point_cloud.x = scan->point_cloud.y = scan->point_cloud.z = {1};
  extraction.process(*scan);
  EXPECT_EQ(extraction.report().points, 1u);
}

TEST(ObservationPoints, TheTimeBetweenPacketsTellsTheModel) {
  const auto contradiction = [](const std::string& model, double microseconds) {
    CObservationVelodyneScan scan;
    scan.calibration = mrpt::obs::VelodyneCalibration::LoadDefaultCalibration(model);
    scan.scan_packets.resize(20);
    double time = 3'599'995'000;  // the hour ends on the way
    for (auto& packet : scan.scan_packets) {
      const std::uint32_t stamp = static_cast<std::uint64_t>(time) % 3'600'000'000;
      std::memcpy(reinterpret_cast<char*>(&packet) + sizeof packet.blocks, &stamp, sizeof stamp);
      time += &packet == &scan.scan_packets[5] ? 2 * microseconds : microseconds;  // one is missing
    }
    return packetContradiction(scan);
  };
  for (const double fits : {1327.1, 663.6}) EXPECT_EQ(contradiction("VLP16", fits), "") << fits;
  for (const double fits : {553.0, 276.5, 663.6, 0.0})
    EXPECT_EQ(contradiction("HDL32", fits), "") << fits;
  for (const double other : {553.0, 276.5})
    EXPECT_HAS(contradiction("VLP16", other), "as those of the HDL-32E do, but are decoded for 16");
  EXPECT_HAS(contradiction("HDL32", 1327.1), "every 1327 microseconds, as those of the VLP-16 do");
}

TEST(ObservationPoints, PacketsWithAClockThatWasSetTellNoTiming) {
  if (!std::filesystem::exists(kDatasets)) GTEST_SKIP() << kDatasets << " is not there";
  const auto scan =
      std::dynamic_pointer_cast<CObservationVelodyneScan>(firstOf("test_velodyne_VLP16.rawlog"));
  ASSERT_TRUE(scan);
  ObservationPoints points(vlp16().sensor);
  points.read(*scan);
  ASSERT_TRUE(points.timing());
  EXPECT_NEAR(points.timing()->seconds, 0.1, 0.002);
  std::uint32_t stamp = 0;
  char* at = reinterpret_cast<char*>(&scan->scan_packets[9]) + sizeof scan->scan_packets[9].blocks;
  std::memcpy(&stamp, at, sizeof stamp);
  stamp -= 500'000;
  std::memcpy(at, &stamp, sizeof stamp);
  points.read(*scan);
  EXPECT_FALSE(points.timing());
}

TEST(ObservationPoints, PacketsDecodedForAnotherModelAreNoticed) {
  if (!std::filesystem::exists(kDatasets)) GTEST_SKIP() << kDatasets << " is not there";
  const auto scan =
      std::dynamic_pointer_cast<CObservationVelodyneScan>(firstOf("test_velodyne_VLP16.rawlog"));
  ASSERT_TRUE(scan);
  EXPECT_EQ(packetContradiction(*scan), "");
  scan->calibration = mrpt::obs::VelodyneCalibration::LoadDefaultCalibration("HDL32");
  EXPECT_HAS(packetContradiction(*scan),
             "every 1327 microseconds, as those of the VLP-16 do, but are decoded for 32 lasers");
  scan->scan_packets.resize(9);
  EXPECT_EQ(packetContradiction(*scan), "");
  EXPECT_EQ(packetContradiction(CObservationPointCloud()), "");
}

// MRPT makes a rotating scan of its Velodyne sample, sparse and with rings in firing order. Range
// and height of the results must agree with the Velodyne cloud.
TEST(ObservationPoints, RotatingScanMatchesTheVelodyneScanItCameFrom) {
  if (!std::filesystem::exists(kDatasets)) GTEST_SKIP() << kDatasets << " is not there";
  const auto velodyne =
      std::dynamic_pointer_cast<CObservationVelodyneScan>(firstOf("test_velodyne_VLP16.rawlog"));
  ASSERT_TRUE(velodyne);
  CObservationRotatingScan rotating;
  rotating.fromVelodyne(*velodyne);
  velodyne->generatePointCloud();  // MRPT reads the same half of the returns
  ObservationPoleExtractor extraction(vlp16());
  const auto expected = extraction.process(*velodyne);
  const auto scan = extraction.process(rotating);
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

/// A rotating scan of the test place: rings as given, columns counter-clockwise from the back.
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
      const auto [start, along] = ray(model, rows[i], 2 * M_PI * column / model.columns() - M_PI);
      scan.rangeImage(static_cast<int>(i), column) = static_cast<std::uint16_t>(
          castRay(T_robot_sensor * start, T_robot_sensor.linear() * along, testPoles()) /
              scan.rangeResolution +
          0.5);
    }
  return scan;
}

const CPose3D kUp(0, 0, 1.5, 0, 0, 0);

/// The rows of an HDL-32E.
std::vector<int> topDown() {
  std::vector<int> rows(32);
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

TEST(ObservationPoints, RotatingScanWithKnownElevations) {
  auto options = hdl32(1.5);
  ObservationPoleExtractor byModel(options);
  EXPECT_GE(found(*byModel.process(rotatingScan(options.sensor, topDown(), kUp)), 0.05), 6);

  // Rings in another order: only a table can describe it.
  std::vector<int> mixed;
  auto table = options;
  table.sensor.model = "table";
  table.sensor.columns = SensorModel(options.sensor).columns();
  const SensorModel model(options.sensor);
  for (int i = 0; i < 32; ++i) {
    mixed.push_back((i * 7) % 32);
    table.sensor.elevations.push_back(std::atan(model.beam(mixed.back()).slope));
  }
  const auto scan = rotatingScan(options.sensor, mixed, kUp);
  ObservationPoleExtractor byTable(table);
  EXPECT_GE(found(*byTable.process(scan), 0.05), 6);
  // Beams near the horizon hardly change; few of the other points remain.
  const auto points = [](const CObservationPoles& poles) {
    std::size_t sum = 0;
    for (const auto& pole : poles.poles) sum += pole.points;
    return sum;
  };
  EXPECT_LT(3 * points(*byModel.process(scan)), 2 * points(*byTable.process(scan)));
}

// Those that MRPT 2.5.8 makes use only a part of them.
TEST(ObservationPoints, RotatingScansOfAVelodyneMayUseAllColumns) {
  const auto options = hdl32(1.5);
  auto scan = rotatingScan(options.sensor, topDown(), kUp);
  scan.lidarModel = "HDL-32E";
  ObservationPoints points(options.sensor);
  const auto returns = (scan.rangeImage.asEigen().array() != 0).count();
  EXPECT_EQ(points.read(scan).size, static_cast<std::size_t>(returns));
}

TEST(ObservationPoints, RotatingScansMayStateTheirDuration) {
  const auto options = hdl32(1.5);
  auto scan = rotatingScan(options.sensor, topDown(), kUp);
  ObservationPoints points(options.sensor);
  scan.sweepDuration = 0;
  points.read(scan);
  EXPECT_FALSE(points.timing());
  scan.sweepDuration = 0.1;
  points.read(scan);
  ASSERT_TRUE(points.timing());
  EXPECT_EQ(points.timing()->turn, Turn::counterclockwise);
  EXPECT_NEAR(points.timing()->seconds, 0.1, 1e-12);
  EXPECT_NEAR(points.timing()->cut, -M_PI, 1e-12);
  scan.azimuthSpan = -M_PI;  // half of a turn, the other way
  points.read(scan);
  EXPECT_EQ(points.timing()->turn, Turn::clockwise);
  EXPECT_NEAR(points.timing()->seconds, 0.2, 1e-12);
}

// Rings keep the elevations of the sensor itself; the sensor pose turns them over.
TEST(ObservationPoints, RotatingScanUpsideDown) {
  auto options = hdl32(1.5);
  const auto scan = rotatingScan(options.sensor, topDown(), CPose3D(0.5, 0.2, 1.5, 0.3, 0, M_PI));
  options.sensor.upsideDown = true;
  ObservationPoleExtractor extraction(options);
  EXPECT_GE(found(*extraction.process(scan), 0.05), 6);
}

TEST(ObservationPoints, RotatingScanClockwise) {
  const auto options = hdl32(1.5);
  const auto ccw = rotatingScan(options.sensor, topDown(), kUp);
  auto cw = ccw;
  cw.azimuthSpan = -2 * M_PI;
  cw.startAzimuth = M_PI;
  const int n = cw.columnCount;
  for (int column = 0; column < n; ++column)
    for (int row = 0; row < 32; ++row)
      cw.rangeImage(row, column) = ccw.rangeImage(row, (n - column) % n);
  ObservationPoleExtractor extraction(options);
  const auto expected = extraction.process(ccw)->poles;
  expectSamePoles(extraction.process(cw)->poles, expected, 1e-4);
}

TEST(ObservationPoints, RefusesRotatingScansOfUnknownElevations) {
  CObservationRotatingScan scan;
  scan.rowCount = 40;
  scan.columnCount = 100;
  scan.rangeResolution = 0.01;
  scan.rangeImage.setZero(40, 100);
  scan.rangeImage(0, 0) = 500;
  ObservationPoleExtractor extraction(hdl32(1.5));
  const std::string text = refusal(extraction, scan);
  EXPECT_HAS(text, "40 rows");
  EXPECT_HAS(text, "model = hdl32e has 32 beams");
  EXPECT_HAS(text, "elevations_deg");
}

TEST(ObservationPoints, UnprojectsDepthImagesOnACopy) {
  if (!std::filesystem::exists(kDatasets)) GTEST_SKIP() << kDatasets << " is not there";
  const auto depth =
      std::dynamic_pointer_cast<CObservation3DRangeScan>(firstOf("tests_rgbd.rawlog"));
  ASSERT_TRUE(depth && depth->hasRangeImage);
  // 273225 pixels have a depth; without the lens distortion, which is removed, 274235 do.
  const std::size_t invalid = 640u * 480u - 274235u;
  ObservationPoleExtractorOptions options;
  options.sensor.model = "uniform";
  options.sensor.rings = 240;
  options.sensor.fovUp = 0.5;
  options.sensor.fovDown = -0.5;
  options.sensor.columns = 2000;
  ObservationPoleExtractor extraction(options);
  extraction.process(*depth);
  EXPECT_EQ(extraction.report().points, 640u * 480u);
  EXPECT_EQ(extraction.report().invalid, invalid);
  depth->hasPoints3D = false;
  depth->resizePoints3DVectors(0);
  extraction.process(*depth);
  EXPECT_EQ(extraction.report().points, 640u * 480u);
  EXPECT_EQ(extraction.report().invalid, invalid);
  EXPECT_FALSE(depth->hasPoints3D);
}

TEST(ObservationPoints, RealKittiScan) {
  POLEMCL_NEEDS_DATA();
  CObservationPointCloud observation;
  observation.setAsExternalStorage(
      testing_apps::dataFolder().string() + "/kitti_raw_0005/velodyne/0000000000.bin",
      CObservationPointCloud::ExternalStorageFormat::KittiBinFile);
  ObservationPoleExtractor extraction(ObservationPoleExtractorOptions{});
  const auto scan = extraction.process(observation);
  EXPECT_GE(scan->poles.size(), 8u);
  EXPECT_GT(scan->points, 100000u);
}

}  // namespace
}  // namespace polemcl::test_observation_points
