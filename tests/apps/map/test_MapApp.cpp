#include <polemcl/core/common/Types.h>
#include "cli/RunRecords.h"
#include "extract/ExtractApp.h"
#include "io/data/Trajectory.h"
#include "io/file/TextFile.h"
#include "io/map/PoleMapFile.h"
#include "io/map/PoleTables.h"
#include "map/DriveFixFiles.h"
#include "map/MapApp.h"
#include "map/MapBuildReport.h"
#include "mrpt/rawlog/GnssFixes.h"
#include "support/IoFiles.h"
#include "support/Samples.h"
#include "support/StreetTest.h"

namespace polemcl::test_map_app {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

class MapApp : public StreetTest {
 protected:
  void drive(const std::string& name, std::size_t scans, double startTime = 50, double startX = 0) {
    writeStreet(folder / name, scans, streetPoles(), startTime, startX);
    import(name);
  }
  Outcome run(const std::vector<std::string>& inputs, const std::vector<std::string>& more = {},
              const std::string& ini = "") {
    std::vector<std::string> arguments{"build", "--config", ini.empty() ? config() : ini,
                                       "--output", at("street.polemap")};
    arguments.push_back("--input");
    for (const auto& name : inputs) arguments.push_back(at(name + ".rawlog"));
    arguments.push_back("--truth");
    for (const auto& name : inputs) arguments.push_back(at(name + ".tum"));
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(mapMain, arguments);
  }
  bool hasMap() const { return fs::exists(folder / "street.polemap"); }
};

/// Every pole is a true one, within 5 cm.
void expectTruePoles(const std::vector<MapPole>& poles) {
  for (const auto& pole : poles) {
    double nearest = 1e9;
    for (const auto& truth : streetPoles())
      nearest = std::min(nearest, std::hypot(pole.x - truth.x, pole.y - truth.y));
    EXPECT_LT(nearest, 0.05) << pole.x << ' ' << pole.y;
  }
}

TEST_F(MapApp, MapsTheStreet) {
  drive("in", 12);
  const Outcome outcome =
      succeeded(run({"in"}, {"--csv", at("street.csv"), "--scene", at("street.3Dscene")}));
  const auto map = io::readPoleMap(folder / "street.polemap");
  expectTruePoles(map.poles);
  EXPECT_GE(map.poles.size(), 8u);
  EXPECT_EQ(map.info.at("scans"), "12");
  EXPECT_EQ(map.info.at("inputs"), "in.rawlog");
  EXPECT_NE(map.info.at("config").find("section_length_m"), std::string::npos);
  EXPECT_HAS(outcome.out, std::to_string(map.poles.size()) + " poles from 12 scans over 11.0 m");
  EXPECT_EQ(io::readPolePositions(folder / "street.csv").size(), map.poles.size());
  EXPECT_EQ(readText(folder / "street.csv").rfind("x,y,radius,count,", 0), 0u);
  EXPECT_GT(fs::file_size(folder / "street.3Dscene"), 1000u);
}

TEST_F(MapApp, ScansAndStoredPolesGiveTheSameMap) {
  drive("in", 8);
  ASSERT_EQ(run({"in"}).code, 0);
  const auto fromScans = io::readPoleMap(folder / "street.polemap").poles;
  ExtractOptions extract;
  extract.input = folder / "in.rawlog";
  extract.output = folder / "poles.rawlog";
  extractPoles(extract, settings());
  fs::copy_file(folder / "in.tum", folder / "poles.tum");
  ASSERT_EQ(run({"poles"}).code, 0);
  const auto fromPoles = io::readPoleMap(folder / "street.polemap").poles;
  ASSERT_EQ(fromPoles.size(), fromScans.size());
  for (std::size_t i = 0; i < fromPoles.size(); ++i) {
    EXPECT_EQ(fromPoles[i].x, fromScans[i].x);
    EXPECT_EQ(fromPoles[i].y, fromScans[i].y);
    EXPECT_EQ(fromPoles[i].count, fromScans[i].count);
  }
}

TEST_F(MapApp, WithoutTruthOdometryAndPolesGiveThePoses) {
  writeStreet(folder / "in", 40, streetPoles(), 50, 0);
  ImportOptions import;
  import.input = folder / "in";
  import.output = folder / "in.rawlog";
  import.odometryNoise = 0.02;
  import.odometryScale = 0.03;
  importDataset(import);
  const Outcome outcome = succeeded(buildWithoutTruth({"--png", at("map.png")}));
  EXPECT_NE(outcome.out.find("poses by odometry"), std::string::npos) << outcome.out;
  EXPECT_EQ(io::readPoleMap(folder / "street.polemap").info.at("poses"), "odometry");
  const auto truth = io::readPlanarTum(folder / "in.tum"),
             found = io::readPlanarTum(folder / "found.tum");
  ASSERT_EQ(found.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Pose2D right = relative(truth[0].pose, truth[i].pose);
    EXPECT_NEAR(found[i].pose.x, right.x, 0.1) << i;
    EXPECT_NEAR(found[i].pose.y, right.y, 0.1) << i;
  }
  EXPECT_EQ(readEstimates(folder / "found_cov.csv").size(), truth.size());
  EXPECT_GT(fs::file_size(folder / "map.png"), 10000u);
}

/// Two drives of a street, at once or one after the other: both are in the frame of the first.
TEST_F(MapApp, WithoutTruthDrivesOfAStreetShareAMap) {
  std::vector<StreetPole> poles;  // no two places look alike
  for (const double x : {-9.0, 2.0, 8.5, 21.0, 26.0, 40.5, 49.0, 53.5, 68.0, 76.0, 90.0}) {
    poles.push_back({x, 6.0});
    poles.push_back({95 - x + 0.03 * x * x / 10, -7.0});
  }
  for (const std::string name : {"a", "b"}) {
    writeStreet(folder / name, 80, poles, 50, name == "a" ? 0 : 0.3);
    ImportOptions import;
    import.input = folder / name;
    import.output = folder / (name + ".rawlog");
    import.odometryNoise = 0.02;
    import.seed = name == "a" ? 1 : 2;
    importDataset(import);
  }
  const auto build = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"build", "--config", config()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = succeeded(runProgram(mapMain, arguments));
    return outcome.out;
  };
  const auto expectPlaces = [&](const std::string& file) {
    const Pose2D frame = io::readPlanarTum(folder / "a.tum").at(0).pose;
    const auto truth = io::readPlanarTum(folder / "b.tum"), found = io::readPlanarTum(at(file));
    ASSERT_EQ(found.size(), truth.size());
    for (std::size_t i = 0; i < truth.size(); ++i) {
      EXPECT_NEAR(found[i].pose.x, truth[i].pose.x - frame.x, 0.1) << file << i;
      EXPECT_NEAR(found[i].pose.y, truth[i].pose.y - frame.y, 0.1) << file << i;
    }
    EXPECT_EQ(readEstimates(folder / (fs::path(file).stem().string() + "_cov.csv")).size(),
              truth.size());
  };
  const std::string both = build({"--input", at("a.rawlog"), at("b.rawlog"), "--output",
                                  at("both.polemap"), "--trajectory", at("a1.tum"), at("b1.tum")});
  EXPECT_NE(both.find("b.rawlog: its odometry is"), std::string::npos) << both;
  expectPlaces("b1.tum");
  build({"--input", at("a.rawlog"), "--output", at("a.polemap"), "--keep-scans"});
  const std::string added =
      build({"--add", at("a.polemap"), "--input", at("b.rawlog"), "--output", at("added.polemap"),
             "--trajectory", at("b2.tum"), "--png", at("added.png")});
  EXPECT_EQ(added.find("a.rawlog: its odometry is"), std::string::npos) << added;
  expectPlaces("b2.tum");
  const auto info = io::readPoleMap(folder / "added.polemap").info;
  EXPECT_EQ(info.at("inputs"), "a.rawlog b.rawlog");
  EXPECT_EQ(info.at("poses"), "odometry");
}

