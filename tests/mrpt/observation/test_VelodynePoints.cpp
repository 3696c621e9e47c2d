// Points of Velodyne packets, against MRPT where it reads them, and against the simulated
// street.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include <polemcl/core/common/Types.h>
#include "mrpt/observation/ObservationPoints.h"
#include "mrpt/observation/VelodynePoints.h"
#include "support/Refusal.h"
#include "support/VelodynePackets.h"

namespace polemcl::test_velodyne_points {
namespace {

using testing_apps::appendBytes;
using Scan = mrpt::obs::CObservationVelodyneScan;

/// Not every MRPT has that of an HDL-64E. No two lasers are alike.
mrpt::obs::VelodyneCalibration hdl64() {
  mrpt::obs::VelodyneCalibration calibration;
  for (int i = 0; i < 64; ++i) {
    auto& laser = calibration.laser_corrections.emplace_back();
    const double elevation = (2 - 0.42 * i) * M_PI / 180;
    laser.sinVertCorrection = std::sin(elevation);
    laser.cosVertCorrection = std::cos(elevation);
    laser.azimuthCorrection = i % 2 ? 9.87 - 0.1 * i : -8.5;
    laser.distanceCorrection = 0.5 + 0.01 * i;
    laser.verticalOffsetCorrection = 0.2 - 0.001 * i;
    laser.horizontalOffsetCorrection = i % 2 ? 0.026 : -0.026;
  }
  return calibration;
}

Scan scanOf(const std::string& model, const std::vector<std::string>& packets) {
  Scan scan;
  scan.calibration =
      model == "HDL64" ? hdl64() : mrpt::obs::VelodyneCalibration::LoadDefaultCalibration(model);
  scan.minRange = 0.5;
  scan.maxRange = 100;
  for (const std::string& packet : packets)
    std::memcpy(&scan.scan_packets.emplace_back(), packet.data(), packet.size());
  return scan;
}

VelodynePoints read(const Scan& scan) {
  VelodynePoints points;
  readVelodynePackets(scan, points);
  return points;
}

/// Twelve blocks of which only the first returns are not zero; any azimuths.
std::string randomPacket(std::mt19937& random, int returns, bool isDual) {
  std::string bytes;
  for (int block = 0; block < 12; ++block) {
    const bool isLower = random() % 4 == 0;
    appendBytes(bytes, static_cast<std::uint16_t>(isLower ? 0xDDFF : 0xEEFF));
    appendBytes(bytes, static_cast<std::uint16_t>((35000 + 150 * block + random() % 9) % 36000));
    for (int i = 0; i < 32; ++i) {
      const auto range = static_cast<std::uint16_t>(random() % 3 == 0 ? 9999 : random());
      appendBytes(bytes, i < returns ? range : std::uint16_t{0});
      bytes.push_back(100);
    }
  }
  appendBytes(bytes, std::uint32_t{0});
  return bytes + (isDual ? "\x39\x22" : "\x37\x22");
}

TEST(VelodynePoints, TheirPacketsTellWhenTheyAreMeasured) {
  std::mt19937 random(3);
  // Turns of 0.1 s: a quarter between two packets, over the full hour.
  std::vector<std::string> packets;
  for (const std::uint32_t time : {3599960000u, 3599985000u, 10000u, 35000u}) {
    const auto azimuth = static_cast<std::uint16_t>(4500 + 9000 * packets.size());
    packets.push_back(randomPacket(random, 32, false));
    std::memcpy(&packets.back()[2], &azimuth, sizeof azimuth);
    std::memcpy(&packets.back()[1200], &time, sizeof time);
  }
  const Scan scan = scanOf("HDL32", packets);
  ObservationPoints points{SensorOptions()};
  points.read(scan);
  ASSERT_TRUE(points.timing());
  EXPECT_EQ(points.timing()->turn, Turn::clockwise);
  EXPECT_NEAR(points.timing()->seconds, 0.1, 1e-12);
  EXPECT_NEAR(points.timing()->cut, -M_PI / 4, 1e-12);
}

/// MRPT's table of sines divides the turn by 35,999, and it rounds halves of a unit by chance.
TEST(VelodynePoints, AreThoseOfMrptWhereItReadsThem) {
  constexpr double twoUnits = 2 * 2 * M_PI / 36000;
  std::mt19937 random(3);
  for (const char* model : {"VLP16", "HDL32"})
    for (const bool isDual : {false, true}) {
      Scan scan = scanOf(model, {randomPacket(random, 16, isDual), randomPacket(random, 16, isDual),
                                 randomPacket(random, 16, isDual)});
      const VelodynePoints points = read(scan);
      Scan::TGeneratePointCloudParameters parameters;
      parameters.minDistance = 0;
      testing::internal::CaptureStderr();
      scan.generatePointCloud(parameters);
      testing::internal::GetCapturedStderr();  // blocks of a lower bank
      const auto& expected = scan.point_cloud;
      ASSERT_GT(expected.size(), 200u);
      ASSERT_EQ(points.x.size(), expected.size()) << model << isDual;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        const double far = std::hypot(expected.x[i], expected.y[i]) * twoUnits;
        ASSERT_NEAR(points.x[i], expected.x[i], far) << model << isDual << i;
        ASSERT_NEAR(points.y[i], expected.y[i], far) << model << isDual << i;
        ASSERT_NEAR(points.z[i], expected.z[i], 1e-4) << model << isDual << i;
        ASSERT_EQ(points.laser[i], expected.laser_id[i]);
      }
    }
}

/// The beam begins beside and above the axis: along it by the range, across it by the offsets.
TEST(VelodynePoints, OfAnHdl64eAreCorrectedAsItsManualSays) {
  std::mt19937 random(3);
  const std::string packet = randomPacket(random, 32, false);
  const Scan scan = scanOf("HDL64", {packet});
  const VelodynePoints points = read(scan);
  std::size_t next = 0;
  for (const auto& block : scan.scan_packets[0].blocks)
    for (int k = 0; k < 32; ++k) {
      const int i = block.header() == Scan::LOWER_BANK ? k + 32 : k;
      const double range = block.laser_returns[k].distance() * 0.002 + 0.5 + 0.01 * i;
      if (block.laser_returns[k].distance() == 0 || range < scan.minRange || range > scan.maxRange)
        continue;
      const double e = (2 - 0.42 * i) * M_PI / 180;
      const double a = block.rotation() * M_PI / 18000 -
                       (i % 2 ? 9.87 - 0.1 * i : -8.5) * M_PI / 180;  // clockwise
      const Eigen::Vector3d along(std::cos(e) * std::cos(a), -std::cos(e) * std::sin(a),
                                  std::sin(e)),
          aside(std::sin(a), std::cos(a), 0), up = along.cross(aside);
      const Eigen::Vector3d expected =
          range * along + (i % 2 ? 0.026 : -0.026) * aside + (0.2 - 0.001 * i) * up;
      ASSERT_LT(next, points.x.size());
      EXPECT_EQ(points.laser[next], i);
      EXPECT_NEAR(points.x[next], expected.x(), 1e-4);
      EXPECT_NEAR(points.y[next], expected.y(), 1e-4);
      EXPECT_NEAR(points.z[next], expected.z(), 1e-4);
      ++next;
    }
  EXPECT_EQ(next, points.x.size());
  EXPECT_GT(next, 200u);
}

/// The range and the direction that the simulation gave each return.
TEST(VelodynePoints, AreAllReturnsOfAVlp16) {
  const Scan scan =
      scanOf("VLP16", testing_apps::turnOfVlp16(testing_apps::streetPoles(), 0, 0, 0));
  const VelodynePoints points = read(scan);
  constexpr double unit = 0.4 * M_PI / 180;  // rad from block to block
  std::size_t next = 0;
  for (std::size_t block = 0; block < 900; ++block)
    for (std::size_t i = 0; i < 32; ++i) {
      const auto& one = scan.scan_packets[block / 12].blocks[block % 12].laser_returns[i];
      const double range = one.distance() * 0.002;
      if (range < scan.minRange) continue;
      ASSERT_LT(next, points.x.size());
      const double turned = (i / 16 * 55.296 + i % 16 * 2.304) / 110.592;
      const double azimuth = (static_cast<double>(block) + turned) * unit;
      const double elevation = (i % 2 ? i % 16 : i % 16 - 15.0) * M_PI / 180;
      ASSERT_NEAR(points.x[next], range * std::cos(elevation) * std::cos(azimuth), 0.006);
      ASSERT_NEAR(points.y[next], -range * std::cos(elevation) * std::sin(azimuth), 0.006);
      ASSERT_NEAR(points.z[next], range * std::sin(elevation), 0.006);
      ++next;
    }
  EXPECT_EQ(next, points.x.size());
  EXPECT_GT(next, 8000u);
}

/// The topmost laser of an HDL-32E fires last: 31 of 40 parts of the time to the next block.
TEST(VelodynePoints, HoldTheUpperLasersOfAnHdl32e) {
  std::string packet;
  for (int block = 0; block < 12; ++block) {
    appendBytes(packet, std::uint16_t{0xEEFF});
    appendBytes(packet, static_cast<std::uint16_t>(9000 + 40 * block));
    packet += std::string(31 * 3, '\0');
    appendBytes(packet, std::uint16_t{5000});
    packet.push_back(100);
  }
  packet += std::string(4, '\0') + "\x37\x21";
  const VelodynePoints points = read(scanOf("HDL32", {packet}));
  ASSERT_EQ(points.x.size(), 12u);
  const double elevation = 10.67 * M_PI / 180;
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(points.laser[i], 31);
    EXPECT_NEAR(points.z[i], 10 * std::sin(elevation), 1e-3);
    EXPECT_NEAR(std::hypot(points.x[i], points.y[i]), 10 * std::cos(elevation), 1e-3);
    EXPECT_NEAR(-std::atan2(points.y[i], points.x[i]) * 180 / M_PI, 90.31 + 0.4 * i, 1e-3);
  }
}

TEST(VelodynePoints, NeedACalibration) {
  Scan scan;
  EXPECT_REFUSED(read(scan), "a calibration of 0 lasers; allowed are 16, 32 and 64");
}

TEST(VelodynePoints, NeedACalibrationOfPossibleNumbers) {
  std::mt19937 random(3);
  Scan scan = scanOf("HDL64", {randomPacket(random, 32, false)});
  const std::size_t count = read(scan).x.size();
  auto& laser = scan.calibration.laser_corrections[7];
  for (const double correction : {360.0, -360.0}) {
    laser.azimuthCorrection = correction;
    EXPECT_EQ(read(scan).x.size(), count);
  }
  laser.azimuthCorrection = 1e9;
  EXPECT_REFUSED(read(scan), "laser 7 has an azimuthCorrection of 1e+09; allowed are -360 to 360");
  laser.azimuthCorrection = NAN;
  EXPECT_REFUSED(read(scan), "laser 7 has an azimuthCorrection of nan");
  laser.azimuthCorrection = 0;
  laser.distanceCorrection = INFINITY;
  EXPECT_REFUSED(read(scan), "laser 7 has a correction that is not finite");
}

}  // namespace
}  // namespace polemcl::test_velodyne_points
