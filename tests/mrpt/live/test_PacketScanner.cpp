// Packets of an Ouster and a Hesai on the loopback and in PCAP files become turns.

#include <gtest/gtest.h>
#include <mrpt/maps/CPointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <cmath>

#include <polemcl/mrpt/observation/ObservationPoleExtractor.h>
#include "mrpt/live/PcapFile.h"
#include "support/LiveSensorsTest.h"
#include "support/OusterTurns.h"

namespace polemcl::test_packet_scanner {
namespace {

using namespace testing_apps;
using mrpt::obs::CObservationPointCloud;

constexpr std::uint64_t kBoot = 5'000'000'000;  // ns

class OusterScannerTest : public LiveSensorsTest {
 protected:
  std::string ouster(const std::string& more = "", const std::string& metadata = "") const {
    writeText(folder / "os.json", metadata.empty() ? model.metadata() : metadata);
    return "[lidar]\ndriver = COusterScanner\nsensorLabel = roof\nmetadata_file = " +
           (folder / "os.json").string() + "\ndata_port = " + std::to_string(port) + "\n" + more;
  }
  std::vector<std::string> drive(int turns, int first = 65534, std::uint64_t begin = kBoot) const {
    std::vector<std::string> packets;
    for (int i = 0; i < turns; ++i)
      for (auto& packet : turnOfOuster(model, 0.5 * i, 0, 0, (first + i) % 65536,
                                       begin + static_cast<std::uint64_t>(i) * 100'000'000))
        packets.push_back(std::move(packet));
    return packets;
  }
  void receive(const std::string& ini, const std::vector<std::string>& packets,
               const std::string& host = "127.0.0.1") {
    const auto sensors = start(ini);
    const UdpSender data(port, host);
    ASSERT_TRUE(data.waitForListener());
    for (const auto& packet : packets) data.send(packet);
  }
  void play(const std::string& pcap, const std::string& more = "pcap_read_fast = true\n") {
    writeText(folder / "drive.pcap", pcap);
    const auto sensors = start(ouster(
        "process_rate = 1e6\npcap_input = " + (folder / "drive.pcap").string() + "\n" + more));
    ASSERT_TRUE(waitFor([&] { return ended() == 1; }));
  }
  std::vector<CObservationPointCloud::Ptr> turns() {
    std::vector<CObservationPointCloud::Ptr> all;
    const std::lock_guard lock(mutex);
    for (const auto& one : observations)
      all.push_back(std::dynamic_pointer_cast<CObservationPointCloud>(one));
    return all;
  }

