#include <polemcl/apps/LocalizeApp.h>
#include <polemcl/apps/RawlogActions.h>
#include <polemcl/io/Trajectory.h>
#include <polemcl/mrpt/RawlogWriter.h>
#include <polemcl/mrpt/RegisterClasses.h>
#include <tbb/global_control.h>

#include <nlohmann/json.hpp>

#include "../mrpt/PoleStreet.h"
#include "TempFolder.h"

using namespace polemcl;
using namespace polemcl::apps;
using namespace testing_apps;

namespace {

constexpr std::size_t scans = 40;

/// A street as files: `in.rawlog` of stored poles, `map.polemap`, `truth.tum`, `config.ini`.
class LocalizeApp : public testing::Test {
 protected:
  LocalizeApp() {
    registerClasses();
    tests::StreetOptions options;
    options.scans = scans;
    street = tests::makeStreet(options);
    street.map->saveToPoleMapFile((folder / "map.polemap").string());
    writeRawlog();
    std::vector<StampedPose2D> truth;
    for (std::size_t i = 0; i < scans; ++i)
      truth.push_back({street.frames[i].time, street.truth[i]});
    io::writeTum(folder / "truth.tum", truth);
    writeText(folder / "config.ini",
              "[likelihood]\nsigma_m = 0.1\n[filter]\nparticles = 200\n[start]\nparticles = 1\n");
  }

  void writeRawlog() {
    RawlogWriter writer((folder / "in.rawlog").string());
    for (const auto& frame : street.frames) {
      auto poles = CObservationPoles::Create();
      poles->timestamp = mrpt::Clock::fromDouble(frame.time);
      poles->poles = frame.poles_robot;
      poles->points = static_cast<std::uint32_t>(frame.points);
      writer.write(makeActions(frame.motion, poles->timestamp), poles);
    }
    writer.commit();
  }

