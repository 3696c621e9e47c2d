// Packets of real LiDARs of Ouster and Hesai, and their descriptions, right and wrong.

#include <gtest/gtest.h>

#include <cmath>

#include "mrpt/live/HesaiPackets.h"
#include "mrpt/live/OusterPackets.h"
#include "mrpt/live/PcapFile.h"
#include "support/OusterTurns.h"
#include "support/Refusal.h"
#include "support/TempFolder.h"

namespace polemcl::test_lidar_packets {
namespace {

using namespace testing_apps;

std::string captureOf(const std::string& name) {
  return std::string(POLEMCL_SOURCE_DIR) + "/tests/mrpt/live/captures/" + name;
}

RecordedPacket packetOf(const std::string& name) {
  RecordedPacket packet;
  EXPECT_TRUE(PcapFile(captureOf(name + ".pcap")).next(packet)) << name;
  return packet;
}

LidarPoints pointsOf(const LidarPackets& packets, const std::string& packet) {
  LidarPoints points;
  for (int i = 0; i < packets.columns(packet); ++i)
    if (packets.phase(packet, i)) packets.append(packet, i, points);
  return points;
}

/// Numbers of returns and sums of ranges by share/experiments/lidar_packets.py, whose range images
/// of whole captures have the checksums that Ouster states for four of these LiDARs.
TEST(OusterPackets, ReadsRealPacketsOfEachProfile) {
  const struct {
    std::string name;
    std::uint64_t turn;
    std::size_t points;
    double sum;     // of the ranges, m
    double origin;  // distance of the beams' origins from the axis, m
  } captures[] = {{"os0-128-rng15", 1491, 1691, 18409.816, 0.027670},
                  {"os0-32-rng19-dual", 1453, 415, 1803.381, 0.027670},
                  {"os1-128-fusa", 229, 2048, 978.656, 0.016721},
                  {"os1-32-legacy", 638, 472, 7906.864, 0.015806},
                  {"os2-128-rng19", 1259, 1898, 34052.245, 0.013762}};
  for (const auto& capture : captures) {
    const OusterPackets packets(captureOf(capture.name + ".json"));
    const RecordedPacket packet = packetOf(capture.name);
    EXPECT_EQ(packet.port, 7502) << capture.name;
    EXPECT_EQ(packets.usualPort(), 7502) << capture.name;
    ASSERT_TRUE(packets.isPacket(packet.bytes)) << capture.name;
    EXPECT_FALSE(packets.isPacket(packet.bytes + "x")) << capture.name;
    EXPECT_EQ(packets.number(packet.bytes)->value / 64, capture.turn);
    EXPECT_EQ(packets.number(packet.bytes)->value % 64,
              packets.phase(packet.bytes, 0).value() * 64);
    const double turn = packets.turn(packet.bytes);
    EXPECT_EQ(turn, 0.1);
    EXPECT_NEAR(packets.time(packet.bytes, 15) - packets.time(packet.bytes, 0), turn * 15 / 1024,
                2e-4);
    const LidarPoints points = pointsOf(packets, packet.bytes);
    EXPECT_EQ(points.x.size(), capture.points) << capture.name;
    double sum = 0;
    for (std::size_t i = 0; i < points.x.size(); ++i) {
      // The azimuth of the beam differs from that of its origin; the distance does, too.
      const double level = std::hypot(points.x[i], points.y[i]) - capture.origin;
      sum += std::hypot(level, points.z[i]) + capture.origin;
    }
    EXPECT_NEAR(sum, capture.sum, 0.002 * static_cast<double>(capture.points)) << capture.name;
  }
}

/// Numbers of returns, sums of ranges and last points by share/experiments/lidar_packets.py, whose
/// points of whole captures hold those that Nebula's authors state, to 0.01 mm.
TEST(HesaiPackets, ReadsRealPacketsOfEachModel) {
  const struct {
    std::string name;
    std::size_t points;
    double sum, x, y, z;  // m
    double phase, turn;
    std::uint32_t number;  // 0: not numbered
    double time;           // Unix time of the end, s
  } captures[] = {
      {"hesai-xt16", 53, 123.376, 0.350152, -0.356815, -0.008726, 0.375, 0.1, 0xf759fb,
       1564027949.437367},
      {"hesai-xt32", 140, 114.716, 0.061276, 2.187141, -0.001814, 0.003, 60.0 / 599, 0x49e54,
       1564024769.819174},
      {"hesai-xt32m", 45, 117.450, -0.258363, 2.400516, 0.054748, 0.982, 0.1, 0x4d2e7cd,
       1564037177.048055},
      {"hesai-qt64", 124, 174.148, -0.235647, 2.776609, 2.642066, 0.12 / 36, 0.1, 0x28891,
       1504708283.017888},
      {"hesai-64", 147, 147.720, 0.036312, 0.317822, -0.008399, 0.091 / 36, 60.0 / 599, 0x23b839,
       1593086530.177358},
      {"hesai-40p", 164, 157.940, 0.004901, 0.335064, -0.077746, 0.003, 0.1, 0, 1504714787.081305}};
  for (const auto& capture : captures) {
    const HesaiPackets packets(captureOf(capture.name + ".csv"));
    const RecordedPacket packet = packetOf(capture.name);
    EXPECT_EQ(packet.port, packets.usualPort()) << capture.name;
    ASSERT_TRUE(packets.isPacket(packet.bytes)) << capture.name;
    EXPECT_FALSE(packets.isPacket(packet.bytes + "x")) << capture.name;
    EXPECT_FALSE(packets.isPacket(std::string(packet.bytes.size(), 'x'))) << capture.name;
    EXPECT_EQ(packets.number(packet.bytes).value_or(LidarPackets::Number{0, 0}).value,
              capture.number);
    EXPECT_NEAR(packets.phase(packet.bytes, 0).value(), capture.phase, 1e-9) << capture.name;
    EXPECT_NEAR(packets.turn(packet.bytes), capture.turn, 1e-9) << capture.name;
    const int last = packets.columns(packet.bytes) - 1;
    const double end = packets.time(packet.bytes, last);
    EXPECT_NEAR(end, capture.time, 1e-6) << capture.name;
    EXPECT_NEAR(end - packets.time(packet.bytes, 0),
                capture.turn * (*packets.phase(packet.bytes, last) - capture.phase), 1e-6);
    const LidarPoints points = pointsOf(packets, packet.bytes);
    ASSERT_EQ(points.x.size(), capture.points) << capture.name;
    double sum = 0;
    for (std::size_t i = 0; i < points.x.size(); ++i)
      sum += std::hypot(points.x[i], points.y[i], points.z[i]);
    EXPECT_NEAR(sum, capture.sum, 1e-4) << capture.name;
    EXPECT_NEAR(points.x.back(), capture.x, 2e-6) << capture.name;
    EXPECT_NEAR(points.y.back(), capture.y, 2e-6) << capture.name;
    EXPECT_NEAR(points.z.back(), capture.z, 2e-6) << capture.name;
  }
}

TEST(HesaiPackets, RefusesOtherTables) {
  const TempFolder folder;
  const auto of = [&](const std::string& text) {
    writeText(folder / "a.csv", text);
    return HesaiPackets((folder / "a.csv").string());
  };
  EXPECT_REFUSED(HesaiPackets((folder / "none.csv").string()), "none.csv: cannot be read");
  EXPECT_REFUSED(HesaiPackets("/dev/zero"), "/dev/zero: cannot be read: it is a device");
  const std::string begin = "Channel,Elevation,Azimuth\n";
  const auto expect = [&](const std::string& text, const std::string& why) {
    EXPECT_REFUSED(of(text), "a.csv: is no table of the angles of a Hesai: ", why);
  };
  expect("", "0 channels; allowed are 16, 32, 40 and 64");
  expect(begin + "1,2,3\n", "1 channels");
  expect(begin + "1,2\n", "row 1 is not its number, elevation, azimuth");
  expect(begin + "1,2,3\n3,2,3\n", "row 2 is not its number");
  expect(begin + "1,91,3\n", "row 1 has angles beyond 90 degrees");
  expect(begin + "1,1,-91\n", "row 1 has angles beyond 90 degrees");
}

class OusterPacketsTest : public testing::Test {
 protected:
  OusterPackets of(const std::string& metadata) const {
    writeText(folder / "os.json", metadata);
    return OusterPackets((folder / "os.json").string());
  }

