/// \file test_LiveSensors.cpp
/// \brief INI files of sensors, right and wrong; MRPT's drivers are those of the installed library.

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <algorithm>
#include <cstring>
#include <mutex>

#include <polemcl/core/common/Types.h>
#include "mrpt/live/LiveSensors.h"
#include "mrpt/rawlog/RawlogReader.h"
#include "support/Refusal.h"
#include "support/TempFolder.h"
#include "support/UdpSender.h"

namespace polemcl::test_live_sensors {

using namespace testing_apps;
using mrpt::obs::CObservationVelodyneScan;

namespace {

class LiveSensorsTest : public testing::Test {
 protected:
  std::unique_ptr<LiveSensors> start(const std::string& ini) {
    writeText(folder / "sensors.ini", ini);
    return startSensors((folder / "sensors.ini").string(),
                        {[this](const mrpt::obs::CObservation::Ptr& observation) {
                           const std::lock_guard lock(mutex);
                           observations.push_back(observation);
                         },
                         [this](const std::string& failure) {
                           const std::lock_guard lock(mutex);
                           ends.push_back(failure);
                         },
                         [this](const std::string& warning) {
                           const std::lock_guard lock(mutex);
                           warnings.push_back(warning);
                         }});
  }
  void expectError(const std::string& ini, const std::vector<std::string>& words) {
    EXPECT_TRUE(tests::says(tests::messageOf([&] { start(ini); }), words)) << ini;
  }
  std::size_t ended() {
    const std::lock_guard lock(mutex);
    return ends.size();
  }
  std::size_t observed() {
    const std::lock_guard lock(mutex);
    return observations.size();
  }
  /// A Velodyne at free ports.
  static std::string velodyne(const std::string& more) {
    return "[lidar]\ndriver = CVelodyneScanner\nmodel = VLP16\ndata_port = " +
           std::to_string(freeUdpPort()) + "\nposition_port = " + std::to_string(freeUdpPort()) +
           "\n" + more;
  }