  std::vector<std::string> arguments(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{
        "--config", (folder / "config.ini").string(),  "--input",  (folder / "in.rawlog").string(),
        "--map",    (folder / "map.polemap").string(), "--output", (folder / "out").string()};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  Outcome run(const std::vector<std::string>& more = {}) const {
    return runProgram(localizeMain, arguments(more));
  }
  Outcome runWithTruth(std::vector<std::string> more = {}) const {
    more.insert(more.end(), {"--truth", (folder / "truth.tum").string()});
    return run(more);
  }
  nlohmann::json summary() const { return nlohmann::json::parse(readText(out("summary.json"))); }
  fs::path out(const std::string& name) const { return folder / "out" / name; }
  /// All results but the timings.
  std::string bytes() const {
    std::string all;
    for (const auto& name : names(folder / "out"))
      if (name != "timings.json") all += name + "\n" + readText(out(name));
    return all;
  }

  TempFolder folder;
  tests::PoleStreet street;
};

std::size_t lines(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n');
}

}  // namespace

TEST_F(LocalizeApp, WritesWhatTheContractSays) {
  const auto outcome = runWithTruth({"--runs", "2"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(names(folder / "out"),
            std::vector<std::string>({"config.ini", "run_00.tum", "run_00_cov.csv",
                                      "run_00_errors.csv", "run_00_health.csv", "run_01.tum",
                                      "run_01_cov.csv", "run_01_errors.csv", "run_01_health.csv",
                                      "summary.json", "timings.json"}));
  const auto estimate = io::planar(io::readTum(out("run_01.tum")));
  ASSERT_EQ(estimate.size(), scans);
  for (std::size_t i = 0; i < scans; ++i) {
    EXPECT_NEAR(estimate[i].time, street.frames[i].time, 2e-6);
    if (i >= 5) {
      EXPECT_NEAR(estimate[i].pose.x, street.truth[i].x, 0.3);
    }
  }
  const std::string csv = readText(out("run_00_errors.csv"));
  EXPECT_EQ(csv.substr(0, csv.find('\n')),
            "scan,timestamp,position_m,lateral_m,longitudinal_m,heading_deg,poles,"
            "effective_share");
  EXPECT_EQ(lines(csv), scans + 1);
  EXPECT_NE(outcome.out.find("run_01"), std::string::npos);
  EXPECT_NE(outcome.out.find("mean"), std::string::npos);
  EXPECT_EQ(outcome.err, "");
}

TEST_F(LocalizeApp, SummaryHoldsMeanRunsAndSpread) {
  ASSERT_EQ(runWithTruth({"--runs", "3", "--seed", "9"}).code, 0);
  const auto json = summary();
  ASSERT_EQ(json["runs"].size(), 3u);
  const auto truth = io::planar(io::readTum(folder / "truth.tum"));
  double sum = 0, squares = 0, largest = 0;
  for (int i = 0; i < 3; ++i) {
    const auto& entry = json["runs"][i];
    EXPECT_EQ(entry["seed"], 9 + i);
    EXPECT_EQ(entry["trajectory"], "run_0" + std::to_string(i) + ".tum");
    const auto file = io::planar(io::readTum(out(entry["trajectory"])));
    const auto errors = evaluateTrajectory(truth, file, Sampling::perPose);
    EXPECT_NEAR(entry["pos_mean"], errors.posMean, 1e-6);
    EXPECT_NEAR(entry["ang_rmse_deg"], errors.angRmseDeg, 1e-5);
    EXPECT_EQ(entry["poses"], scans);
    sum += errors.posMean;
    squares += errors.posMean * errors.posMean;
    largest = std::max(largest, errors.posMax);
  }
  EXPECT_NEAR(json["pos_mean"], sum / 3, 1e-6);
  EXPECT_NEAR(json["pos_max"], largest, 1e-6);
  EXPECT_NEAR(json["spread"]["pos_mean"], std::sqrt((squares - sum * sum / 3) / 2), 1e-6);
  for (const char* key : {"pos_rmse", "lat_mean", "lon_mean", "ang_mean_deg", "ang_rmse_deg"})
    EXPECT_GT(json[key], 0) << key;
  EXPECT_EQ(json["poses"], scans);
  EXPECT_EQ(json["scans"], scans);
  EXPECT_EQ(json["seed"], 9);
  EXPECT_EQ(json["particles"], 200);
}

TEST_F(LocalizeApp, ErrorsBelongToTheScansTheTruthCovers) {
  auto truth = io::planar(io::readTum(folder / "truth.tum"));
  truth.erase(truth.begin(), truth.begin() + 10);
  io::writeTum(folder / "truth.tum", truth);
  writeText(folder / "config.ini",
            readText(folder / "config.ini") + "position_m = 3 -2\n" + "yaw_deg = 22.9\n");
  ASSERT_EQ(runWithTruth().code, 0);
  const std::string csv = readText(out("run_00_errors.csv"));
  EXPECT_EQ(lines(csv), scans - 10 + 1);
  EXPECT_EQ(csv.substr(csv.find('\n') + 1, 6), "10,101");
  EXPECT_EQ(summary()["unmatched"], 10);
  EXPECT_EQ(summary()["poses"], scans - 10);
}

TEST_F(LocalizeApp, WithoutTruthThereAreNoErrors) {
  writeText(folder / "config.ini",
            readText(folder / "config.ini") + "position_m = 3 -2\n" + "yaw_deg = 22.9\n");
  const auto outcome = run({"--quiet"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(names(folder / "out"),
            std::vector<std::string>({"config.ini", "run_00.tum", "run_00_cov.csv",
                                      "run_00_health.csv", "summary.json", "timings.json"}));
  EXPECT_FALSE(summary().contains("pos_mean"));
  EXPECT_NEAR(summary()["start"]["yaw_deg"], 22.9, 1e-9);
}

TEST_F(LocalizeApp, SameBytesAgainAndOnOneThread) {
  ASSERT_EQ(runWithTruth({"--runs", "4"}).code, 0);
  const std::string first = bytes();
  ASSERT_EQ(runWithTruth({"--runs", "4"}).code, 0);
  EXPECT_EQ(bytes(), first);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  ASSERT_EQ(runWithTruth({"--runs", "4"}).code, 0);
  EXPECT_EQ(bytes(), first);
}

TEST_F(LocalizeApp, EffectiveConfigurationGivesTheSameResult) {
  ASSERT_EQ(runWithTruth({"--runs", "2", "--seed", "77", "--particles", "150"}).code, 0);
  const auto first = readText(out("run_01.tum"));
  EXPECT_EQ(summary()["particles"], 150);
  fs::copy_file(out("config.ini"), folder / "config.ini", fs::copy_options::overwrite_existing);
  ASSERT_EQ(runWithTruth().code, 0);
  EXPECT_EQ(readText(out("run_01.tum")), first);
}

TEST_F(LocalizeApp, OldRunsGoWhenNewOnesAreComplete) {
  ASSERT_EQ(runWithTruth({"--runs", "3"}).code, 0);
  const std::string before = bytes();
  expectFailure(runProgram(localizeMain, arguments({"--truth", (folder / "none").string()})),
                {"none"});
  EXPECT_EQ(bytes(), before);
  ASSERT_EQ(runWithTruth({"--runs", "1"}).code, 0);
  EXPECT_FALSE(fs::exists(out("run_01.tum")));
  EXPECT_FALSE(fs::exists(out("run_02_errors.csv")));
}

TEST_F(LocalizeApp, RefusesARawlogWithoutOdometry) {
  for (std::size_t i = 1; i < scans; ++i) street.frames[i].motion.reset();
  writeRawlog();
  expectFailure(runWithTruth(), {"in.rawlog", "odometry", "--odometry-noise"});
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST_F(LocalizeApp, RefusesAMapWithoutPoles) {
  CPoleMap().saveToPoleMapFile((folder / "map.polemap").string());
  expectFailure(runWithTruth(), {"map.polemap", "no poles"});
}

TEST_F(LocalizeApp, RefusesToStartNowhere) {
  expectFailure(run(), {"no start pose", "[start]", "--truth"});
  auto truth = io::planar(io::readTum(folder / "truth.tum"));
  truth.erase(truth.begin());
  io::writeTum(folder / "truth.tum", truth);
  expectFailure(runWithTruth(), {"truth.tum", "first scan"});
}

TEST_F(LocalizeApp, RefusesATruthOfAnotherDrive) {
  auto truth = io::planar(io::readTum(folder / "truth.tum"));
  truth.resize(scans / 2 - 1);
  io::writeTum(folder / "truth.tum", truth);
  expectFailure(runWithTruth(), {"truth.tum", "19 of 40"});
}

TEST_F(LocalizeApp, RefusesADriveOnWhichNoPoleWasSeen) {
  for (auto& frame : street.frames) frame.poles_robot.clear();
  writeRawlog();
  expectFailure(runWithTruth(), {"in.rawlog", "no pole", "[extraction]"});
}

TEST_F(LocalizeApp, RefusesUnknownClasses) {
  std::string data = readText(folder / "in.rawlog");
  for (std::size_t at; (at = data.find("CObservationPoles")) != std::string::npos;)
    data.replace(at, 17, "CObservationTrees");
  writeText(folder / "in.rawlog", data);
  expectFailure(runWithTruth(), {"CObservationTrees"});
}

TEST_F(LocalizeApp, TruncatedRawlogsOnlyWhenAllowed) {
  const std::string data = readText(folder / "in.rawlog");
  writeText(folder / "in.rawlog", data.substr(0, data.size() - 30));
  expectFailure(runWithTruth(), {"in.rawlog", "truncated"});
  const auto outcome = runWithTruth({"--allow-truncated"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(io::readTum(out("run_00.tum")).size(), scans - 1);
  EXPECT_EQ(summary()["truncated"], true);
  EXPECT_NE(outcome.out.find("truncated"), std::string::npos);
}

TEST_F(LocalizeApp, RefusesMissingFiles) {
  for (const char* name : {"config.ini", "in.rawlog", "map.polemap", "truth.tum"}) {
    fs::rename(folder / name, folder / "aside");
    expectFailure(runWithTruth(), {name});
    fs::rename(folder / "aside", folder / name);
  }
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST_F(LocalizeApp, RefusesAnOutputThatIsAFile) {
  writeText(folder / "out", "mine");
  expectFailure(runWithTruth(), {"out", "folder"});
  EXPECT_EQ(readText(folder / "out"), "mine");
}

TEST_F(LocalizeApp, WrongUsage) {
  expectUsageError(runProgram(localizeMain, {}));
  expectUsageError(run({"--runs", "0"}));
  expectUsageError(run({"--particles", "many"}));
  expectUsageError(run({"--seed", "-1"}));
}