/// Fixes beside the rawlog: the map lies on Earth.
TEST_F(MapApp, PositionsFromSatellitesGiveTheDatum) {
  writeStreet(folder / "in", 60, streetPoles(), 50, 0);
  import("in");
  writeFixes();
  const std::string fixes = readText(folder / "fixes.csv");
  const Outcome outcome =
      succeeded(buildWithoutTruth({"--gnss", at("fixes.csv"), "--datum", "48,9"}));
  EXPECT_NE(outcome.out.find("placed by 59 positions"), std::string::npos) << outcome.out;
  EXPECT_EQ(io::readPoleMap(folder / "street.polemap").info.at("datum"), "48,9,0");
  const auto truth = io::readPlanarTum(folder / "in.tum"),
             found = io::readPlanarTum(folder / "found.tum");
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(found[i].pose.x, 100 + truth[i].pose.x, 0.1) << i;
    EXPECT_NEAR(found[i].pose.y, 50 + truth[i].pose.y, 0.1) << i;
  }
  EXPECT_EQ(buildWithoutTruth({"--gnss", at("fixes.csv")}).code, 0) << "the first fix is the datum";
  EXPECT_EQ(io::readPoleMap(folder / "street.polemap").info.at("datum").rfind("48.0004", 0), 0u);
  const std::size_t firstRow = fixes.find('\n') + 1;
  writeText(folder / "cold.csv", std::string(fixes).insert(firstRow, "50.005,0,0,5\n"));
  const auto cold = buildWithoutTruth({"--gnss", at("cold.csv")});
  EXPECT_NE(cold.out.find("placed by 59 positions"), std::string::npos) << cold.out << cold.err;
  EXPECT_EQ(io::readPoleMap(folder / "street.polemap").info.at("datum").rfind("48.0004", 0), 0u);
  expectFailure(buildWithoutTruth({"--gnss", at("fixes.csv"), "--datum", "49,9"}),
                {"fixes.csv", "111 km from the datum 49,9,0", "leave out --gnss"});
  fs::copy_file(folder / "in.rawlog", folder / "bare.rawlog");
  const auto given = readGnssCsv(folder / "fixes.csv");
  std::string received;
  for (const GnssFix& fix : given) received += samples::bytesOf(*gnssObservation(fix));
  writeText(folder / "in.rawlog", readText(folder / "in.rawlog") + received);
  const auto kept = buildWithoutTruth();
  EXPECT_NE(kept.out.find("placed by 59 positions"), std::string::npos) << kept.out << kept.err;
  EXPECT_EQ(io::readPoleMap(folder / "street.polemap").info.at("datum").rfind("48.0004", 0), 0u);
  ASSERT_EQ(buildWithoutTruth({"--no-gnss"}).code, 0);
  EXPECT_EQ(io::readPoleMap(folder / "street.polemap").info.count("datum"), 0u);
  EXPECT_EQ(buildWithoutTruth({"--no-gnss", "--gnss", at("fixes.csv")}).code, 2);
  expectFailure(buildWithoutTruth({"--datum", "49,9"}), {"in.rawlog", "111 km from", "--no-gnss"});
  fs::copy_file(folder / "bare.rawlog", folder / "in.rawlog", fs::copy_options::overwrite_existing);
  ASSERT_EQ(buildWithoutTruth().code, 0);
  EXPECT_EQ(io::readPoleMap(folder / "street.polemap").info.count("datum"), 0u);
  EXPECT_EQ(buildWithoutTruth({"--gnss", at("fixes.csv"), at("fixes.csv")}).code, 2);
  EXPECT_EQ(buildWithoutTruth({"--gnss", at("fixes.csv"), "--truth", at("in.tum")}).code, 2);
  writeText(folder / "few.csv", fixes.substr(0, fixes.find('\n', 130) + 1));
  expectFailure(buildWithoutTruth({"--gnss", at("few.csv")}),
                {"few.csv", "too few", "leave out --gnss"});
  writeText(folder / "late.csv", "time,latitude,longitude,sigma\n1000,48,9,1\n");
  expectFailure(buildWithoutTruth({"--gnss", at("late.csv")}), {"late.csv", "none of its times"});
}

