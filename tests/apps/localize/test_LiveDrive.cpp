// `pole-localize --sensors`: packets of a VLP-16 over the network or from a PCAP file, with
// the shipped example of an INI file.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include <polemcl/mrpt/map/CPoleMap.h>
#include "io/data/Trajectory.h"
#include "localize/LiveDrive.h"
#include "localize/LocalizeApp.h"
#include "support/UdpSender.h"
#include "support/VelodynePackets.h"

namespace polemcl::test_live_drive {
namespace {

using namespace testing_apps;
using namespace polemcl::apps;

constexpr double step = 0.5;  // m from turn to turn

class LiveDriveTest : public testing::Test {
 protected:
  LiveDriveTest() {
    std::vector<MapPole> mapped;
    for (const StreetPole& pole : poles) {
      MapPole entry;
      entry.x = pole.x, entry.y = pole.y;
      entry.radius = streetPoleRadius, entry.top = streetPoleTop, entry.count = 5;
      mapped.push_back(entry);
    }
    CPoleMap map;
    map.setPoles(mapped);
    map.saveToPoleMapFile((folder / "map.polemap").string());
    writeSensors("");
    std::signal(SIGINT, SIG_IGN);  // a signal after the drive must not end the tests
  }
  ~LiveDriveTest() override { std::signal(SIGINT, SIG_DFL); }

  /// The shipped example with free ports. \param more Keys of the LiDAR. \param other Sections.
  void writeSensors(const std::string& more, const std::string& other = "") {
    std::string ini = readText(fs::path(POLEMCL_SOURCE_DIR) / "config/live/vlp16.ini");
    const auto set = [&](const std::string& key, const std::string& value) {
      const auto at = ini.find("\n" + key + " = ");
      ASSERT_NE(at, std::string::npos) << key;
      ini.replace(at, ini.find('\n', at + 1) - at, "\n" + key + " = " + value);
    };
    set("data_port", std::to_string(lidarPort));
    set("position_port", std::to_string(freeUdpPort()) + "\n" + more);
    set("udp_port", std::to_string(odometryPort));
    ini.insert(0, other + "\n");
    writeText(folder / "sensors.ini", ini);
  }

  Outcome run(const std::vector<std::string>& more = {}) {
    std::vector<std::string> all{"--config",  std::string(POLEMCL_SOURCE_DIR) + "/config/vlp16.ini",
                                 "--sensors", (folder / "sensors.ini").string(),
                                 "--map",     (folder / "map.polemap").string(),
                                 "--output",  (folder / "out").string(),
                                 "--start",   start,
                                 "--stream",  (folder / streamed).string(),
                                 "--set",     "health.max_gap_s=60"};  // slow machines
    all.insert(all.end(), more.begin(), more.end());
    const Outcome outcome = runProgram(localizeMain, all);
    ended = true;
    return outcome;
  }

  std::vector<nlohmann::json> lines() const {
    std::ifstream in(folder / "poses.jsonl");
    std::vector<nlohmann::json> all;
    for (std::string line; std::getline(in, line) && !in.eof();)
      all.push_back(nlohmann::json::parse(line));
    return all;
  }
  bool waitForLines(std::size_t count) const {
    return waitFor([&] { return ended || lines().size() >= count; }) && !ended;
  }
  nlohmann::json result(const std::string& name) const {
    return nlohmann::json::parse(readText(folder / "out" / name));
  }

  /// Sends turns of a drive along x, each between two packets of odometry with the same pose. A
  /// turn is known to be complete when the next one begins; the first one is left out.
  /// \param taken Called before each turn with the number of scans that are complete by then.
  /// \param clock The packets state their times.
  void drive(int turns, const std::function<void(std::size_t)>& beforeTurn, bool clock = false) {
    const UdpSender lidar(lidarPort), odometry(odometryPort);
    if (!lidar.waitForListener() || !odometry.waitForListener()) return;
    for (int turn = 0; turn < turns && !ended; ++turn) {
      const double x = step * turn;
      beforeTurn(static_cast<std::size_t>(std::max(0, turn - 2)));
      const auto tellOdometry = [&] {
        odometry.send(std::to_string(x) + " 0 0");
        std::this_thread::sleep_for(std::chrono::milliseconds(5));  // the sensors' clock goes on
      };
      tellOdometry();
      std::uint32_t microseconds = 100000 * static_cast<std::uint32_t>(turn);
      for (std::string packet : turnOfVlp16(poles, x, 0, 0)) {
        if (clock) std::memcpy(&packet[packet.size() - 6], &(microseconds += 1333), 4);
        lidar.send(packet);
      }
      tellOdometry();
    }
  }