  const TempFolder folder;
  const OusterModel model{};
};

/// A metre in each column of a ring without tilt, seen from the axis.
TEST_F(OusterPacketsTest, PointsAreWhereTheManualHasThem) {
  const auto packets = of(
      R"({"beam_altitude_angles":[0,30],"beam_azimuth_angles":[0,90],"lidar_mode":"4x10",
          "lidar_origin_to_beam_origin_mm":100,"data_format":{"columns_per_frame":4,
          "columns_per_packet":4,"pixels_per_column":2,"udp_profile_lidar":"RNG15_RFL8_NIR8"}})");
  ASSERT_EQ(packets.size(), 32u + 4 * (12 + 2 * 4) + 32);
  std::string packet(32, '\0');
  for (int column = 0; column < 4; ++column) {
    appendBytes(packet, std::uint64_t{1'500'000'000});
    appendBytes(packet, static_cast<std::uint16_t>(column));
    appendBytes(packet, static_cast<std::uint16_t>(column == 2 ? 0 : 1));  // one is not valid
    appendBytes(packet, std::uint32_t{0xABCD8000u | 1100 / 8});
    appendBytes(packet, std::uint32_t{column == 0 ? 2104u / 8 : 0});
  }
  packet += std::string(32, '\0');
  EXPECT_DOUBLE_EQ(packets.time(packet, 0), 1.5);
  const LidarPoints points = pointsOf(packets, packet);
  ASSERT_EQ(points.x.size(), 4u);
  // 1096 mm (137 units of 8 mm) from the axis; column 0 looks backwards, column 1 to the left.
  const double x[] = {-1.096, -0.1, 0, 0}, y[] = {0, 2.004 * std::cos(M_PI / 6), 1.096, -1.096},
               z[] = {0, 1.002, 0, 0};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(points.x[i], x[i], 1e-6) << i;
    EXPECT_NEAR(points.y[i], y[i], 1e-6) << i;
    EXPECT_NEAR(points.z[i], z[i], 1e-6) << i;
  }
}

TEST_F(OusterPacketsTest, TheSecondReturnIsAPointIfItIsAnother) {
  OusterModel dual;
  dual.profile = "RNG19_RFL8_SIG16_NIR16_DUAL";
  const auto one = of(model.metadata()), two = of(dual.metadata());
  const LidarPoints single = pointsOf(one, turnOfOuster(model, 0, 0, 0, 1, 0)[20]);
  std::string packet = turnOfOuster(dual, 0, 0, 0, 1, 0)[20];
  ASSERT_GT(single.x.size(), 100u);
  EXPECT_EQ(pointsOf(two, packet).x.size(), 2 * single.x.size());
  packet.replace(32 + 12 + 31 * 16 + 4, 4, packet.substr(32 + 12 + 31 * 16, 4));
  EXPECT_EQ(pointsOf(two, packet).x.size(), 2 * single.x.size() - 1);
}

/// Only those that the LiDAR sends are numbered.
TEST_F(OusterPacketsTest, PacketsOutsideTheWindowAreNotNumbered) {
  const auto turn = turnOfOuster(model, 0, 0, 0, 3, 0);
  const auto numbers = [&](const std::string& window) {
    const auto packets = of(model.metadata(",\"column_window\":[" + window + "]"));
    std::vector<std::uint64_t> all;
    for (const std::size_t i : {0, 1, 2, 3, 63}) all.push_back(packets.number(turn[i])->value);
    all.push_back(packets.number(turn[0])->end);
    return all;
  };
  using Numbers = std::vector<std::uint64_t>;
  EXPECT_EQ(numbers("0,1023"), (Numbers{192, 193, 194, 195, 255, 65536 * 64}));
  EXPECT_EQ(numbers("31,32"), (Numbers{6, 6, 7, 8, 8, 65536 * 2}));  // packets 1 and 2
  EXPECT_EQ(numbers("16,32"), numbers("31,32"));
  EXPECT_EQ(numbers("1008,15"), (Numbers{6, 7, 7, 7, 7, 65536 * 2}));
  EXPECT_REFUSED(of(model.metadata(",\"column_window\":[5000,6000]")), "column_window");
}

TEST_F(OusterPacketsTest, RefusesOtherMetadata) {
  EXPECT_REFUSED(OusterPackets((folder / "none.json").string()), "none.json: cannot be read");
  EXPECT_REFUSED(OusterPackets("/dev/zero"), "/dev/zero: cannot be read: it is a device");
  const auto expect = [&](const std::string& text, const std::string& why) {
    EXPECT_REFUSED(of(text), "os.json: is no metadata of an Ouster: ", why);
  };
  expect("no JSON", "parse error");
  expect("{}", "type must be string");
  EXPECT_REFUSED(of(std::string(100, '[')), "nested");
  const auto with = [&](const std::string& old, const std::string& now) {
    std::string text = model.metadata();
    return text.replace(text.find(old), old.size(), now);
  };
  expect(with("1024x10", "fast"), "lidar_mode is no columns x turns a second, such as 1024x10");
  expect(with("1024x10", "1024x0"), "lidar_mode");
  expect(with("RNG19_RFL8_SIG16_NIR16", "RNG99"), "udp_profile_lidar RNG99 is not known");
  expect(with(":1024,", ":1e9,"), "columns_per_frame is not 0 to 8192");
  expect(with(":1024,", ":0,"), "no columns");
  expect(with(":16,", ":0,"), "no columns");
  expect(with(":16,", ":8000,"), "longer than UDP allows");
  expect(with(":32,", ":33,"), "pixels_per_column differ");
  expect(with(":[16.6", ":[1016.6"), "beam_altitude_angles: are not -360 to 360 degrees");
  expect(with("15.8", "1500"), "below 1 m");
}

}  // namespace
}  // namespace polemcl::test_lidar_packets