TEST_F(MapApp, WithoutTruthOdometryOrPolesTellTheWay) {
  writeStreet(folder / "in", 20);
  fs::remove(folder / "in" / "odometry.txt");
  import("in");
  const auto build = [&](const std::vector<std::string>& more) {
    return runProgram(mapMain,
                      {"build", "--config", config(), "--output", at("street.polemap"), "--input",
                       at("in.rawlog")},
                      more);
  };
  const Outcome outcome = succeeded(build({}));
  EXPECT_EQ(outcome.out.find("poses by odometry"), std::string::npos);
  EXPECT_HAS(outcome.out, "in.rawlog: no odometry leads to 19 scans; the poles told the way to 19");
  EXPECT_EQ(outcome.out.find("its odometry is"), std::string::npos);
  fs::remove(folder / "street.polemap");
  fs::remove_all(folder / "in");
  writeStreet(folder / "in", 20, {});
  fs::remove(folder / "in" / "odometry.txt");
  import("in");
  expectFailure(build({}), {"in.rawlog: no odometry leads to scan", "poles"});
  EXPECT_EQ(build({"--trajectory", at("a.tum"), at("b.tum")}).code, 2);
  EXPECT_EQ(build({"--trajectory", at("a.tum"), "--png", at("a_cov.csv")}).code, 2);
  EXPECT_EQ(build({"--truth", at("in.tum"), "--trajectory", at("a.tum")}).code, 2);
  EXPECT_FALSE(hasMap());
}