  /// Each turn waits for the pose of the one before the last, so none is dropped on a slow machine;
  /// Ctrl-C after the last pose.
  void driveAndInterrupt(int turns, bool clock = false) {
    drive(
        turns, [this](std::size_t complete) { waitForLines(complete); }, clock);
    waitForLines(static_cast<std::size_t>(turns - 2));
    interrupt();
  }
  /// The program, while another thread sends.
  Outcome runDuring(const std::function<void()>& sending,
                    const std::vector<std::string>& more = {}) {
    std::thread sender(sending);
    const Outcome outcome = run(more);
    sender.join();
    return outcome;
  }

  static std::size_t countOf(const std::string& words, const std::string& text) {
    std::size_t count = 0;
    for (auto at = text.find(words); at != std::string::npos; at = text.find(words, at + 1))
      ++count;
    return count;
  }
  /// To this thread: under the thread sanitizer, one that waits for another gets no signal.
  static void interrupt() { std::raise(SIGINT); }

  const std::vector<StreetPole> poles = streetPoles();
  const int lidarPort = freeUdpPort(), odometryPort = freeUdpPort();
  const TempFolder folder;
  std::string streamed = "poses.jsonl", start = "0,0,0,0.3,3";
  std::atomic<bool> ended{false};
};

TEST_F(LiveDriveTest, PacketsBecomePosesUntilCtrlC) {
  const Outcome outcome = succeeded(runDuring([this] { driveAndInterrupt(22); }));
  const auto all = lines();
  ASSERT_EQ(all.size(), 20u);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i]["scan"], i);
    EXPECT_EQ(all[i]["dropped"], 0);
    EXPECT_GE(all[i]["poles"], 3);
    ASSERT_FALSE(all[i]["x_m"].is_null());
    EXPECT_NEAR(all[i]["x_m"], step * static_cast<double>(i + 1), 0.3) << i;
    EXPECT_NEAR(all[i]["y_m"], 0, 0.2) << i;
    if (i > 0) {
      EXPECT_GT(all[i]["time"], all[i - 1]["time"]);
    }
  }
  EXPECT_EQ(all.back()["state"], "ok");
  EXPECT_EQ(names(folder / "out"),
            (std::vector<std::string>{"config.ini", "run_00.tum", "run_00_cov.csv",
                                      "run_00_health.csv", "summary.json", "timings.json"}));
  EXPECT_EQ(io::readPlanarTum(folder / "out/run_00.tum").size(), 20u);
  for (const char* key : {"dropped_scans", "lost_packets", "ignored_packets"})
    EXPECT_EQ(result("summary.json")[key], 0) << key;
  EXPECT_EQ(result("summary.json")["input"], (folder / "sensors.ini").string());
  const auto latency = result("timings.json")["latency_ms"]["total"];
  EXPECT_EQ(latency["count"], 20);
  EXPECT_GT(latency["median"], 0);
  EXPECT_LE(latency["median"], latency["p99"]);
  EXPECT_LE(latency["p99"], latency["worst"].get<double>() * 1.01);
  EXPECT_HAS(outcome.out, "0 scans dropped, 0 left out without odometry, 0 packets lost\n");
}

