// pole-localize as a player: what it does scan by scan.
#include <tbb/global_control.h>

#include "support/LocalizeTest.h"

namespace polemcl::test_localize_player {
namespace {

using namespace testing_apps;

class LocalizePlayer : public LocalizeTest {
 protected:
  nlohmann::json timings() const { return nlohmann::json::parse(readText(out("timings.json"))); }
};

TEST_F(LocalizePlayer, TellsWhereTheStartCameFrom) {
  ASSERT_EQ(runWithTruth().code, 0);
  EXPECT_EQ(summary()["start_source"], "truth");
  EXPECT_EQ(summary()["start"]["x"], street.truth[0].x);
  ASSERT_EQ(runWithTruth({"--start", "3,-2,22.9,1.5,4"}).code, 0);
  EXPECT_EQ(summary()["start_source"], "command line");
  ASSERT_EQ(runWithTruth({"--global"}).code, 0);
  EXPECT_EQ(summary()["start_source"], "anywhere");
  ASSERT_EQ(runWithTruth({"--set", "start.anywhere=true"}).code, 0);
  EXPECT_EQ(summary()["start_source"], "anywhere");
  ASSERT_EQ(runWithTruth({"--set", "start.position_m=3 -2", "--set", "start.yaw_deg=22.9"}).code,
            0);
  EXPECT_EQ(summary()["start_source"], "configuration");
}

TEST_F(LocalizePlayer, RunsSideBySideHaveTheBytesOfRunsOneByOne) {
  ASSERT_EQ(runWithTruth({"--runs", "3", "--seed", "5"}).code, 0);
  const auto files = [&](const std::string& name) {
    std::string all;
    for (const char* end : {".tum", "_cov.csv", "_health.csv", "_errors.csv"})
      all += readText(out(name + end));
    return all;
  };
  const std::vector<std::string> together{files("run_00"), files("run_01"), files("run_02")};
  EXPECT_NE(together[0], together[1]);
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(runWithTruth({"--seed", std::to_string(5 + i)}).code, 0);
    EXPECT_EQ(files("run_00"), together[i]) << i;
  }
}

TEST_F(LocalizePlayer, TellsTheLatencyOfEachStage) {
  const Outcome outcome = succeeded(runWithTruth({"--runs", "2"}));
  const auto json = timings();
  EXPECT_EQ(json["rate"], "max");
  EXPECT_EQ(json["filter_s"].size(), 2u);
  EXPECT_FALSE(json["latency_ms"].contains("extract"));  // the rawlog holds poles
  for (const char* name : {"read", "step", "write", "total"}) {
    const auto stage = json["latency_ms"][name];
    EXPECT_EQ(stage["count"], name == std::string("step") ? 2 * scans : scans) << name;
    EXPECT_GT(stage["median"], 0) << name;
    EXPECT_GE(stage["p99"], stage["median"]) << name;
    EXPECT_GE(stage["p99.9"], stage["p99"]) << name;
    EXPECT_GE(stage["worst"], stage["p99.9"]) << name;
    EXPECT_LE(stage["worst"], 1000 * json["wall_s"].get<double>()) << name;
  }
  // A pose takes at least the slower of the two filters.
  EXPECT_GE(json["latency_ms"]["total"]["worst"], json["latency_ms"]["step"]["worst"]);
  for (const char* words : {"latency in ms", "read", "step", "total"})
    EXPECT_NE(outcome.out.find(words), std::string::npos) << outcome.out;
}

TEST_F(LocalizePlayer, TheRateSetsThePaceAndChangesNoResult) {
  ASSERT_EQ(runWithTruth({"--rate", "max"}).code, 0);
  const auto results = [&] {
    return readText(out("run_00_health.csv")) + readText(out("run_00.tum"));
  };
  const std::string atFullSpeed = results();
  ASSERT_EQ(runWithTruth({"--rate", "20x"}).code, 0);
  EXPECT_EQ(results(), atFullSpeed);
  const double recorded = street.frames.back().time - street.frames.front().time;  // s
  EXPECT_EQ(timings()["rate"], 20.0);
  EXPECT_GE(timings()["wall_s"], recorded / 20);
  // On one thread, too. That of the configuration is for windows only.
  fs::copy_file(out("config.ini"), folder / "config.ini", fs::copy_options::overwrite_existing);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  ASSERT_EQ(runWithTruth({"--rate", "40x"}).code, 0);
  EXPECT_EQ(results(), atFullSpeed);
  EXPECT_GE(timings()["wall_s"], recorded / 40);
  ASSERT_EQ(runWithTruth().code, 0);
  EXPECT_EQ(timings()["rate"], "max");
}

TEST_F(LocalizePlayer, AnErrorInMidDriveChangesNothing) {
  const std::string frames = (folder / "frames").string();
  ASSERT_EQ(runWithTruth({"--runs", "2", "--frames", frames, "--scenes", "20"}).code, 0);
  const std::string before = bytes();
  const auto there = names(folder / "out");
  street.frames[30].motion.reset();
  writeRawlog();
  const auto more = {"--frames", frames.c_str(), "--frame-every", "7", "--scenes", "7"};
  expectFailure(runWithTruth({more.begin(), more.end()}),
                {"in.rawlog", "no odometry for scan 30, at ", "--odometry-noise"});
  EXPECT_EQ(bytes(), before);
  EXPECT_EQ(names(folder / "out"), there);
  EXPECT_EQ(names(frames).size(), scans);
  expectFailure(runProgram(localizeMain, {"--config", (folder / "config.ini").string(), "--input",
                                          (folder / "in.rawlog").string(), "--map",
                                          (folder / "map.polemap").string(), "--truth",
                                          (folder / "truth.tum").string(), "--output",
                                          (folder / "new").string()}),
                {"scan 30"});
  EXPECT_FALSE(fs::exists(folder / "new"));
}

TEST_F(LocalizePlayer, WhatIsKnownAtTheEndOnlyChangesNothingEither) {
  ASSERT_EQ(runWithTruth().code, 0);
  const std::string before = bytes();
  auto truth = io::planar(io::readTum(folder / "truth.tum"));
  truth.resize(scans / 2 - 1);
  io::writeTum(folder / "truth.tum", truth);
  expectFailure(runWithTruth(), {"truth.tum", "19 of 40"});
  EXPECT_EQ(bytes(), before);
}

}  // namespace
}  // namespace polemcl::test_localize_player