  OusterModel model;
  const int port = freeUdpPort();
};

ObservationPoleExtractorOptions ousterOptions() {
  ObservationPoleExtractorOptions options;
  options.sensor.model = "table";
  for (int i = 0; i < OusterModel::rings; ++i)
    options.sensor.elevations.push_back(OusterModel::elevation(i) * M_PI / 180);
  options.sensor.columns = OusterModel::columns;
  options.sensor.height = streetSensorHeight;
  options.sensor.timing.turn = Turn::clockwise;
  options.sensor.timing.stamp = 0;
  return options;
}

/// Distance of a place from the nearest pole of the street.
double errorOf(double x, double y) {
  double nearest = 1e9;
  for (const StreetPole& one : streetPoles())
    nearest = std::min(nearest, std::hypot(one.x - x, one.y - y));
  return nearest;
}

/// Two bytes, the high one first.
std::string shortOf(std::size_t number) {
  return {static_cast<char>(number >> 8), static_cast<char>(number)};
}

/// The packets of a PCAP file as records: IPv4 in fragments behind a link layer.
std::string fragmented(const std::vector<std::string>& packets, int port, int linkType,
                       const std::string& link, std::size_t dropped = SIZE_MAX) {
  std::string file = pcapFile({}, port);
  file[20] = static_cast<char>(linkType);
  file[21] = static_cast<char>(linkType >> 8);
  constexpr std::size_t most = 1480;
  std::size_t number = 0;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    const std::string datagram =
        shortOf(7502) + shortOf(static_cast<std::size_t>(port)) + std::string(4, '\0') + packets[i];
    for (std::size_t begin = 0; begin < datagram.size(); begin += most) {
      const std::string part = datagram.substr(begin, most);
      const bool isLast = begin + most >= datagram.size();
      std::string ip = std::string("\x45\0", 2) + shortOf(20 + part.size()) + shortOf(i) +
                       shortOf(begin / 8 | (isLast ? 0 : 0x2000)) +
                       std::string("\x40\x11\0\0\x7f\0\0\1\x7f\0\0\1", 12);
      if (number++ == dropped) continue;
      const auto size = static_cast<std::uint32_t>(link.size() + ip.size() + part.size());
      for (const std::uint32_t one : {0u, 0u, size, size}) appendBytes(file, one);
      file += link + ip + part;
    }
  }
  return file;
}

const std::string kEthernet = std::string(12, '\0') + std::string("\x08\0", 2);

TEST_F(OusterScannerTest, TurnsShowThePolesOfTheStreet) {
  for (const char* profile : {"RNG19_RFL8_SIG16_NIR16", "LEGACY"}) {
    model.profile = profile;
    observations.clear();
    receive(ouster("pose_z = 1\npose_yaw = 90\n"), drive(5));
    const auto all = turns();
    ASSERT_EQ(all.size(), 3u) << profile;
    ObservationPoleExtractor extractor(ousterOptions());
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_EQ(all[i]->sensorLabel, "roof");
      EXPECT_NEAR(all[i]->sensorPose.yaw(), M_PI / 2, 1e-9);
      CObservationPointCloud level = *all[i];
      level.sensorPose = mrpt::poses::CPose3D(0, 0, streetSensorHeight, 0, 0, 0);
      const auto poles = extractor.process(level);
      EXPECT_GE(poles->poles.size(), 8u) << profile;
      for (const auto& pole : poles->poles)  // the columns are 6 mm apart at 1 m
        EXPECT_LT(errorOf(pole.x + 0.5 * (static_cast<double>(i) + 1), pole.y),
                  0.02 + 0.0025 * std::hypot(pole.x, pole.y));
    }
  }
}

TEST_F(OusterScannerTest, TheTimeIsThatOfTheBegin) {
  const auto before = mrpt::Clock::nowDouble();
  auto packets = drive(4);
  packets.erase(packets.begin() + 64, packets.begin() + 80);  // a quarter of the first whole turn
  receive(ouster(), packets);
  auto all = turns();
  ASSERT_EQ(all.size(), 2u);
  for (const auto& turn : all) {
    EXPECT_GT(mrpt::Clock::toDouble(turn->timestamp), before - 0.1);
    EXPECT_LT(mrpt::Clock::toDouble(turn->timestamp), mrpt::Clock::nowDouble());
  }
  EXPECT_EQ(lost, 16u);
  observations.clear();
  receive(ouster("sensor_time = true\n"), packets);
  all = turns();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_NEAR(mrpt::Clock::toDouble(all[0]->timestamp), 5.1, 1e-5);
  EXPECT_NEAR(mrpt::Clock::toDouble(all[1]->timestamp), 5.2, 1e-5);
}