TEST_F(LiveDriveTest, TheRecordGivesTheSamePoses) {
  const std::string record = (folder / "record.rawlog").string();
  succeeded(runDuring([this] { driveAndInterrupt(12); }, {"--record", record}));
  const Outcome played = succeeded(runProgram(
      localizeMain,
      {"--config", std::string(POLEMCL_SOURCE_DIR) + "/config/vlp16.ini", "--input", record,
       "--map", (folder / "map.polemap").string(), "--output", (folder / "again").string(),
       "--start", "0,0,0,0.3,3", "--set", "health.max_gap_s=60"}));
  EXPECT_EQ(io::readPlanarTum(folder / "out/run_00.tum").size(), 10u);
  for (const char* name : {"run_00.tum", "run_00_cov.csv", "run_00_health.csv"})
    EXPECT_EQ(readText(folder / "again" / name), readText(folder / "out" / name)) << name;
}

TEST_F(LiveDriveTest, ARecordThatCannotBeWrittenIsSaid) {
  const Outcome outcome = run({"--record", (folder / "nowhere/record.rawlog").string()});
  expectFailure(outcome, {"nowhere"});
}

/// A standing vehicle; the odometry comes over the network as before.
TEST_F(LiveDriveTest, APcapFilePlaysAsIfLiveAndEnds) {
  constexpr std::size_t turns = 12;
  std::vector<std::string> packets;
  for (std::size_t turn = 0; turn < turns; ++turn)
    for (const std::string& packet : turnOfVlp16(poles, 0, 0, 0)) packets.push_back(packet);
  writeText(folder / "drive.pcap", pcapFile(packets, lidarPort));
  writeSensors("process_rate = 754\npcap_read_fast = true\npcap_input = " +
               (folder / "drive.pcap").string());
  const Outcome outcome = succeeded(runDuring([this] {
    const UdpSender odometry(odometryPort);
    while (!ended) odometry.send("0 0 0");
  }));
  EXPECT_EQ(outcome.err, "");
  const auto summary = result("summary.json");
  const auto all = lines();
  // The first turn is cut, the end of the last one is not seen.
  EXPECT_EQ(all.size() + summary["dropped_scans"].get<std::size_t>() +
                summary["scans_without_odometry"].get<std::size_t>(),
            turns - 2);
  ASSERT_FALSE(all.empty());
  EXPECT_NEAR(all.back()["x_m"], 0, 0.2);
  EXPECT_NEAR(all.back()["y_m"], 0, 0.2);
}

/// A second LiDAR, which plays a file, gives its first scan after 3 s: nobody listed the two.
TEST_F(LiveDriveTest, ASensorThatFailsEndsTheDriveWithItsResults) {
  std::vector<std::string> packets;
  for (int turn = 0; turn < 3; ++turn)
    for (const std::string& packet : turnOfVlp16(poles, 0, 0, 0)) packets.push_back(packet);
  writeText(folder / "drive.pcap", pcapFile(packets, lidarPort));
  writeSensors("",
               "[another]\ndriver = CVelodyneScanner\nmodel = VLP16\nsensorLabel = another\n"
               "process_rate = 50\npcap_read_fast = true\ndata_port = " +
                   std::to_string(lidarPort) +
                   "\npcap_input = " + (folder / "drive.pcap").string() + "\n");
  const Outcome outcome =
      runDuring([this] { drive(6, [this](std::size_t complete) { waitForLines(complete); }); });
  expectFailure(outcome, {"scans of two sensors", "the results up to then are in", "out"});
  EXPECT_GE(io::readPlanarTum(folder / "out/run_00.tum").size(), 4u);
}

