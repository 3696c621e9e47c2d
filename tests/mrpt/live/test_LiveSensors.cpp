// INI files of sensors, right and wrong; MRPT's drivers are those of the installed library.

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <polemcl/core/common/Types.h>
#include "support/LiveSensorsTest.h"

namespace polemcl::test_live_sensors {

using namespace testing_apps;
using mrpt::obs::CObservationVelodyneScan;

TEST_F(LiveSensorsTest, NeedsASensorWithADriver) {
  EXPECT_THROW(startSensors((folder / "none.ini").string(), {}), Error);
  expectError("", {"sensors.ini: names no sensor", "driver = CVelodyneScanner"});
  expectError("[global]\nrawlog_prefix = x\n", {"names no sensor"});
  expectError("[a]\ndriver = $env{HOME}\n", {"sensors.ini:2: $e", "is allowed; write the value"});
  expectError("[lidar]\ndriver = CVelodyneScanner\nrawlog-grabber-ignore = true\n",
              {"names no sensor"});
  expectError("[lidar]\nmodel = VLP16\n", {"sensors.ini: [lidar]: no driver", "CVelodyneScanner"});
  expectError("[lidar]\ndriver = CVelodine\n",
              {"sensors.ini: [lidar]: driver = CVelodine", "mrpt::hwdrivers", "CUdpOdometry"});
}

TEST_F(LiveSensorsTest, NamesWrongValues) {
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
  expectError(velodyne("pcap_input = none.pcap\n"), {"[lidar]: CVelodyneScanner", "none.pcap"});
}

TEST_F(LiveSensorsTest, RefusesPcapFilesOfOtherDevices) {
  const auto expectRefused = [&](const std::string& bytes, const std::string& why) {
    writeText(folder / "a.pcap", bytes);
    expectError(velodyne("pcap_input = " + (folder / "a.pcap").string() + "\n"), {"a.pcap", why});
  };
  const std::string little("\xd4\xc3\xb2\xa1\2\0\4\0\0\0\0\0\0\0\0\0\0\0\1\0", 20);
  const std::string big("\xa1\xb2\xc3\xd4\0\2\0\4\0\0\0\0\0\0\0\0\0\1\0\0", 20);
  expectRefused(little + std::string("\x69\0\0\0", 4), "link type 105");
  expectRefused(big + std::string("\0\0\0\x69", 4), "link type 105");
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

TEST_F(LiveSensorsTest, OdometryToOtherAddressesIsHeardOnlyIfAsked) {
  for (const std::string address : {"", "address = 0.0.0.0\n"}) {
    observations.clear();
    const int port = freeUdpPort();
    const auto sensors =
        start("[odo]\ndriver = CUdpOdometry\nudp_port = " + std::to_string(port) + "\n" + address);
    const UdpSender here(port), elsewhere(port, "127.0.0.2");
    ASSERT_TRUE(here.waitForListener());
    elsewhere.send("1 0 0");
    here.send("2 0 0");
    const std::size_t heard = address.empty() ? 1 : 2;
    ASSERT_TRUE(waitFor([&] { return observed() >= heard; }));
    const std::lock_guard lock(mutex);
    ASSERT_EQ(observations.size(), heard);
    const auto last =
        std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(observations.back());
    EXPECT_EQ(last->odometry.x(), 2);
  }
}

/// The driver looks for packets twice a second only.
TEST_F(LiveSensorsTest, PacketsHaveTheTimesOfTheirArrival) {
  const int port = freeUdpPort();
  const auto sensors = start(
      "[odo]\ndriver = CUdpOdometry\nprocess_rate = 2\nudp_port = " + std::to_string(port) + "\n");
  const UdpSender sender(port);
  ASSERT_TRUE(sender.waitForListener());
  sender.send("1 0 0");
  ASSERT_TRUE(waitFor([&] { return observed() == 1; }));
  const double sent = mrpt::Clock::nowDouble();
  sender.send("2 0 0");  // returns when it has been read
  const double read = mrpt::Clock::nowDouble();
  ASSERT_TRUE(waitFor([&] { return observed() == 2; }));
  const std::lock_guard lock(mutex);
  EXPECT_LT(mrpt::Clock::toDouble(observations[1]->timestamp) - sent, 0.5 * (read - sent));
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
       {"nan 1,2 hello", "", "1 2", "1 2 3 m", "1 2 3 4", "1 2 3 4 5", "1 2 nan", "1e999 2 3"})
    sender.send(packet);
  sender.send("4 5 0.5");
  ASSERT_TRUE(waitFor([&] { return observed() + ended() >= 1; }));
  const std::lock_guard lock(mutex);
  EXPECT_TRUE(ends.empty()) << ends[0];
  ASSERT_EQ(observations.size(), 1u);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_HAS(warnings[0], "sensors.ini: [odo]: CUdpOdometry: a packet holds 'nan 1,2 hello'");
}

TEST_F(LiveSensorsTest, APcapFileWithoutPacketsIsAFailure) {
  const char header[24] = {'\xd4', '\xc3', '\xb2', '\xa1', 2,      0,      4, 0, 0, 0, 0, 0,
                           0,      0,      0,      0,      '\xff', '\xff', 0, 0, 1, 0, 0, 0};
  writeText(folder / "empty.pcap", std::string(header, sizeof header));
  const auto sensors = start(
      velodyne("pcap_read_once = false\npcap_input = " + (folder / "empty.pcap").string() + "\n"));
  EXPECT_TRUE(waitFor([&] { return ended() == 1; }));
  EXPECT_HAS(ends.at(0), "[lidar]: CVelodyneScanner: ");
  EXPECT_HAS(ends.at(0), "empty.pcap: has no UDP packet for data_port = ");
}

}  // namespace polemcl::test_live_sensors