TEST_F(MapApp, ItsOwnConfidenceTakesTheExtractorsPlace) {
  drive("in", 12);
  MapBuildJob options;
  options.inputs = {folder / "in.rawlog"};
  options.poses = {folder / "in.tum"};
  options.output = folder / "street.polemap";
  AllSettings settings = loadSettings(config());
  settings.extraction.scanLine.minConfidence = 1;  // nothing is that sure
  const auto ignore = [](std::size_t, std::size_t) {};
  EXPECT_THROW(buildMap(options, settings, ignore), Error);
  settings.map.minConfidence = 0.3;
  const MapBuildSummary summary = buildMap(options, settings, ignore);
  EXPECT_GE(summary.map.poles.size(), 8u);
}

TEST_F(MapApp, SeveralDrivesMakeOneMap) {
  drive("one", 10);
  drive("two", 10, 500, 30);  // farther on, another day
  ASSERT_EQ(run({"one"}).code, 0);
  const auto first = io::readPoleMap(folder / "street.polemap").poles.size();
  const Outcome outcome = succeeded(run({"one", "two"}));
  const auto both = io::readPoleMap(folder / "street.polemap");
  expectTruePoles(both.poles);
  EXPECT_GT(both.poles.size(), first);
  EXPECT_NE(outcome.out.find("from 20 scans over 18.0 m"), std::string::npos) << outcome.out;
  EXPECT_EQ(both.info.at("inputs"), "one.rawlog two.rawlog");
}

TEST_F(MapApp, TruthIsInterpolatedInTime) {
  drive("in", 8);
  // Half of the rows are gone; along x the street is driven evenly.
  const auto truth = io::readTum(folder / "in.tum");
  std::vector<io::StampedPose3D> thin;
  for (std::size_t i = 0; i < truth.size(); i += 7) thin.push_back(truth[i]);
  io::writeTum(folder / "in.tum", thin);
  MapBuildJob job;
  job.inputs = {folder / "in.rawlog"};
  job.poses = {folder / "in.tum"};
  job.output = folder / "street.polemap";
  const auto summary = buildMap(job, settings());
  EXPECT_EQ(summary.scans, 8u);
  EXPECT_NEAR(summary.map.pathLength, 7, 1e-6);
}

