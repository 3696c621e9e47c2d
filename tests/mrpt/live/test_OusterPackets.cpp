/// \file test_OusterPackets.cpp
/// \brief Packets of real Ousters, and metadata right and wrong.

#include <gtest/gtest.h>

#include <cmath>

#include "mrpt/live/OusterPackets.h"
#include "mrpt/live/PcapFile.h"
#include "support/OusterTurns.h"
#include "support/Refusal.h"
#include "support/TempFolder.h"

namespace polemcl::test_ouster_packets {

using namespace testing_apps;

struct Capture {
  std::string name;
  std::uint32_t turn;
  std::size_t points;
  double sum;     ///< of the ranges, m
  double origin;  ///< distance of the beams' origins from the axis, m
};

/// Numbers of returns and sums of ranges by another program, whose range images of whole captures
/// have the checksums that Ouster states for four of these LiDARs.
TEST(OusterPackets, ReadsRealPacketsOfEachProfile) {
  const Capture captures[] = {{"os0-128-rng15", 1491, 1691, 18409.816, 0.027670},
                              {"os0-32-rng19-dual", 1453, 415, 1803.381, 0.027670},
                              {"os1-128-fusa", 229, 2048, 978.656, 0.016721},
                              {"os1-32-legacy", 638, 472, 7906.864, 0.015806},
                              {"os2-128-rng19", 1259, 1898, 34052.245, 0.013762}};
  for (const Capture& capture : captures) {
    const std::string file =
        std::string(POLEMCL_SOURCE_DIR) + "/tests/mrpt/live/captures/" + capture.name;
    const OusterPackets packets(file + ".json");
    RecordedPacket packet;
    ASSERT_TRUE(PcapFile(file + ".pcap").next(packet)) << capture.name;
    EXPECT_EQ(packet.port, 7502) << capture.name;
    ASSERT_EQ(packet.bytes.size(), packets.size()) << capture.name;
    EXPECT_EQ(packets.turnOf(packet.bytes), capture.turn);
    EXPECT_EQ(packets.columnOf(packet.bytes) % 16, 0);
    EXPECT_EQ(packets.columnOf(packet.bytes, 15), packets.columnOf(packet.bytes) + 15);
    EXPECT_NEAR(packets.timeOf(packet.bytes, 15) - packets.timeOf(packet.bytes),
                packets.turn() * 15 / packets.columns(), 2e-4);
    OusterPackets::Points points;
    packets.appendPoints(packet.bytes, points);
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

class OusterPacketsTest : public testing::Test {
 protected:
  OusterPackets of(const std::string& metadata) const {
    writeText(folder / "os.json", metadata);
    return OusterPackets((folder / "os.json").string());
  }

  const TempFolder folder;
  const OusterModel model;
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
  EXPECT_DOUBLE_EQ(packets.timeOf(packet), 1.5);
  OusterPackets::Points points;
  packets.appendPoints(packet, points);
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
  OusterPackets::Points single, both;
  one.appendPoints(turnOfOuster(model, 0, 0, 0, 1, 0)[20], single);
  std::string packet = turnOfOuster(dual, 0, 0, 0, 1, 0)[20];
  two.appendPoints(packet, both);
  ASSERT_GT(single.x.size(), 100u);
  EXPECT_EQ(both.x.size(), 2 * single.x.size());
  packet.replace(32 + 12 + 31 * 16 + 4, 4, packet.substr(32 + 12 + 31 * 16, 4));
  both = {};
  two.appendPoints(packet, both);
  EXPECT_EQ(both.x.size(), 2 * single.x.size() - 1);
}

TEST_F(OusterPacketsTest, PacketsOutsideTheWindowAreNotSent) {
  const auto sent = [&](const std::string& window) {
    const auto packets = of(model.metadata(",\"column_window\":[" + window + "]"));
    std::string all;
    for (int i = 0; i < 64; ++i) all += packets.isSent(i) ? 'x' : '-';
    return all;
  };
  EXPECT_EQ(sent("0,1023"), std::string(64, 'x'));
  EXPECT_EQ(sent("31,32"), "-xx" + std::string(61, '-'));
  EXPECT_EQ(sent("1008,15"), "x" + std::string(62, '-') + "x");
}

TEST_F(OusterPacketsTest, RefusesOtherMetadata) {
  EXPECT_REFUSED(OusterPackets((folder / "none.json").string()), "none.json: cannot be read");
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

}  // namespace polemcl::test_ouster_packets
