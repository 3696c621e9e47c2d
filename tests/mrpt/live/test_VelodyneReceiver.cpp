// Packets of Velodynes on the loopback and in PCAP files become turns.

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <cstdio>
#include <cstring>
#include <numeric>
#include <tuple>

#include "mrpt/rawlog/RawlogReader.h"
#include "support/LiveSensorsTest.h"
#include "support/VelodynePackets.h"

namespace polemcl::test_velodyne_receiver {
namespace {

using namespace testing_apps;
using mrpt::obs::CObservationVelodyneScan;

using Packets = std::vector<std::string>;

class VelodyneReceiverTest : public LiveSensorsTest {
 protected:
  static int portIn(const std::string& ini, const std::string& key = "data_port") {
    return std::stoi(ini.substr(ini.find(key + " = ") + key.size() + 3));
  }
  /// Starts a LiDAR, sends it packets and ends it when all have been read. The first turn is left
  /// out, the last one has no end.
  void receive(const std::string& ini, const Packets& packets, const Packets& positions = {},
               const std::string& dataHost = "127.0.0.1",
               const std::string& positionHost = "127.0.0.1") {
    const auto sensors = start(ini);
    const UdpSender data(portIn(ini), dataHost),
        position(portIn(ini, "position_port"), positionHost);
    ASSERT_TRUE(data.waitForListener());
    position.sendAll(positions);
    data.sendAll(packets);
  }
  std::vector<CObservationVelodyneScan::Ptr> scans() {
    std::vector<CObservationVelodyneScan::Ptr> all;
    const std::lock_guard lock(mutex);
    for (const auto& one : observations)
      all.push_back(std::dynamic_pointer_cast<CObservationVelodyneScan>(one));
    return all;
  }
};

Packets drive(int turns, std::uint32_t clock = 0) {
  Packets packets;
  for (int turn = 0; turn < turns; ++turn)
    for (std::string& packet : turnOfVlp16(streetPoles(), 0.5 * turn, 0, 0)) {
      if (clock > 0) std::memcpy(&packet[1200], &(clock += 1327), sizeof clock);
      packets.push_back(std::move(packet));
    }
  return packets;
}

/// Says that it is this time of 2025-03-23.
std::string positionPacket(char validity, const std::string& time = "105959") {
  const std::string fix =
      "GPRMC," + time + "," + validity + ",4807.038,N,01131.000,E,022.4,084.4,230325,003.1,W";
  const int sum = std::accumulate(fix.begin(), fix.end(), 0, std::bit_xor<>());
  char line[100];
  std::snprintf(line, sizeof line, "$%s*%02X\r\n", fix.c_str(), static_cast<unsigned>(sum));
  std::string packet(512, '\0');
  return packet.replace(206, std::strlen(line), line);
}

constexpr double kElevenOClock = 1742727600;  // 2025-03-23

void expectSamePackets(const CObservationVelodyneScan& a, const CObservationVelodyneScan& b) {
  ASSERT_EQ(a.scan_packets.size(), b.scan_packets.size());
  EXPECT_EQ(std::memcmp(a.scan_packets.data(), b.scan_packets.data(),
                        a.scan_packets.size() * sizeof a.scan_packets[0]),
            0);
}

/// Turns that MRPT recorded, the first one twice.
TEST_F(VelodyneReceiverTest, PacketsOfARealVlp16BecomeTheRecordedScans) {
  std::vector<CObservationVelodyneScan::Ptr> turns;
  RawlogReader reader("/usr/share/mrpt/datasets/test_velodyne_VLP16.rawlog");
  for (RawlogEntry entry; reader.next(entry);)
    if (auto scan = std::dynamic_pointer_cast<CObservationVelodyneScan>(entry.observation))
      turns.push_back(scan);
  ASSERT_FALSE(turns.empty());
  turns.insert(turns.begin(), turns.front());
  Packets packets;
  const auto add = [&](const CObservationVelodyneScan::TVelodyneRawPacket& packet) {
    packets.emplace_back(reinterpret_cast<const char*>(&packet), sizeof packet);
  };
  for (const auto& turn : turns)
    std::for_each(turn->scan_packets.begin(), turn->scan_packets.end(), add);
  add(turns[0]->scan_packets[0]);

  receive(velodyne(""), packets);
  const auto received = scans();
  ASSERT_EQ(received.size() + 1, turns.size());
  for (std::size_t i = 1; i < turns.size(); ++i) expectSamePackets(*received[i - 1], *turns[i]);
}

TEST_F(VelodyneReceiverTest, APcapFileGivesTheSameTurns) {
  const std::string ini =
      velodyne("sensorLabel = roof\npose_x = 0.5\npose_z = 1.5\npose_yaw = 90\npose_pitch = 2\n");
  const Packets packets = drive(5, 1000), positions{positionPacket('V'), positionPacket('A')};
  writeText(folder / "a.pcap", pcapFile({positions[1]}, portIn(ini, "position_port")) +
                                   pcapFile(packets, portIn(ini)).substr(24));
  const auto played = start(ini + "pcap_read_fast = true\nprocess_rate = 1e6\npcap_input = " +
                            (folder / "a.pcap").string());
  ASSERT_TRUE(waitFor([&] { return ended() == 1; }));
  const auto expected = scans();
  observations.clear();
  receive(ini + "pos_packets_min_period = 0\n", packets, positions);
  const auto received = scans();
  ASSERT_EQ(expected.size(), 3u);
  ASSERT_EQ(received.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto &one = *received[i], &other = *expected[i];
    expectSamePackets(one, other);
    EXPECT_EQ(one.sensorLabel, "roof_SCAN");
    EXPECT_EQ(one.sensorLabel, other.sensorLabel);
    EXPECT_EQ(one.sensorPose.asString(), other.sensorPose.asString());
    EXPECT_EQ(one.minRange, other.minRange);
    EXPECT_EQ(one.maxRange, other.maxRange);
    EXPECT_TRUE(one.has_satellite_timestamp);
    EXPECT_FALSE(other.has_satellite_timestamp);  // a file counts as measured when it is played
    EXPECT_EQ(other.timestamp, other.originalReceivedTimestamp);
    ASSERT_EQ(one.calibration.laser_corrections.size(), 16u);
    EXPECT_EQ(one.calibration.laser_corrections[3].verticalCorrection,
              other.calibration.laser_corrections[3].verticalCorrection);
  }
}

TEST_F(VelodyneReceiverTest, TheModelIsThatOfItsKey) {
  std::string ini = velodyne("");
  ini.replace(ini.find("VLP16"), 5, "HDL32");
  receive(ini, drive(3));
  writeText(folder / "a.pcap", pcapFile(drive(3), portIn(ini)));
  const auto played = start(ini + "pcap_read_fast = true\nprocess_rate = 1e6\npcap_input = " +
                            (folder / "a.pcap").string());
  ASSERT_TRUE(waitFor([&] { return ended() == 1; }));
  ASSERT_EQ(observed(), 2u);
  for (const auto& scan : scans()) {
    EXPECT_EQ(scan->calibration.laser_corrections.size(), 32u);
    EXPECT_EQ(scan->maxRange, 70);
  }
}

TEST_F(VelodyneReceiverTest, TimesAreThoseOfTheArrivalOrOfGps) {
  const auto before = mrpt::Clock::now();
  receive(velodyne(""), drive(4, 1000), {positionPacket('V')});
  for (const auto& scan : scans()) {
    EXPECT_FALSE(scan->has_satellite_timestamp);
    EXPECT_EQ(scan->timestamp, scan->originalReceivedTimestamp);
    EXPECT_GE(scan->timestamp, before);
    EXPECT_LE(scan->timestamp, mrpt::Clock::now());
  }
  ASSERT_EQ(observed(), 2u);
  // The LiDAR is half a second in the next hour, then still in the last second of the hour before.
  for (const auto& [fix, clock, time] : {std::tuple{"105959", 400000u, kElevenOClock + 0.4},
                                         std::tuple{"110000", 3599700000u, kElevenOClock - 0.3}}) {
    observations.clear();
    receive(velodyne(""), drive(4, clock), {positionPacket('A', fix)});
    const auto all = scans();
    ASSERT_EQ(all.size(), 2u);
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_TRUE(all[i]->has_satellite_timestamp);
      EXPECT_NEAR(mrpt::Clock::toDouble(all[i]->timestamp),
                  time + 1327e-6 * (75 * (static_cast<double>(i) + 1) + 1), 2e-6);
      EXPECT_GE(all[i]->originalReceivedTimestamp, before);
    }
  }
}

TEST_F(VelodyneReceiverTest, TwoAtOnceHavePortsOfTheirOwn) {
  const std::string left = velodyne("sensorLabel = left\n");
  std::string right = velodyne("sensorLabel = right\n");
  right.replace(0, 7, "[right]");
  auto sensors = start(left + right);
  const UdpSender toLeft(portIn(left)), toRight(portIn(right));
  ASSERT_TRUE(toLeft.waitForListener() && toRight.waitForListener());
  for (const std::string& packet : drive(6)) {
    toLeft.send(packet);
    toRight.send(packet);
    toRight.send(std::string(packet).replace(4, 2, "\x20\x10"));
  }
  sensors.reset();
  std::map<std::string, std::size_t> packets;
  for (const auto& scan : scans()) packets[scan->sensorLabel] += scan->scan_packets.size();
  EXPECT_EQ(packets,
            (std::map<std::string, std::size_t>{{"left_SCAN", 4 * 75}, {"right_SCAN", 4 * 150}}));
}

TEST_F(VelodyneReceiverTest, IgnoresAndCountsWhatIsNotOfTheLidar) {
  Packets packets = drive(4);
  packets.insert(packets.begin() + 100, {"", "x", packets[0] + "x", std::string(3000, 'x')});
  receive(velodyne("device_ip = 127.0.0.1\n"), packets, {"x"});
  EXPECT_EQ(ignored, 5u);
  EXPECT_EQ(lost, 0u);
  ASSERT_EQ(observed(), 2u);
  EXPECT_EQ(scans()[0]->scan_packets.size(), 75u);
  const auto told = [this] {
    return std::count_if(warnings.begin(), warnings.end(), [](const std::string& warning) {
      return warning.find("[lidar]: CVelodyneScanner: a packet is not of this LiDAR") !=
             std::string::npos;
    });
  };
  EXPECT_EQ(told(), 1);
  receive(velodyne("device_ip = 127.0.0.2\n"), drive(1));
  EXPECT_EQ(ignored, 5u + 75u);
  EXPECT_EQ(told(), 2);
  EXPECT_EQ(observed(), 2u);
}

TEST_F(VelodyneReceiverTest, OfTwoLidarsOnOnePortOneIsUsed) {
  const std::string ini = velodyne("pcap_read_fast = true\nprocess_rate = 1e6\n");
  const Packets packets = drive(4, 1000);
  Packets both;
  for (std::size_t i = 0; i < packets.size(); ++i)
    both.insert(both.end(), {packets[i], packets[(i + 30) % packets.size()]});
  writeText(folder / "a.pcap", pcapFile(both, portIn(ini), {1, 2}));
  const std::string pcap = "pcap_input = " + (folder / "a.pcap").string();
  const auto played = start(ini + pcap), other = start(ini + "device_ip = 0.0.0.2\n" + pcap);
  ASSERT_TRUE(waitFor([&] { return ended() == 2; }));
  EXPECT_EQ(ignored, 2 * packets.size());
  EXPECT_EQ(lost, 0u);
  ASSERT_EQ(observed(), 2u + 3u);
  EXPECT_EQ(scans()[0]->scan_packets.size(), 75u);
}

/// Over the end of an hour; two packets, then one in another turn. A step of the clock and a
/// long pause are no losses.
TEST_F(VelodyneReceiverTest, CountsLostPackets) {
  constexpr std::uint32_t hour = 3600000000;
  Packets packets = drive(6, hour - 150000);
  for (std::size_t i = 0; i < packets.size(); ++i) {
    std::uint32_t clock;
    std::memcpy(&clock, &packets[i][1200], sizeof clock);
    clock %= hour;
    if (i >= 300) clock += 600000;
    if (i >= 380) clock -= 590000;
    std::memcpy(&packets[i][1200], &clock, sizeof clock);
  }
  packets.erase(packets.begin() + 200);
  packets.erase(packets.begin() + 113, packets.begin() + 115);
  receive(velodyne(""), packets);
  EXPECT_EQ(observed(), 4u);
  EXPECT_EQ(lost, 3u);
  EXPECT_EQ(ignored, 0u);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_HAS(warnings[1],
             "[lidar]: CVelodyneScanner: packets are missing, the first before packet");
}

/// Memory must not grow for ever.
TEST_F(VelodyneReceiverTest, ATurnThatDoesNotEndIsCut) {
  receive(velodyne(""), Packets(6001, drive(1)[1]));
  ASSERT_EQ(observed(), 1u);
  EXPECT_EQ(scans()[0]->scan_packets.size(), 3000u);
}

TEST_F(VelodyneReceiverTest, WarnsThatItListensToThisComputerOnly) {
  start(velodyne(""));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_HAS(warnings[0], "set address = 0.0.0.0");
  start(velodyne("address = 0.0.0.0\n"));
  EXPECT_EQ(warnings.size(), 1u);
}

TEST_F(VelodyneReceiverTest, HearsPacketsToOtherAddressesOnlyIfAsked) {
  const std::string here = "127.0.0.1", elsewhere = "127.0.0.2";
  const Packets packets = drive(3, 1000), positions{positionPacket('A')};
  receive(velodyne(""), packets, positions, elsewhere, elsewhere);
  EXPECT_EQ(observed(), 0u);
  receive(velodyne(""), packets, positions, here, elsewhere);
  ASSERT_EQ(observed(), 1u);
  EXPECT_FALSE(scans()[0]->has_satellite_timestamp);
  receive(velodyne("address = 0.0.0.0\n"), packets, positions, elsewhere, elsewhere);
  ASSERT_EQ(observed(), 2u);
  EXPECT_TRUE(scans()[1]->has_satellite_timestamp);
  EXPECT_EQ(ignored, 0u);
}

TEST_F(VelodyneReceiverTest, RefusesWhatCannotBe) {
  const std::string lidar = velodyne("");
  std::string second = lidar;
  second.replace(0, 7, "[other]");
  expectError(lidar + second,
              {"[other]: CVelodyneScanner: data_port = ", " at 127.0.0.1: ", "in use"});
  const std::string begin = "[lidar]\ndriver = CVelodyneScanner\nmodel = VLP16\n";
  expectError(begin + "data_port = 70000\n", {"data_port = 70000: allowed is 1 to 65535"});
  expectError(velodyne("position_port = 0\n"), {"position_port = 0: allowed"});
  expectError(velodyne("address = 192.0.2.1\n"), {"data_port = ", "at 192.0.2.1", "address"});
  expectError(velodyne("address = roof\n"), {"address = roof: is no IPv4 address"});
  expectError(velodyne("device_ip = roof\n"), {"device_ip = roof: is no IPv4 address"});
  testing::internal::CaptureStderr();  // MRPT complains as well
  expectError(velodyne("calibration_file = none.xml\n"), {"none.xml: cannot be read"});
  testing::internal::GetCapturedStderr();
  expectError(velodyne("return_type = DUAL\n"), {"device IP address must be specified"});
  expectError(velodyne("pcap_output = drive\n"), {"pcap_output: ", "tcpdump -w"});
}

}  // namespace
}  // namespace polemcl::test_velodyne_receiver