  const TempFolder folder;
  std::mutex mutex;
  std::vector<mrpt::obs::CObservation::Ptr> observations;
  std::vector<std::string> ends, warnings;
};

}  // namespace

TEST_F(LiveSensorsTest, NeedsASensorWithADriver) {
  EXPECT_THROW(startSensors((folder / "none.ini").string(), {}), Error);
  expectError("", {"sensors.ini: names no sensor", "driver = CVelodyneScanner"});
  expectError("[global]\nrawlog_prefix = x\n", {"names no sensor"});
  expectError("[lidar]\ndriver = CVelodyneScanner\nrawlog-grabber-ignore = true\n",
              {"names no sensor"});
  expectError("[lidar]\nmodel = VLP16\n", {"sensors.ini: [lidar]: no driver", "CVelodyneScanner"});
  expectError("[lidar]\ndriver = CVelodine\n",
              {"sensors.ini: [lidar]: driver = CVelodine", "mrpt::hwdrivers", "CUdpOdometry"});
}

TEST_F(LiveSensorsTest, NamesWrongValues) {
  expectError("[lidar]\ndriver = CVelodyneScanner\nmodel = VLP16\ndata_port = 40000\n",
              {"[lidar]: CVelodyneScanner: data_port = 40000: allowed is 1 to 32767"});
  expectError(velodyne("process_rate = 0\n"), {"[lidar]", "process_rate = 0"});
  expectError("[lidar]\ndriver = CVelodyneScanner\nmodel = VLP17\n", {"[lidar]", "VLP17"});
  expectError("[odo]\ndriver = CUdpOdometry\n", {"[odo]: CUdpOdometry: udp_port"});
  expectError("[odo]\ndriver = CUdpOdometry\nudp_port = 70000\n", {"udp_port = 70000"});
  expectError("[odo]\ndriver = CUdpOdometry\nudp_port = 9870\naddress = here\n",
              {"address = here", "IPv4"});
}

TEST_F(LiveSensorsTest, NamesADeviceThatCannotBeOpened) {
  const std::string port = std::to_string(freeUdpPort());
  const std::string odometry = "driver = CUdpOdometry\nudp_port = " + port + "\n";
  expectError("[a]\n" + odometry + "[b]\n" + odometry, {"[b]: CUdpOdometry", port, "in use"});
  const std::string lidar = velodyne("");
  std::string second = lidar;
  second.replace(0, 7, "[other]");
  expectError(lidar + second, {"[other]: CVelodyneScanner", "in use (UDP ports "});
  expectError(velodyne("pcap_input = none.pcap\n"), {"[lidar]: CVelodyneScanner", "none.pcap"});
}

TEST_F(LiveSensorsTest, RefusesPacketsThatAreNotOfEthernet) {
  const auto expectRefused = [&](const std::string& bytes, const std::string& why) {
    writeText(folder / "a.pcap", bytes);
    expectError(velodyne("pcap_input = " + (folder / "a.pcap").string() + "\n"), {"a.pcap", why});
  };
  // MRPT 2.5.8 crashes at the first packet: it has no filter for them.
  const std::string little("\xd4\xc3\xb2\xa1\2\0\4\0\0\0\0\0\0\0\0\0\0\0\1\0", 20);
  const std::string big("\xa1\xb2\xc3\xd4\0\2\0\4\0\0\0\0\0\0\0\0\0\1\0\0", 20);
  expectRefused(little + std::string("\x71\0\0\0", 4), "link type 113");
  expectRefused(big + std::string("\0\0\0\x71", 4), "link type 113");
  expectRefused(little, "cannot read");
  expectRefused("no packets at all, but a text", "cannot read");
}

TEST_F(LiveSensorsTest, OdometryComesFromTheNetwork) {
  const int port = freeUdpPort();
  const auto sensors = start(
      "[odo]\ndriver = CUdpOdometry\nsensorLabel = wheels // a comment\n"
      "udp_port = " +
      std::to_string(port) + "\n");
  const UdpSender sender(port);
  ASSERT_TRUE(sender.waitForListener());
  const auto before = mrpt::Clock::now();
  sender.send("1.5 -2e-1 0.25\n");
  ASSERT_TRUE(waitFor([&] { return observed() == 1; }));
  const auto odometry = std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(observations[0]);
  ASSERT_TRUE(odometry);
  EXPECT_EQ(odometry->sensorLabel, "wheels");
  EXPECT_NEAR(odometry->odometry.x(), 1.5, 1e-12);
  EXPECT_NEAR(odometry->odometry.y(), -0.2, 1e-12);
  EXPECT_NEAR(odometry->odometry.phi(), 0.25, 1e-12);
  EXPECT_GE(odometry->timestamp, before);
  EXPECT_LE(odometry->timestamp, mrpt::Clock::now());
  EXPECT_EQ(ended(), 0u);
}

TEST_F(LiveSensorsTest, OdometryMayCarryItsTime) {
  const int port = freeUdpPort();
  const auto sensors =
      start("[odo]\ndriver = CUdpOdometry\nudp_port = " + std::to_string(port) + "\n");
  const UdpSender sender(port);
  ASSERT_TRUE(sender.waitForListener());
  const double now = mrpt::Clock::nowDouble();
  std::ostringstream late, wrong;
  late << std::fixed << "1 2 0.5 " << now - 0.75;
  wrong << std::fixed << "7 7 7 " << now - 3600;
  sender.send(wrong.str());
  sender.send(late.str());
  ASSERT_TRUE(waitFor([&] { return observed() >= 1; }));
  const std::lock_guard lock(mutex);
  EXPECT_NEAR(mrpt::Clock::toDouble(observations[0]->timestamp), now - 0.75, 1e-6);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_HAS(warnings[0], "a packet holds '7 7 7 ");
}

TEST_F(LiveSensorsTest, OdometryThatIsNotThreeNumbersIsIgnoredWithOneWarning) {
  const int port = freeUdpPort();
  const auto sensors =
      start("[odo]\ndriver = CUdpOdometry\nudp_port = " + std::to_string(port) + "\n");
  const UdpSender sender(port);
  ASSERT_TRUE(sender.waitForListener());
  for (const std::string packet :
       {"nan 1,2 hello", "", "1 2", "1 2 3 4", "1 2 3 4 5", "1 2 nan", "1e999 2 3"})
    sender.send(packet);
  sender.send("4 5 0.5");
  ASSERT_TRUE(waitFor([&] { return observed() + ended() >= 1; }));
  const std::lock_guard lock(mutex);
  EXPECT_TRUE(ends.empty()) << ends[0];
  ASSERT_EQ(observations.size(), 1u);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_HAS(warnings[0], "sensors.ini: [odo]: CUdpOdometry: a packet holds 'nan 1,2 hello'");
}

/// MRPT would read the file over and over.
TEST_F(LiveSensorsTest, APcapFileWithoutTurnsIsAFailure) {
  const char header[24] = {'\xd4', '\xc3', '\xb2', '\xa1', 2,      0,      4, 0, 0, 0, 0, 0,
                           0,      0,      0,      0,      '\xff', '\xff', 0, 0, 1, 0, 0, 0};
  writeText(folder / "empty.pcap", std::string(header, sizeof header));
  testing::internal::CaptureStderr();
  const auto sensors = start(
      velodyne("process_rate = 1e6\npcap_input = " + (folder / "empty.pcap").string() + "\n"));
  EXPECT_TRUE(waitFor([&] { return ended() == 1; }));
  testing::internal::GetCapturedStderr();  // MRPT's complaints
  EXPECT_HAS(ends.at(0), "[lidar]: CVelodyneScanner: no turn in the first 3000 packets");
}

/// The recorded turns of MRPT's sample, the first one twice, as that is left out; an end is seen
/// with the begin of the next one.
TEST_F(LiveSensorsTest, PacketsOfARealVlp16BecomeTheRecordedScans) {
  std::vector<CObservationVelodyneScan::Ptr> turns;
  RawlogReader reader("/usr/share/mrpt/datasets/test_velodyne_VLP16.rawlog");
  for (RawlogEntry entry; reader.next(entry);)
    if (auto scan = std::dynamic_pointer_cast<CObservationVelodyneScan>(entry.observation))
      turns.push_back(scan);
  ASSERT_FALSE(turns.empty());
  turns.insert(turns.begin(), turns.front());

  const std::string ini = velodyne("sensorLabel = roof\npose_z = 1.5\n");
  const int port = std::stoi(ini.substr(ini.find("data_port = ") + 12));
  auto sensors = start(ini);
  const UdpSender sender(port);
  ASSERT_TRUE(sender.waitForListener());
  const auto send = [&](const CObservationVelodyneScan::TVelodyneRawPacket& packet) {
    sender.send({reinterpret_cast<const char*>(&packet), sizeof packet});
  };
  for (const auto& turn : turns)
    std::for_each(turn->scan_packets.begin(), turn->scan_packets.end(), send);
  send(turns[0]->scan_packets[0]);
  ASSERT_TRUE(waitFor([&] { return observed() + 1 >= turns.size(); }));
  sensors.reset();
  ASSERT_EQ(observations.size() + 1, turns.size());
  for (std::size_t i = 1; i < turns.size(); ++i) {
    const auto scan = std::dynamic_pointer_cast<CObservationVelodyneScan>(observations[i - 1]);
    ASSERT_TRUE(scan);
    ASSERT_EQ(scan->scan_packets.size(), turns[i]->scan_packets.size());
    EXPECT_EQ(std::memcmp(scan->scan_packets.data(), turns[i]->scan_packets.data(),
                          scan->scan_packets.size() * sizeof scan->scan_packets[0]),
              0);
    EXPECT_EQ(scan->sensorLabel, "roof_SCAN");
    EXPECT_NEAR(scan->sensorPose.z(), 1.5, 1e-6);
  }
}

}  // namespace polemcl::test_live_sensors