/// Before the first scan, between scans, and without odometry. A turn is reported when the next one
/// begins, so the first line after a gap is that of the turn before it.
TEST_F(LiveDriveTest, SaysThatNoScanComes) {
  const auto gaps = [this] {
    const auto all = lines();
    return std::count_if(all.begin(), all.end(), [](const auto& l) { return l["scan"].is_null(); });
  };
  std::thread sender([&] {
    waitForLines(2);
    drive(30, [&](std::size_t complete) {
      waitFor([&] { return ended || lines().size() - gaps() >= complete; });
      if (complete != 24) return;
      const auto before = gaps();
      waitFor([&] { return ended || gaps() >= before + 2; });
    });
    interrupt();
  });
  const Outcome outcome = run({"--set", "health.max_gap_s=0.5"});
  sender.join();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto all = lines();
  ASSERT_GE(all.size(), 30u);
  EXPECT_TRUE(all[0]["scan"].is_null() && all[1]["scan"].is_null());
  EXPECT_EQ(all[0]["state"], "lost");
  const auto at24 =
      std::find_if(all.begin(), all.end(), [](const auto& l) { return l["scan"] == 23; });
  ASSERT_LT(at24 + 3, all.end());
  ASSERT_EQ(at24->at("state"), "ok");
  const auto& gap = *(at24 + 1);
  for (const auto& [key, value] : at24->items()) EXPECT_TRUE(gap.contains(key)) << key;
  EXPECT_EQ(gap.size(), at24->size());
  for (const char* key : {"scan", "time", "x_m", "y_m", "yaw_rad", "covariance", "poles"})
    EXPECT_TRUE(gap[key].is_null()) << key;
  EXPECT_EQ(gap["state"], "degraded");
  EXPECT_EQ(gap["reason"], "time_gap");
  EXPECT_EQ(*(at24 + 2), gap);
  EXPECT_EQ(all.back()["reason"], "time_gap") << "of scans after the gap, too";
  EXPECT_NE(outcome.err.find("sensors.ini: no scan and no odometry for 0.5 s"), std::string::npos);
  std::size_t silences = 0;
  for (std::size_t i = 0; i < all.size(); ++i)
    silences += all[i]["scan"].is_null() && (i == 0 || !all[i - 1]["scan"].is_null());
  EXPECT_GE(silences, 2u);
  EXPECT_EQ(countOf("sensors.ini: no ", outcome.err), silences) << outcome.err;
  EXPECT_EQ(io::readPlanarTum(folder / "out/run_00.tum").size() + gaps(), all.size());
}

TEST_F(LiveDriveTest, WarnsAndGoesOn) {
  std::thread sender([this] {
    drive(
        8,
        [this](std::size_t complete) {
          waitForLines(complete);
          UdpSender(odometryPort).send("nan 1,2 \x01 hello");
          UdpSender(lidarPort).send("hello");
        },
        true);
    waitForLines(6);
    interrupt();
  });
  const Outcome outcome = run({"--quiet", "--set", "sensor.turn=counterclockwise"});
  sender.join();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(lines().size(), 6u);
  EXPECT_EQ(countOf("[odometry]: CUdpOdometry: a packet holds 'nan 1,2 ? hello'", outcome.err), 1u);
  EXPECT_EQ(countOf("warning: [sensor] turn = counterclockwise", outcome.err), 1u);
  EXPECT_EQ(countOf("[lidar]: CVelodyneScanner: a packet is not of this LiDAR", outcome.err), 1u);
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 3) << outcome.err;
  EXPECT_EQ(result("summary.json")["ignored_packets"], 8);
}

/// What `turn` says does not matter where the LiDAR states nothing, and auto is always right.
TEST_F(LiveDriveTest, DoesNotWarnOfTurnsThatFit) {
  struct Case {
    bool clock;
    std::vector<std::string> set;
  };
  for (const Case& one :
       {Case{false, {"sensor.turn=counterclockwise"}}, Case{true, {"sensor.turn=auto"}},
        Case{true, {"sensor.turn=clockwise", "sensor.cut_deg=0", "sensor.stamp_turn=0"}}}) {
    ended = false;
    fs::remove(folder / "poses.jsonl");
    std::vector<std::string> more{"--quiet"};
    for (const auto& set : one.set) more.insert(more.end(), {"--set", set});
    const Outcome outcome = succeeded(runDuring([&] { driveAndInterrupt(5, one.clock); }, more));
    EXPECT_EQ(outcome.err, "");
  }
}