TEST_F(MapApp, ScansWithoutTruthAreCountedAndLeftOut) {
  drive("in", 13);
  auto truth = io::readTum(folder / "in.tum");
  truth.resize(10);
  io::writeTum(folder / "in.tum", truth);
  const Outcome outcome = succeeded(run({"in"}));
  EXPECT_NE(outcome.out.find("without a pose, not used: 3"), std::string::npos) << outcome.out;
}

TEST_F(MapApp, RefusesTheTruthOfAnotherDrive) {
  drive("in", 6);
  drive("other", 6, 500);
  fs::copy_file(folder / "other.tum", folder / "in.tum", fs::copy_options::overwrite_existing);
  expectFailure(run({"in"}), {"in.tum", "0 of the 6 scans", "in.rawlog"});
  EXPECT_FALSE(hasMap());
}

TEST_F(MapApp, RefusesWhenNoPoleIsFound) {
  writeStreet(folder / "in", 6, {});
  import("in");
  writeText(folder / "street.polemap", "old");
  expectFailure(run({"in"}), {"no pole", "6 scans", "1.00 m apart", "section_length_m = 1.5",
                              "0 detections", "[extraction]"});
  EXPECT_EQ(readText(folder / "street.polemap"), "old");
}

TEST_F(MapApp, SaysThatTheTruthMayNotFit) {
  drive("in", 6);
  auto truth = io::readTum(folder / "in.tum");
  for (std::size_t i = 0; i < truth.size(); ++i)
    truth[i].pose.translation().y() += 3 * static_cast<double>(i);
  io::writeTum(folder / "in.tum", truth);
  expectFailure(run({"in"}), {"no pole found", "check that the true poses fit the scans"});
}

TEST_F(MapApp, AgreesWithATrueDrive) {
  drive("in", 12);
  const auto outcome = run({"in"});
  EXPECT_EQ(outcome.err, "");
  EXPECT_HAS(outcome.out, "in.rawlog: the poles agree with these poses");
  EXPECT_EQ(io::readPoleMap(folder / "street.polemap").info.count("warnings"), 0u);
}

TEST_F(MapApp, WarnsOfTheTruthOfAnotherDrive) {
  drive("in", 16);
  auto truth = io::readTum(folder / "in.tum");
  for (std::size_t i = 0; i < truth.size(); ++i)  // of a slower one, at the same times
    truth[i].pose.translation().x() *= 0.8;
  io::writeTum(folder / "in.tum", truth);
  const Outcome outcome = succeeded(run({"in"}, {"--set", "map.min_count=1"}));
  for (const char* part :
       {"warning: in.rawlog: the poles contradict these poses: truth of another "
        "drive or in another frame, wrong time or wrong scan timing (in 3 of 3 stretches)",
        "check in.tum"})
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
  const auto info = io::readPoleMap(folder / "street.polemap").info;
  EXPECT_EQ(info.at("warnings").rfind("in.rawlog: the poles contradict", 0), 0u);
}