/// A packet comes when its last column has been measured.
TEST_F(OusterScannerTest, WithoutItsClockTheTimeIsThatOfTheArrival) {
  const auto packets = drive(3);
  mrpt::Clock::time_point before, after;
  {
    const auto sensors = start(ouster());
    const UdpSender data(port);
    ASSERT_TRUE(data.waitForListener());
    for (std::size_t i = 0; i < packets.size(); ++i) {
      if (i >= 64 && i < 96) continue;  // half a turn is lost
      if (i == 96) before = mrpt::Clock::now();
      data.send(packets[i]);
      if (i == 96) after = mrpt::Clock::now();
    }
  }
  ASSERT_EQ(observed(), 1u);
  const auto measured = std::chrono::microseconds(100'000 * (32 * 16 + 15) / 1024);
  EXPECT_GE(turns()[0]->timestamp, before - measured - std::chrono::milliseconds(1));
  EXPECT_LE(turns()[0]->timestamp, after - measured + std::chrono::milliseconds(1));
}

TEST_F(OusterScannerTest, CountsWhatIsLostAndWhatIsIgnored) {
  auto packets = drive(4);
  packets.erase(packets.begin() + 150, packets.begin() + 153);
  packets.erase(packets.begin() + 60, packets.begin() + 66);  // over the end of a turn
  packets.insert(packets.begin() + 10, {std::string(48, 'i'), packets[0] + "x"});
  receive(ouster("address = 127.0.0.1\n"), packets);
  EXPECT_EQ(lost, 9u);
  EXPECT_EQ(ignored, 2u);
  ASSERT_EQ(observed(), 2u);
  const std::size_t whole = turns()[0]->pointcloud->size();
  EXPECT_GT(whole, 10'000u);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_HAS(warnings[1], "[lidar]: COusterScanner: packets are missing, the first before packet");
  // A LiDAR that was started again, and one with a window.
  lost = 0;
  packets = drive(2, 10);
  for (const auto& packet : drive(2, 300)) packets.push_back(packet);
  receive(ouster(), packets);
  EXPECT_EQ(lost, 0u);
  auto narrow = drive(3);
  narrow.erase(std::remove_if(narrow.begin(), narrow.end(),
                              [](const std::string& packet) {
                                const int column = static_cast<unsigned char>(packet[32 + 8]) |
                                                   static_cast<unsigned char>(packet[32 + 9]) << 8;
                                return column < 256 || column >= 512;
                              }),
               narrow.end());
  narrow.erase(narrow.begin() + 20);
  receive(ouster("", model.metadata(",\"column_window\":[256,511]")), narrow);
  EXPECT_EQ(lost, 1u);
}

TEST_F(OusterScannerTest, HearsPacketsToOtherAddressesOnlyIfAsked) {
  receive(ouster(), drive(3), "127.0.0.2");
  EXPECT_EQ(observed(), 0u);
  receive(ouster("address = 0.0.0.0\n"), drive(3), "127.0.0.2");
  EXPECT_EQ(observed(), 1u);
}

/// Memory must not grow for ever.
TEST_F(OusterScannerTest, ATurnThatDoesNotEndIsCut) {
  std::string packet = drive(1)[5];
  for (int i = 1; i < 16; ++i) packet.replace(32 + i * 396 + 8, 2, packet.substr(32 + 8, 2));
  receive(ouster(), std::vector<std::string>(3800, packet));
  EXPECT_EQ(observed(), 2u);  // of 20,000 columns, beside the first
}

TEST_F(OusterScannerTest, WhatIsLostDoesNotJoinTwoTurns) {
  auto packets = drive(5);
  packets.erase(packets.begin() + 64 + 10, packets.begin() + 64 * 3 + 20);
  receive(ouster(), packets);
  ASSERT_EQ(observed(), 2u);  // ten packets of one turn, 44 of another
  EXPECT_LT(turns()[0]->pointcloud->size(), turns()[1]->pointcloud->size());
}

TEST_F(OusterScannerTest, PcapFilesOfFragmentsArePutTogether) {
  const auto packets = drive(4);
  play(fragmented(packets, port, 1, kEthernet));
  ASSERT_EQ(observed(), 2u);
  EXPECT_EQ(ends[0], "");
  const std::size_t whole = turns()[0]->pointcloud->size();
  EXPECT_EQ(lost, 0u);
  observations.clear();
  ends.clear();
  play(fragmented(packets, port, 1, kEthernet, 64 * 9 + 3));  // a packet has nine fragments
  ASSERT_EQ(observed(), 2u);
  EXPECT_LT(turns()[0]->pointcloud->size(), whole);
  EXPECT_EQ(lost, 1u);
}

/// The begins of all datagrams, then their ends.
TEST_F(OusterScannerTest, OfAPcapFileSixteenDatagramsMayWaitForTheirEnds) {
  constexpr std::size_t header = 24, head = 16 + 14 + 20, begin = head + 1480, end = head + 520;
  const auto whole = [&](std::size_t datagrams) {
    const std::string file =
        fragmented(std::vector(datagrams, std::string(1992, 'x')), port, 1, kEthernet);
    std::string first, last;
    for (std::size_t at = header; at < file.size(); at += begin + end) {
      first += file.substr(at, begin);
      last += file.substr(at + begin, end);
    }
    writeText(folder / "mixed.pcap", file.substr(0, header) + first + last);
    PcapFile recording((folder / "mixed.pcap").string());
    std::size_t count = 0;
    for (RecordedPacket packet; recording.next(packet);) ++count;
    return count;
  };
  EXPECT_EQ(whole(16), 16u);
  EXPECT_EQ(whole(17), 0u) << "each end comes when its begin has been given up";
}

TEST_F(OusterScannerTest, PcapFilesOfOtherLinkLayersAreRead) {
  const auto packets = drive(3);
  const std::string vlan = std::string(12, '\0') + std::string("\x81\0\0\7\x88\xa8\0\1\x08\0", 10);
  const std::string cooked = std::string(14, '\0') + std::string("\x08\0", 2),
                    cooked2 = std::string("\x08\0", 2) + std::string(18, '\0');
  for (const auto& [type, link] : {std::pair{1, vlan}, std::pair{113, cooked},
                                   std::pair{276, cooked2}, std::pair{101, std::string()}}) {
    observations.clear();
    ends.clear();
    play(fragmented(packets, port, type, link));
    EXPECT_EQ(observed(), 1u) << type;
  }
}

TEST_F(OusterScannerTest, PcapFilesMayBePlayedAgain) {
  writeText(folder / "drive.pcap", pcapFile(drive(3), port));
  const auto sensors =
      start(ouster("pcap_read_fast = true\npcap_read_once = false\n"
                   "process_rate = 1e6\npcap_input = " +
                   (folder / "drive.pcap").string() + "\n"));
  EXPECT_TRUE(waitFor([&] { return observed() > 5; }));
  EXPECT_EQ(ended(), 0u);
}

TEST_F(OusterScannerTest, PcapFilesArePlayedAtTheirPace) {
  std::string pcap = pcapFile(drive(4), port);
  constexpr std::size_t head = 24, record = 16 + 42 + 32 + 16 * (12 + 32 * 12) + 32;
  for (std::size_t i = 0; i < 4 * 64; ++i) {  // 0.4 s in all
    std::string time;
    appendBytes(time, static_cast<std::uint32_t>(i * 1562));
    pcap.replace(head + i * record + 4, 4, time);
  }
  const auto begin = std::chrono::steady_clock::now();
  play(pcap, "");
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(390));
  const auto all = turns();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_GE(all[1]->timestamp - all[0]->timestamp, std::chrono::milliseconds(20));
}

/// A PandarXT16 among the poles: 250 packets a turn, which begins within a packet.
class HesaiScannerTest : public OusterScannerTest {
 protected:
  std::string hesai(const std::string& more = "") const {
    return "[lidar]\ndriver = CHesaiScanner\ncalibration_file = " +
           std::string(POLEMCL_SOURCE_DIR) +
           "/tests/mrpt/live/captures/hesai-xt16.csv\ndata_port = " + std::to_string(port) + "\n" +
           more;
  }
  static double elevation(int channel) { return 15 - 2 * channel; }  // degrees
  std::vector<std::string> driveXt16(int turns) const {
    const auto poles = streetPoles();
    std::vector<std::string> packets;
    for (int block = 3; block < turns * 2000; ++block) {
      const int azimuth = block % 2000 * 18;  // hundredths of a degree from y, clockwise
      if ((block - 3) % 8 == 0) packets.emplace_back("\xee\xff\6\1\0\0\x10\x08\0\4\1\2", 12);
      std::string& bytes = packets.back();
      appendBytes(bytes, static_cast<std::uint16_t>(azimuth));
      const double pole = rangeToPoles(poles, 0, 0, M_PI / 2 - azimuth * M_PI / 18000);
      for (int i = 0; i < 16; ++i) {
        const int range = firingRange(pole, elevation(i) * M_PI / 180);  // of 2 mm
        appendBytes(bytes, static_cast<std::uint16_t>(range / 2));
        bytes += "xx";
      }
      if ((block - 3) % 8 < 7) continue;
      bytes += std::string(10, '\0') + "\x37";
      appendBytes(bytes, std::uint16_t{600});
      bytes += std::string("\x7e\x0b\x1a\x0c\0\x05", 6);           // 2026-11-26 12:00:05
      appendBytes(bytes, static_cast<std::uint32_t>(block * 50));  // us
      bytes += "B";
      appendBytes(bytes, static_cast<std::uint32_t>(packets.size()));
    }
    packets.pop_back();
    return packets;
  }
};

TEST_F(HesaiScannerTest, TurnsShowThePolesOfTheStreet) {
  receive(hesai("sensor_time = true\n"), driveXt16(4));
  const auto all = turns();
  ASSERT_EQ(all.size(), 2u);
  ObservationPoleExtractorOptions options;
  options.sensor.model = "table";
  for (int i = 0; i < 16; ++i) options.sensor.elevations.push_back(elevation(i) * M_PI / 180);
  options.sensor.columns = 2000;
  options.sensor.height = streetSensorHeight;
  options.sensor.timing.turn = Turn::clockwise;
  options.sensor.timing.cut = M_PI / 2;
  options.sensor.timing.stamp = 0;
  ObservationPoleExtractor extractor(options);
  constexpr double begin = 1795694405;  // 2026-11-26 12:00:05 UTC
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i]->sensorLabel, "hesai");
    // The clock of a packet is that of its last block.
    EXPECT_NEAR(mrpt::Clock::toDouble(all[i]->timestamp), begin + 0.1 * (i + 1.0), 1e-4);
    CObservationPointCloud level = *all[i];
    level.sensorPose = mrpt::poses::CPose3D(0, 0, streetSensorHeight, 0, 0, 0);
    const auto poles = extractor.process(level);
    EXPECT_GE(poles->poles.size(), 5u);
    for (const auto& pole : poles->poles)
      EXPECT_LT(errorOf(pole.x, pole.y), 0.02 + 0.0025 * std::hypot(pole.x, pole.y));
    // The first and the last point are those of the begin and the end.
    const auto& points = *level.pointcloud;
    float x, y, z;
    points.getPoint(0, x, y, z);
    EXPECT_NEAR(std::atan2(x, y), 0, 1e-4);
    points.getPoint(points.size() - 1, x, y, z);
    EXPECT_NEAR(std::atan2(x, y), -0.18 * M_PI / 180, 1e-4);
  }
}