TEST_F(LiveDriveTest, ALostReaderOfTheStreamEndsTheDriveWithItsResults) {
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  std::thread sender([this] {
    std::atomic<std::size_t> read{0};
    std::thread reader([&] {
      std::ifstream in(folder / "pipe");
      for (std::string line; read < 4 && std::getline(in, line);) ++read;
      in.close();
      read = 100;
    });
    drive(40, [&](std::size_t complete) {
      waitFor([&] { return ended || read >= std::min<std::size_t>(complete, 100); });
    });
    reader.join();
  });
  streamed = "pipe";
  const Outcome outcome = run();
  sender.join();
  expectFailure(outcome, {"pipe: cannot be written by --stream; the results up to then are in"});
  EXPECT_GE(io::readPlanarTum(folder / "out/run_00.tum").size(), 5u);
}

TEST_F(LiveDriveTest, AReaderThatStallsDoesNotKeepTheDriveFromItsEnd) {
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  const int reader = open((folder / "pipe").c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  ASSERT_GE(fcntl(reader, F_SETPIPE_SZ, 4096), 4096);  // for the first line, no more
  std::thread sender([this] {
    drive(30, [](std::size_t) { std::this_thread::sleep_for(std::chrono::milliseconds(30)); });
    interrupt();
  });
  streamed = "pipe";
  const Outcome outcome = run();
  sender.join();
  close(reader);
  expectFailure(outcome, {"pipe: was not read any more", "the results up to then are in"});
  EXPECT_GE(io::readPlanarTum(folder / "out/run_00.tum").size(), 2u);
}

TEST_F(LiveDriveTest, AStreamThatNobodyReadsDoesNotHoldTheProgram) {
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  streamed = "pipe";
  expectFailure(run({"--for", "0.3"}), {"pipe: nobody reads it"});
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST_F(LiveDriveTest, ADriveWithoutPolesKeepsItsResults) {
  const Outcome outcome =
      runDuring([this] { driveAndInterrupt(6); }, {"--set", "scan_line.min_confidence=1"});
  expectFailure(outcome, {"no pole in any of", "the results up to then are in"});
  EXPECT_TRUE(fs::exists(folder / "out/summary.json"));
}

TEST_F(LiveDriveTest, AFirstScanThatCannotBeUsedIsSaid) {
  start = "100000,0,0,2,5";
  const Outcome outcome = runDuring([this] { drive(6, [](std::size_t) {}); });
  expectFailure(outcome, {"the start at 100000 0 m lies"});
  EXPECT_FALSE(fs::exists(folder / "out/summary.json"));
}

TEST(EndSignals, ASecondSignalOfEitherKindEndsTheProgram) {
  const EndSignals signals;
  EXPECT_FALSE(EndSignals::came());
  EXPECT_EXIT(
      {
        std::raise(SIGINT);
        if (EndSignals::came()) std::raise(SIGTERM);
      },
      testing::KilledBySignal(SIGTERM), "");
}

TEST_F(LiveDriveTest, EndsAfterTheGivenTime) {
  expectFailure(run({"--for", "0.3"}), {"sensors.ini: no scan came"});
  EXPECT_FALSE(fs::exists(folder / "out/summary.json"));
}

TEST_F(LiveDriveTest, RefusesWhatIsForRawlogs) {
  for (const std::vector<std::string>& more : {std::vector<std::string>{"--input", "x.rawlog"},
                                               {"--rate", "1x"},
                                               {"--follow", "1"},
                                               {"--allow-truncated"}})
    expectUsageError(run(more));
  expectUsageError(runProgram(localizeMain, {"--config", "a", "--map", "b", "--output", "c"}));
  expectUsageError(runProgram(localizeMain, {"--config", "a", "--map", "b", "--output", "c",
                                             "--input", "d", "--for", "1"}));
}

TEST_F(LiveDriveTest, NamesAWrongFileOfSensors) {
  writeText(folder / "sensors.ini", "[lidar]\nmodel = VLP16\n");
  expectFailure(run(), {"sensors.ini: [lidar]: no driver"});
  EXPECT_FALSE(fs::exists(folder / "out"));
}

}  // namespace
}  // namespace polemcl::test_live_drive
