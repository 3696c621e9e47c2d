#include <tbb/global_control.h>

#include <sstream>

#include "cli/Projections.h"
#include "io/map/Datum.h"
#include "io/map/PoleMapFile.h"
#include "mrpt/rawlog/GnssFixes.h"
#include "support/CityFiles.h"
#include "support/LocalizeTest.h"
#include "support/Samples.h"

namespace polemcl::test_localize_app {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

class LocalizeApp : public LocalizeTest {};

std::size_t lines(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n');
}

TEST_F(LocalizeApp, WritesWhatTheContractSays) {
  const Outcome outcome = succeeded(runWithTruth({"--runs", "2"}));
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
  const Outcome outcome = succeeded(run({"--quiet"}));
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

TEST_F(LocalizeApp, FramesAndScenesByCommandLineAndByConfiguration) {
  const std::string frames = (folder / "frames").string();
  ASSERT_EQ(runWithTruth({"--frames", frames, "--frame-every", "30", "--scenes", "25"}).code, 0);
  EXPECT_EQ(names(frames), std::vector<std::string>({"000000.png", "000030.png"}));
  EXPECT_EQ(names(out("run_00_scenes")),
            std::vector<std::string>({"000000.3Dscene", "000025.3Dscene"}));
  fs::remove_all(frames);
  fs::copy_file(out("config.ini"), folder / "config.ini", fs::copy_options::overwrite_existing);
  ASSERT_EQ(runWithTruth().code, 0);
  EXPECT_EQ(names(frames).size(), 2u);
  EXPECT_EQ(names(out("run_00_scenes")).size(), 2u);
}

TEST_F(LocalizeApp, RefusesAWindowWithoutADisplay) {
  if (std::getenv("DISPLAY") || std::getenv("WAYLAND_DISPLAY"))
    GTEST_SKIP() << "there is a display";
  expectFailure(runWithTruth({"--live"}), {"no display", "--frames"});
  EXPECT_FALSE(fs::exists(folder / "out"));
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

TEST_F(LocalizeApp, CovarianceAndHealthOfEveryScan) {
  const auto outcome = runWithTruth();
  ASSERT_EQ(outcome.code, 0);
  const std::string covariances = readText(out("run_00_cov.csv"));
  EXPECT_EQ(covariances.substr(0, covariances.find('\n')),
            "scan,timestamp,x_m,y_m,yaw_rad,xx,xy,xyaw,yy,yyaw,yawyaw");
  EXPECT_EQ(lines(covariances), scans + 1);
  const auto estimate = io::planar(io::readTum(out("run_00.tum")));
  const std::string last = covariances.substr(covariances.rfind('\n', covariances.size() - 2) + 1);
  double v[11];
  char comma;
  std::istringstream row(last);
  for (double& value : v) row >> value >> comma;
  EXPECT_EQ(v[0], scans - 1);
  EXPECT_NEAR(v[2], estimate.back().pose.x, 1e-6);
  EXPECT_NEAR(v[4], estimate.back().pose.yaw, 1e-6);
  Eigen::Matrix3d covariance;
  covariance << v[5], v[6], v[7], v[6], v[8], v[9], v[7], v[9], v[10];
  EXPECT_GT(covariance.determinant(), 0);
  EXPECT_LT(std::sqrt(v[5] + v[8]), 0.2);

  const std::string health = readText(out("run_00_health.csv"));
  EXPECT_EQ(health.substr(0, health.find('\n')),
            "scan,timestamp,state,reason,matched_share,seen_share,innovation,effective_particles,"
            "particles,mode_share,spread_m,spread_deg,poles,relocalized");
  EXPECT_EQ(lines(health), scans + 1);
  EXPECT_NE(health.find("\n0,100.000000000,degraded,converging,"), std::string::npos);
  EXPECT_NE(health.find(",ok,none,"), std::string::npos);
  EXPECT_EQ(health.find(",lost,"), std::string::npos);
  EXPECT_NE(outcome.out.find("% lost (converging "), std::string::npos) << outcome.out;
  const auto counted = summary()["runs"][0]["health"];
  EXPECT_EQ(counted["ok"].get<int>() + counted["degraded"].get<int>(), int(scans));
  EXPECT_EQ(counted["first_pose_scan"], 0);
}

TEST_F(LocalizeApp, StartsWhereTheCommandLineSays) {
  const Outcome outcome = succeeded(run({"--start", "3.5,-2.2,22.9,1.5,4"}));
  const auto start = summary()["start"];
  EXPECT_EQ(start["x"], 3.5);
  EXPECT_EQ(start["y"], -2.2);
  EXPECT_NEAR(start["yaw_deg"], 22.9, 1e-9);
  EXPECT_EQ(start["radius_m"], 1.5);
  EXPECT_NEAR(start["heading_deg"], 4, 1e-9);
  const auto first = readText(out("run_00.tum"));
  fs::copy_file(out("config.ini"), folder / "config.ini", fs::copy_options::overwrite_existing);
  ASSERT_EQ(run().code, 0);  // the effective configuration holds the start
  EXPECT_EQ(readText(out("run_00.tum")), first);
  expectUsageError(run({"--start", "3.5,-2.2"}));
  expectUsageError(run({"--start", "1,2,3,4,5", "--global"}));
  expectFailure(run({"--start", "90000,0,0,2,5"}), {"nearest pole", "1000"});
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

TEST_F(LocalizeApp, RefusesAStartInAnotherFrame) {
  auto truth = io::planar(io::readTum(folder / "truth.tum"));
  for (auto& pose : truth) pose.pose.x += 5000;
  io::writeTum(folder / "truth.tum", truth);
  expectFailure(runWithTruth(), {"from the nearest pole", "1000"});
}

TEST_F(LocalizeApp, WarnsOfATruthThatTheSpreadContradicts) {
  EXPECT_EQ(runWithTruth().err, "");
  EXPECT_EQ(summary()["ok_beyond_spread"], 0);
  auto truth = io::planar(io::readTum(folder / "truth.tum"));
  for (std::size_t i = truth.size() / 2; i < truth.size(); ++i) truth[i].pose.y += 3;
  io::writeTum(folder / "truth.tum", truth);
  const Outcome outcome = runWithTruth();
  EXPECT_EQ(outcome.code, 0);
  EXPECT_HAS(outcome.err,
             " % of the scans that were ok are more than 0.5 m and 5 times the spread");
  EXPECT_HAS(outcome.err, "truth.tum: truth of another drive");
  EXPECT_GT(summary()["ok_beyond_spread"], 10);
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
  const Outcome outcome = succeeded(runWithTruth({"--allow-truncated"}));
  EXPECT_EQ(io::readTum(out("run_00.tum")).size(), scans - 1);
  EXPECT_EQ(summary()["truncated"], true);
  EXPECT_NE(outcome.out.find("truncated"), std::string::npos);
}

TEST(LocalizeAppAnywhere, FindsTheVehicleAndTellsFromWhenOn) {
  registerClasses();
  const CityFiles city(80);
  const Outcome outcome = succeeded(
      runProgram(localizeMain, {"--config", city.at("city.ini"), "--input", city.at("drive.rawlog"),
                                "--map", city.at("city.polemap"), "--truth", city.at("drive.tum"),
                                "--output", city.at("out"), "--global", "--runs", "2"}));
  const auto json = nlohmann::json::parse(readText(city.folder / "out/summary.json"));
  EXPECT_EQ(json["start"], "anywhere");
  EXPECT_EQ(json["runs_without_pose"], 0);
  const std::size_t first = json["runs"][1]["health"]["first_pose_scan"];
  EXPECT_GE(first, 2u);
  const auto estimate = io::planar(io::readTum(city.at("out/run_01.tum")));
  ASSERT_EQ(estimate.size(), city.frames.size() - first);
  EXPECT_NEAR(estimate[0].time, CityFiles::time(first), 1e-5);
  for (std::size_t i = 0; i < estimate.size(); ++i)
    EXPECT_NEAR(estimate[i].pose.x, city.frames[first + i].truth.x, 0.5);
  const std::string errors = readText(city.folder / "out/run_01_errors.csv");
  EXPECT_EQ(errors.substr(errors.find('\n') + 1, std::to_string(first).size() + 1),
            std::to_string(first) + ",");
  const std::string health = readText(city.folder / "out/run_01_health.csv");
  EXPECT_NE(health.find("lost,searching"), std::string::npos);
  EXPECT_EQ(lines(health), city.frames.size() + 1);
}

TEST(LocalizeAppAnywhere, ThePositionFromSatellitesSaysWhereToSearch) {
  registerClasses();
  const CityFiles city(80);
  const io::Datum datum{50, 7, 0};
  const auto start = [&](const std::string& map) {
    return runProgram(localizeMain,
                      {"--config", city.at("city.ini"), "--input", city.at("drive.rawlog"), "--map",
                       city.at(map), "--output", city.at("out"), "--start-gnss"});
  };
  expectFailure(start("city.polemap"), {"city.polemap", "no datum", "--global"});
  CPoleMap map;
  map.loadFromPoleMapFile(city.at("city.polemap"));
  io::setDatum(map.info, datum, "city");
  map.saveToPoleMapFile(city.at("placed.polemap"));
  expectFailure(start("placed.polemap"), {"drive.rawlog", "no position from satellites"});

  const Pose2D& begin = city.frames[0].truth;
  const auto fixAt = [&](double x, double time) {
    const Eigen::Vector2d place = MapPlane(datum).lonLat({begin.x + x, begin.y});
    return samples::bytesOf(*gnssObservation({time, place.y(), place.x(), 2, {0, 0}}));
  };
  const std::string drive = readText(city.folder / "drive.rawlog");
  const std::string cold =  // what a receiver tells before it knows anything
      samples::bytesOf(*gnssObservation({CityFiles::time(0), 0, 0, 5, {0, 0}}));
  writeText(city.folder / "drive.rawlog", drive + fixAt(0, CityFiles::time(0) + 6));
  expectFailure(start("placed.polemap"), {"drive.rawlog", "6.0 s from the first scan"});
  writeText(city.folder / "drive.rawlog", cold + fixAt(8, CityFiles::time(1)) + drive);
  const Outcome outcome = succeeded(start("placed.polemap"));
  const auto json = nlohmann::json::parse(readText(city.folder / "out/summary.json"));
  EXPECT_EQ(json["start_source"], "gnss");
  EXPECT_NEAR(json["start"]["x"], begin.x + 8, 0.01);
  EXPECT_NEAR(json["start"]["radius_m"], 5 * 2 + 10 + 40 * 0.2, 0.01);
  const std::size_t first = json["runs"][0]["health"]["first_pose_scan"];
  const auto estimate = io::planar(io::readTum(city.at("out/run_00.tum")));
  for (std::size_t i = 0; i < estimate.size(); ++i)
    EXPECT_NEAR(estimate[i].pose.x, city.frames[first + i].truth.x, 0.5);
  // A receiver that began long before the LiDAR.
  writeText(city.folder / "drive.rawlog", fixAt(90, CityFiles::time(0) - 37) +
                                              fixAt(50, CityFiles::time(0) - 3) +
                                              fixAt(8, CityFiles::time(1)) + drive);
  ASSERT_EQ(start("placed.polemap").code, 0);
  EXPECT_NEAR(nlohmann::json::parse(readText(city.folder / "out/summary.json"))["start"]["x"],
              begin.x + 8, 0.01);
  writeText(city.folder / "drive.rawlog", fixAt(5000, CityFiles::time(0)) + drive);
  expectFailure(start("placed.polemap"), {"from the nearest pole of the map"});
}

TEST(LocalizeAppAnywhere, ARunThatFindsNothingIsNoErrorButSaysSo) {
  registerClasses();
  const CityFiles city(40), other(5, 99);
  io::PoleMapData map = io::readPoleMap(other.at("city.polemap"));
  map.info["warnings"] = "drive.rawlog: its scans doubt it";
  io::writePoleMap(other.at("city.polemap"), map);
  const Outcome outcome = succeeded(
      runProgram(localizeMain, {"--config", city.at("city.ini"), "--input", city.at("drive.rawlog"),
                                "--map", other.at("city.polemap"), "--truth", city.at("drive.tum"),
                                "--output", city.at("out"), "--global"}));
  EXPECT_NE(outcome.out.find("1 of 1 runs never found a pose"), std::string::npos);
  EXPECT_HAS(outcome.err, "warning: no pose was ok, most were lost: is ");
  EXPECT_HAS(outcome.err, "The map was made with warnings: drive.rawlog: its scans doubt it");
  const auto json = nlohmann::json::parse(readText(city.folder / "out/summary.json"));
  EXPECT_EQ(json["runs_without_pose"], 1);
  EXPECT_TRUE(json["runs"][0]["health"]["first_pose_scan"].is_null());
  EXPECT_FALSE(json.contains("pos_mean"));
  EXPECT_FALSE(fs::exists(city.folder / "out/run_00_errors.csv"));
}

TEST_F(LocalizeApp, AGapTooLongForTheOdometryKeepsTheResults) {
  for (std::size_t i = scans / 2; i < scans; ++i) street.frames[i].time += 60;
  street.frames[scans / 2].motion->covariance = 400 * Eigen::Matrix3d::Identity();
  writeRawlog();
  const Outcome outcome = succeeded(run({"--start", "0,0,0,1,5"}));
  const std::string health = readText(out("run_00_health.csv"));
  EXPECT_EQ(lines(health), scans + 1);
  EXPECT_NE(health.find("lost,searching"), std::string::npos);
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
  expectUsageError(run({"--rate", "soon"}));
  expectUsageError(run({"--rate", "0x"}));
  expectUsageError(run({"--scenes", "-1"}));
  expectUsageError(run({"--frame-every", "0"}));
}

}  // namespace
}  // namespace polemcl::test_localize_app
