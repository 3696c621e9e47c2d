/// \file test_COusterScanner.cpp
/// \brief Packets of an Ouster on the loopback and in PCAP files become turns.

#include <gtest/gtest.h>
#include <mrpt/maps/CPointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <cmath>

#include <polemcl/mrpt/observation/ObservationPoleExtractor.h>
#include "support/LiveSensorsTest.h"
#include "support/OusterTurns.h"

namespace polemcl::test_ouster_scanner {

using namespace testing_apps;
using mrpt::obs::CObservationPointCloud;

namespace {

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
  void receive(const std::string& ini, const std::vector<std::string>& packets) {
    const auto sensors = start(ini);
    const UdpSender data(port);
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

}  // namespace

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

TEST_F(OusterScannerTest, TheTimeIsThatOfColumnZero) {
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

/// Memory must not grow for ever.
TEST_F(OusterScannerTest, ATurnThatDoesNotEndIsCut) {
  receive(ouster(), std::vector<std::string>(300, drive(1)[5]));
  EXPECT_EQ(observed(), 1u);
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

TEST_F(OusterScannerTest, RefusesWhatCannotBe) {
  expectError("[lidar]\ndriver = COusterScanner\n",
              {"[lidar]: COusterScanner: metadata_file: name the JSON file"});
  expectError(ouster("", "{}"), {"[lidar]: COusterScanner: ", "os.json: is no metadata"});
  expectError(ouster("device_ip = roof\n"), {"device_ip = roof: is no IPv4 address"});
  expectError(ouster("pcap_input = none.pcap\n"), {"none.pcap"});
  const auto failure = [&](const std::string& pcap) {
    ends.clear();
    play(pcap);
    return ends.at(0);
  };
  EXPECT_HAS(failure(pcapFile(drive(1), port == 7777 ? 7778 : 7777)),
             "drive.pcap: has no UDP packet for the ports of the LiDAR: check data_port");
  EXPECT_HAS(failure(pcapFile(drive(2), port)), "no whole turn in ");
  std::string cut = pcapFile(drive(1), port);
  cut.resize(cut.size() - 100);
  EXPECT_HAS(failure(cut), "drive.pcap: is damaged: truncated");
}

}  // namespace polemcl::test_ouster_scanner