TEST_F(HesaiScannerTest, CountsLostPackets) {
  auto packets = driveXt16(2);
  packets.erase(packets.begin() + 100, packets.begin() + 107);
  packets.insert(packets.begin() + 50, std::string(512, 'p'));
  receive(hesai(), packets);
  EXPECT_EQ(lost, 7u);
  EXPECT_EQ(ignored, 1u);
}

TEST_F(OusterScannerTest, RefusesWhatCannotBe) {
  expectError("[lidar]\ndriver = COusterScanner\n",
              {"[lidar]: COusterScanner: metadata_file: name the JSON file"});
  expectError(ouster("", "{}"), {"[lidar]: COusterScanner: ", "os.json: is no metadata"});
  expectError("[lidar]\ndriver = CHesaiScanner\n",
              {"[lidar]: CHesaiScanner: calibration_file: name the CSV file"});
  expectError("[lidar]\ndriver = CHesaiScanner\ncalibration_file = none.csv\n",
              {"none.csv: cannot be read"});
  expectError(ouster("device_ip = roof\n"), {"device_ip = roof: is no IPv4 address"});
  expectError(ouster("pcap_input = none.pcap\n"), {"none.pcap"});
  const auto failure = [&](const std::string& pcap) {
    ends.clear();
    play(pcap);
    return ends.at(0);
  };
  EXPECT_HAS(
      failure(pcapFile(drive(1), port == 7777 ? 7778 : 7777)),
      "drive.pcap: has no UDP packet for data_port = " + std::to_string(port) + "; there are ");
  EXPECT_HAS(failure(pcapFile(drive(2), port)), "no whole turn in ");
  std::string cut = pcapFile(drive(1), port);
  cut.resize(cut.size() - 100);
  EXPECT_HAS(failure(cut), "drive.pcap: is damaged: truncated");
}

}  // namespace
}  // namespace polemcl::test_packet_scanner
