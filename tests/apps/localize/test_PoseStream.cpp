// `pole-localize --stream` and `--follow`: poses as they are made, also from a rawlog that
// still grows.

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

#include "support/LocalizeTest.h"
#include "support/Shell.h"

namespace polemcl::test_pose_stream {
namespace {

using namespace testing_apps;

class PoseStream : public LocalizeTest {
 protected:
  std::vector<nlohmann::json> lines(const std::string& text) const {
    std::istringstream in(text);
    std::vector<nlohmann::json> all;
    for (std::string line; std::getline(in, line);) all.push_back(nlohmann::json::parse(line));
    return all;
  }
  std::size_t linesWritten() const {
    std::ifstream in(folder / "poses.jsonl");
    std::size_t count = 0;
    for (std::string line; std::getline(in, line);) ++count;
    return count;
  }
};

TEST_F(PoseStream, TellsWhatTheFilesTell) {
  ASSERT_EQ(runWithTruth({"--stream", (folder / "poses.jsonl").string()}).code, 0);
  const auto all = lines(readText(folder / "poses.jsonl"));
  ASSERT_EQ(all.size(), scans);
  const auto poses = io::readPlanarTum(out("run_00.tum"));
  for (std::size_t i = 0; i < scans; ++i) {
    EXPECT_EQ(all[i]["scan"], i);
    EXPECT_NEAR(all[i]["time"], poses[i].time, 1e-6);
    EXPECT_NEAR(all[i]["x_m"], poses[i].pose.x, 1e-6);
    EXPECT_NEAR(all[i]["y_m"], poses[i].pose.y, 1e-6);
    EXPECT_NEAR(all[i]["yaw_rad"], poses[i].pose.yaw, 1e-6);
    EXPECT_EQ(all[i]["covariance"].size(), 6u);
    EXPECT_GT(all[i]["covariance"][0], 0);
  }
  EXPECT_EQ(all.back()["state"], "ok");
  EXPECT_EQ(all.back()["reason"], "none");
}

TEST_F(PoseStream, LeavesNothingElseOnStandardOutput) {
  const Outcome outcome = succeeded(run({"--global", "--stream", "-"}));
  const auto all = lines(outcome.out);
  ASSERT_EQ(all.size(), scans);
  EXPECT_TRUE(all[0]["x_m"].is_null()) << "the pose is not known yet";
  EXPECT_TRUE(all[0]["covariance"].is_null());
  EXPECT_NE(outcome.err.find("latency"), std::string::npos);
}

TEST_F(PoseStream, LeavesTheInputsAlone) {
  const std::string map = readText(folder / "map.polemap");
  expectFailure(runWithTruth({"--stream", (folder / "map.polemap").string()}),
                {"--stream", "map.polemap: is an input"});
  EXPECT_EQ(readText(folder / "map.polemap"), map);
}

/// By a link as well: what lies in the folder of the results may be replaced.
TEST_F(PoseStream, LeavesLinkedInputsAlone) {
  fs::create_directories(folder / "out");
  fs::copy(folder / "truth.tum", folder / "out/run_05.tum");
  fs::create_symlink("out/run_05.tum", folder / "link.tum");
  expectFailure(run({"--truth", (folder / "link.tum").string()}), {"link.tum: is an input"});
  EXPECT_TRUE(fs::exists(folder / "out/run_05.tum"));
}

TEST_F(PoseStream, ClosedStandardStreamsDoNotEndInIt) {
  std::string command = std::string(POLEMCL_BIN_DIR) + "/pole-localize";
  for (const auto& argument :
       arguments({"--global", "--stream", (folder / "poses.jsonl").string()}))
    command += " " + argument;
  EXPECT_EQ(shell(command + " <&- >&- 2>&-").code, 0);
  EXPECT_EQ(lines(readText(folder / "poses.jsonl")).size(), scans);
}

TEST_F(PoseStream, NamesAFileThatCannotBe) {
  expectFailure(runWithTruth({"--stream", (folder / "none" / "poses.jsonl").string()}),
                {"poses.jsonl", "cannot be created"});
}

TEST_F(PoseStream, CompletesTheResultsWhereItCannotBeWritten) {
  ASSERT_EQ(runWithTruth().code, 0);
  const std::string all = bytes();
  const auto outcome = runWithTruth({"--quiet", "--stream", "/dev/full"});
  expectFailure(outcome, {"/dev/full: cannot be written by --stream; the results are in"});
  EXPECT_EQ(bytes(), all);
}

/// The first half is there; its poses come before the second half is written.
TEST_F(PoseStream, FollowsARawlogThatGrows) {
  const std::string bytes = readText(folder / "in.rawlog");
  writeText(folder / "in.rawlog", bytes.substr(0, bytes.size() / 2));
  std::size_t early = 0;
  std::thread writer([&] {
    for (int i = 0; i < 500 && early < scans / 3; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      early = linesWritten();
    }
    std::ofstream(folder / "in.rawlog", std::ios::app | std::ios::binary)
        << bytes.substr(bytes.size() / 2);
  });
  const auto outcome =
      runWithTruth({"--follow", "3", "--stream", (folder / "poses.jsonl").string()});
  writer.join();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_GE(early, scans / 3);
  EXPECT_LT(early, scans);
  EXPECT_EQ(linesWritten(), scans);
  const std::string grown = readText(out("run_00_cov.csv"));
  ASSERT_EQ(runWithTruth().code, 0);
  EXPECT_EQ(readText(out("run_00_cov.csv")), grown);
}

TEST_F(PoseStream, SaysWhereARawlogStoppedToGrow) {
  const std::string bytes = readText(folder / "in.rawlog");
  writeText(folder / "in.rawlog", bytes.substr(0, bytes.size() / 2));
  expectFailure(runWithTruth({"--follow", "0.05"}), {"in.rawlog", "ends inside an object"});
}

}  // namespace
}  // namespace polemcl::test_pose_stream