TEST_F(MapApp, RefusesTimesThatGoBack) {
  drive("in", 12);
  const std::string drive = readText(folder / "in.rawlog");
  writeText(folder / "in.rawlog", drive + drive);
  const auto outcome = run({"in"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_HAS(outcome.err, "in.rawlog: time does not increase: scan 12 at 50.000000 s comes after");
  EXPECT_FALSE(hasMap());
}

TEST_F(MapApp, SideFilesDoNotComeWithoutTheMap) {
  drive("in", 12);
  const io::test::FileSizeLimit limit(4096);  // stands in for a full disk
  const auto outcome = run({"in"}, {"--csv", at("side.csv"), "--keep-scans"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_HAS(outcome.err, "street.polemap: a write failed");
  EXPECT_FALSE(hasMap());
  EXPECT_FALSE(fs::exists(folder / "side.csv"));
}

TEST_F(MapApp, NotesTwinPoles) {
  drive("in", 16);
  auto truth = io::readTum(folder / "in.tum");
  // Each fourth scan is right, so comparing these shows nothing; two of four are a scan late.
  for (std::size_t i = truth.size(); i-- > 1;)
    if (i % 4 > 1) truth[i].pose.translation().x() -= 0.7;
  io::writeTum(folder / "in.tum", truth);
  const Outcome outcome = succeeded(run({"in"}, {"--set", "map.min_count=1"}));
  EXPECT_NE(outcome.out.find("the poles agree"), std::string::npos) << outcome.out;
  EXPECT_HAS(outcome.err, "poles have a twin nearer than 1 m (the scans are 0.");
}

TEST_F(MapApp, NamesTheCountWhenNoPoleIsSeenOftenEnough) {
  drive("in", 6);
  writeText(folder / "strict.ini",
            "[sensor]\nmodel = hdl32e\nheight_m = 1.0\n[map]\nmin_count = 50\n");
  expectFailure(run({"in"}, {"--csv", at("street.csv")}, at("strict.ini")),
                {"no pole", "min_count = 50", "[map]\n"});
  EXPECT_FALSE(hasMap());
  EXPECT_FALSE(fs::exists(folder / "street.csv"));
}

TEST_F(MapApp, RefusesWhenNoScanHasAPoint) {
  writeStreet(folder / "in", 2);
  for (std::size_t i : {0, 1}) writeBin(folder / "in" / "velodyne" / scanName(i), {{0, 0, 0, 0}});
  import("in", false);
  expectFailure(run({"in"}), {"in.rawlog", "no usable scan"});
  drive("seen", 12);
  expectFailure(run({"seen", "in"}), {"in.rawlog", "no usable scan, 2 without a valid point"});
  expectFailure(
      runProgram(mapMain, {"build", "--config", config(), "--output", at("street.polemap"),
                           "--input", at("seen.rawlog"), at("in.rawlog")}),
      {"in.rawlog", "no usable scan"});
}

TEST_F(MapApp, RefusesATruncatedRawlogUnlessAllowed) {
  drive("in", 8);
  fs::resize_file(folder / "in.rawlog", fs::file_size(folder / "in.rawlog") - 1000);
  expectFailure(run({"in"}), {"in.rawlog"});
  EXPECT_FALSE(hasMap());
  const Outcome outcome = succeeded(run({"in"}, {"--allow-truncated"}));
  EXPECT_NE(outcome.out.find("from 7 scans"), std::string::npos) << outcome.out;
}

TEST_F(MapApp, RefusesUnknownClasses) {
  drive("in", 2);
  replace("in.rawlog", "CObservationPointCloud", "CObservationPointClown");
  expectFailure(run({"in"}), {"in.rawlog", "CObservationPointClown"});
}

TEST_F(MapApp, RefusesMissingFilesAndOtherEndings) {
  drive("in", 2);
  fs::rename(folder / "in.rawlog", folder / "away.rawlog");
  expectFailure(run({"in"}), {"in.rawlog"});
  fs::rename(folder / "away.rawlog", folder / "in.rawlog");
  fs::remove(folder / "in.tum");
  expectFailure(run({"in"}), {"in.tum"});
  expectFailure(runProgram(mapMain, {"build", "--config", config(), "--input", at("in.rawlog"),
                                     "--truth", at("in.tum"), "--output", at("street.csv")}),
                {"street.csv", ".polemap"});
}

TEST_F(MapApp, WrongUsage) {
  for (const std::vector<std::string>& none : {std::vector<std::string>(), {"--config", "c"}}) {
    const Outcome outcome = runProgram(mapMain, none);
    expectUsageError(outcome);
    EXPECT_HAS(outcome.err, "needed: build, update, diff, convert");
  }
  expectUsageError(runProgram(mapMain, {"build", "--config", "c", "--input", "a", "b", "--truth",
                                        "a", "--output", "m.polemap"}));
}

}  // namespace
}  // namespace polemcl::test_map_app
