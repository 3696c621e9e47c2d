#include <mrpt/obs/CActionRobotMovement2D.h>

#include <map>

#include <polemcl/core/common/Types.h>
#include "cli/CommandLine.h"
#include "extract/ExtractApp.h"
#include "mrpt/rawlog/GnssFixes.h"
#include "mrpt/rawlog/RawlogReader.h"
#include "support/DiskCalls.h"
#include "support/Samples.h"
#include "support/StreetTest.h"

namespace polemcl::test_extract_app {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

struct CsvPole {
  std::size_t scan;
  double time;
  Eigen::Vector2d centre;  ///< robot frame
  double radius;
};

std::vector<CsvPole> readCsv(const fs::path& file) {
  std::istringstream lines(readText(file));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "scan,timestamp,x,y,radius,bottom,top,confidence,points,cxx,cxy,cyy");
  std::vector<CsvPole> poles;
  while (std::getline(lines, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream in(line);
    CsvPole pole{};
    std::vector<double> rest(7);
    in >> pole.scan >> pole.time >> pole.centre.x() >> pole.centre.y() >> pole.radius;
    for (double& value : rest) in >> value;
    EXPECT_TRUE(in) << line;
    poles.push_back(pole);
  }
  return poles;
}

class ExtractApp : public StreetTest {
 protected:
  Outcome run(std::vector<std::string> more = {}) {
    return runProgram(
        extractMain,
        {"--config", config(), "--input", at("in.rawlog"), "--output", at("poles.rawlog")}, more);
  }
};

TEST_F(ExtractApp, FindsThePolesOfEveryScan) {
  importStreet("in", 4);
  const Outcome outcome = succeeded(run({"--csv", at("poles.csv")}));
  EXPECT_NE(outcome.out.find("in 4 scans"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("candidates: "), std::string::npos) << outcome.out;

  std::vector<std::size_t> right(4, 0);
  for (const auto& pole : readCsv(folder / "poles.csv")) {
    ASSERT_LT(pole.scan, 4u);
    EXPECT_NEAR(pole.time, 50 + 0.2 * static_cast<double>(pole.scan), 1e-6);
    const double yaw = 0.05 * std::sin(0.7 * static_cast<double>(pole.scan));
    const Eigen::Vector2d inMap =
        Eigen::Rotation2Dd(yaw) * pole.centre + Eigen::Vector2d(static_cast<double>(pole.scan), 0);
    double nearest = 1e9;
    for (const auto& truth : streetPoles())
      nearest = std::min(nearest, (inMap - Eigen::Vector2d(truth.x, truth.y)).norm());
    EXPECT_LT(nearest, 0.1) << inMap.transpose();
    ++right[pole.scan];
  }
  for (std::size_t count : right) EXPECT_GE(count, 6u);
}

TEST_F(ExtractApp, SaysWhenNoScanHasAPole) {
  importStreet("in", 2);
  EXPECT_EQ(run().err.find("warning"), std::string::npos);
  const Outcome outcome = succeeded(run({"--quiet", "--set", "scan_line.min_height_m=50"}));
  EXPECT_EQ(outcome.err, "pole-extract: warning: " + at("in.rawlog") +
                             ": no pole in any of 2 scans: check [sensor] and [extraction]\n");
}

TEST_F(ExtractApp, TheRangeImageMethodFitsTheSensorByItself) {
  importStreet("in", 4);
  const Outcome outcome =
      succeeded(run({"--csv", at("poles.csv"), "--set", "extraction.method=range_image"}));
  // Rows and borders of another LiDAR find nothing in these scans.
  EXPECT_GE(readCsv(folder / "poles.csv").size(), 12u);
  const auto kitti =
      run({"--set", "extraction.method=range_image", "--set", "range_image.rows=64", "--set",
           "range_image.fov_up_deg=3", "--set", "range_image.fov_down_deg=-25"});
  EXPECT_NE(kitti.err.find("no pole in any"), std::string::npos) << kitti.out;
}

TEST_F(ExtractApp, DrawsAScanWithItsPoles) {
  importStreet("in", 2);
  const std::vector<std::string> arguments{"--config",      config(),       "--input",
                                           at("in.rawlog"), "--output",     at("poles.rawlog"),
                                           "--png",         at("scan.png"), "--png-scan"};
  const auto draw = [&](const std::string& scan) {
    auto all = arguments;
    all.push_back(scan);
    return runProgram(extractMain, all);
  };
  const Outcome outcome = succeeded(draw("1"));
  EXPECT_EQ(readText(folder / "scan.png").substr(1, 3), "PNG");
  fs::remove(folder / "poles.rawlog");
  expectFailure(draw("2"), {at("in.rawlog"), "no scan 2", "there are 2", "poles are written"});
  EXPECT_FALSE(fs::exists(folder / "scan.png")) << "of other poles";
  expectFailure(runProgram(extractMain, {"--config", config(), "--input", at("poles.rawlog"),
                                         "--output", at("again.rawlog"), "--png", at("p.png")}),
                {at("poles.rawlog"), "holds poles"});
}

TEST_F(ExtractApp, PictureAndTableAppearWithTheRawlog) {
  importStreet("in", 2);
  const testing_disk::DiskCalls calls;
  ASSERT_EQ(run({"--csv", at("poles.csv"), "--png", at("scan.png")}).code, 0);
  EXPECT_EQ(calls.of("rename"),
            (std::vector<std::string>{"rename scan.png, locked", "rename poles.csv, locked",
                                      "rename poles.rawlog, locked"}));
}

TEST_F(ExtractApp, DrawsTheStepsOfTheRangeImageMethodOnly) {
  importStreet("in", 1);
  const std::vector<std::string> arguments{"--config",      config(),       "--input",
                                           at("in.rawlog"), "--output",     at("poles.rawlog"),
                                           "--range-image", at("range.png")};
  expectFailure(runProgram(extractMain, arguments), {"--range-image", "method = range_image"});
  auto all = arguments;
  all.insert(all.end(), {"--set", "extraction.method=range_image"});
  const Outcome outcome = succeeded(runProgram(extractMain, all));
  EXPECT_EQ(readText(folder / "range.png").substr(1, 3), "PNG");
}

TEST_F(ExtractApp, KeepsMotionsTimesAndSensorPose) {
  writeStreet(folder / "in", 3);
  import("in", true, "0.5 0 0 90 0 0");
  // What scales covariances is applied by whoever localizes, not here too.
  writeText(folder / "factor.ini", readText(config()) + "[motion]\ncovariance_factor = 4\n");
  const Outcome outcome =
      succeeded(runProgram(extractMain, {"--config", at("factor.ini"), "--input", at("in.rawlog"),
                                         "--output", at("poles.rawlog"), "--quiet"}));
  EXPECT_EQ(outcome.out, "");
  RawlogReader before(at("in.rawlog")), after(at("poles.rawlog"));
  RawlogEntry scan, poles;
  std::size_t entries = 0;
  while (after.next(poles)) {
    ASSERT_TRUE(before.next(scan));
    const auto was = scan.action->getActionByClass<mrpt::obs::CActionRobotMovement2D>();
    const auto is = poles.action->getActionByClass<mrpt::obs::CActionRobotMovement2D>();
    ASSERT_TRUE(was && is);
    EXPECT_EQ(is->estimationMethod, mrpt::obs::CActionRobotMovement2D::emScan2DMatching);
    EXPECT_EQ(is->poseChange->getMeanVal(), was->poseChange->getMeanVal());
    EXPECT_EQ(is->poseChange->getCovariance(), was->poseChange->getCovariance());
    ASSERT_EQ(poles.frame->size(), 1u);
    const auto observation = poles.frame->getObservationByClass<CObservationPoles>();
    ASSERT_TRUE(observation);
    EXPECT_EQ(observation->timestamp, scan.frame->getObservationByIndex(0)->timestamp);
    EXPECT_NEAR(observation->sensorPose.yaw(), M_PI / 2, 1e-12);
    EXPECT_FALSE(observation->poles.empty());
    ++entries;
  }
  EXPECT_EQ(entries, 3u);
  EXPECT_FALSE(before.next(scan));
}

TEST_F(ExtractApp, PositionsFromSatellitesSurvive) {
  writeStreet(folder / "in", 3);  // at 50, 50.2, 50.4 s
  import("in");
  ASSERT_EQ(run().code, 0);
  const std::string plain = readText(folder / "poles.rawlog");

  std::vector<mrpt::obs::CObservationGPS::Ptr> received;
  for (const double time : {49.0, 50.1, 50.2, 60.0})
    received.push_back(gnssObservation({time, 49, 8 + time / 1e4, 3, {1, 2}}));
  std::string late;
  for (const std::size_t i : {2, 0, 3, 1}) late += samples::bytesOf(*received[i]);
  writeText(folder / "in.rawlog", readText(folder / "in.rawlog") + late);
  ASSERT_EQ(run().code, 0);

  std::string kinds;
  RawlogReader reader(at("poles.rawlog"));
  RawlogEntry entry;
  while (reader.next(entry)) kinds += entry.observation ? 'g' : entry.action ? 'p' : '?';
  EXPECT_EQ(kinds, "gpgpgpg");
  std::string rest = readText(folder / "poles.rawlog");
  for (const auto& observation : received) {
    const std::string bytes = samples::bytesOf(*observation);
    ASSERT_NE(rest.find(bytes), std::string::npos);
    rest.erase(rest.find(bytes), bytes.size());
  }
  EXPECT_EQ(rest, plain) << "nothing else has changed";
}

TEST_F(ExtractApp, CsvIsInTheRobotFrame) {
  writeStreet(folder / "in", 1, {{8, 3}});  // seen from the sensor at its origin
  import("in", true, "1 2 0 90 0 0");
  ASSERT_EQ(run({"--csv", at("poles.csv")}).code, 0);
  const auto poles = readCsv(folder / "poles.csv");
  ASSERT_EQ(poles.size(), 1u);
  EXPECT_NEAR(poles[0].centre.x(), 1 - 3, 0.05);  // turned by 90 degrees: (8, 3) is (-3, 8)
  EXPECT_NEAR(poles[0].centre.y(), 2 + 8, 0.05);
  EXPECT_NEAR(poles[0].radius, streetPoleRadius, 0.05);
}

TEST_F(ExtractApp, CloudsInsideAndOutsideGiveTheSameBytes) {
  writeStreet(folder / "in", 2);
  import("in", false);
  ASSERT_EQ(run().code, 0);
  const auto outside = readText(folder / "poles.rawlog");
  import("in", true);
  ASSERT_EQ(run().code, 0);
  EXPECT_EQ(readText(folder / "poles.rawlog"), outside);
}

TEST_F(ExtractApp, ScansWithoutPointsKeepTheirPlace) {
  writeStreet(folder / "in", 3);
  writeBin(folder / "in" / "velodyne" / scanName(1), {{0, 0, 0, 0}, {0, 0, 0, 1}});
  import("in", false);  // nobody looked inside so far
  const Outcome outcome = succeeded(run({"--csv", at("poles.csv")}));
  EXPECT_NE(outcome.out.find("scans without a valid point: 1"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("invalid 2"), std::string::npos) << outcome.out;
  std::map<std::size_t, int> perScan;
  for (const auto& pole : readCsv(folder / "poles.csv")) ++perScan[pole.scan];
  EXPECT_EQ(perScan.count(1), 0u);
  EXPECT_EQ(perScan.count(2), 1u);
}

TEST_F(ExtractApp, RefusesWhenNoScanHasAPoint) {
  writeStreet(folder / "in", 2);
  for (std::size_t i : {0, 1}) writeBin(folder / "in" / "velodyne" / scanName(i), {{0, 0, 0, 0}});
  import("in", false);
  expectFailure(run(), {"in.rawlog", "no usable scan"});
  EXPECT_EQ(names(folder.path()), std::vector<std::string>({"in", "in.rawlog", "in.tum"}));
}

TEST_F(ExtractApp, RefusesMissingFiles) {
  expectFailure(run(), {"in.rawlog"});
  expectFailure(runProgram(extractMain, {"--config", at("no.ini"), "--input", at("in.rawlog"),
                                         "--output", at("poles.rawlog")}),
                {"no.ini"});
  EXPECT_TRUE(names(folder.path()).empty());
}

TEST_F(ExtractApp, RefusesATruncatedRawlogUnlessAllowed) {
  importStreet("in", 3);
  fs::resize_file(folder / "in.rawlog", fs::file_size(folder / "in.rawlog") - 1000);
  writeText(folder / "poles.rawlog", "old");
  expectFailure(run(), {"in.rawlog"});
  EXPECT_EQ(readText(folder / "poles.rawlog"), "old");
  EXPECT_EQ(names(folder.path()),
            std::vector<std::string>({"in", "in.rawlog", "in.tum", "poles.rawlog"}));

  const Outcome outcome = succeeded(run({"--allow-truncated"}));
  EXPECT_NE(outcome.out.find("in 2 scans"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("ended too early"), std::string::npos) << outcome.out;
}

TEST_F(ExtractApp, RefusesUnknownClasses) {
  importStreet("in", 2);
  replace("in.rawlog", "CObservationPointCloud", "CObservationPointClown");
  expectFailure(run(), {"in.rawlog", "CObservationPointClown"});
  EXPECT_EQ(names(folder.path()), std::vector<std::string>({"in", "in.rawlog", "in.tum"}));
}

TEST_F(ExtractApp, RefusesATruncatedExternalCloud) {
  writeStreet(folder / "in", 2);
  import("in", false);
  const auto cloud = folder / "in" / "velodyne" / scanName(1);
  fs::resize_file(cloud, fs::file_size(cloud) - 7);
  expectFailure(run(), {scanName(1)});
  EXPECT_EQ(names(folder.path()), std::vector<std::string>({"in", "in.rawlog", "in.tum"}));
}

TEST_F(ExtractApp, RefusesToReplaceItsInput) {
  importStreet("in", 1);
  const auto bytes = readText(folder / "in.rawlog");
  expectFailure(runProgram(extractMain, {"--config", config(), "--input", at("in.rawlog"),
                                         "--output", at("in.rawlog")}),
                {"--output", "is an input (--input)"});
  EXPECT_EQ(readText(folder / "in.rawlog"), bytes);
}

TEST_F(ExtractApp, NamesWhatAFileInTheWrongPlaceIs) {
  importStreet("in", 1);
  expectFailure(runProgram(extractMain, {"--config", at("in.rawlog"), "--input", at("in.rawlog"),
                                         "--output", at("poles.rawlog")}),
                {"in.rawlog: it is a rawlog, not an INI file"});
  writeText(folder / "map.csv", "x,y\n1,2\n");
  expectFailure(runProgram(extractMain, {"--inspect", at("in.rawlog"), "--truth", at("map.csv")}),
                {"map.csv", "not a trajectory"});
}

// Whatever the way of writing the name, and for all outputs of all programs.
TEST_F(ExtractApp, SideOutputsReplaceNoInput) {
  importStreet("in", 1);
  const auto settings = readText(config());
  const fs::path path = config();
  const std::string same = (path.parent_path() / "." / path.filename()).string();
  for (const std::string option : {"--csv", "--png"})
    expectFailure(run({option, same}), {option, "is an input (--config)"});
  expectFailure(
      runProgram(extractMain, {"--inspect", at("in.rawlog"), "--write-config", at("in.rawlog")}),
      {"--write-config", "is an input (--inspect)"});
  EXPECT_EQ(readText(config()), settings);
  EXPECT_EQ(run({"--csv", at("poles.rawlog")}).code, exitUsage);
}

TEST_F(ExtractApp, RefusesUnknownSettings) {
  writeText(folder / "bad.ini", "[sensor]\nmodell = hdl32e\n");
  expectFailure(runProgram(extractMain, {"--config", at("bad.ini"), "--input", at("in.rawlog"),
                                         "--output", at("poles.rawlog")}),
                {"bad.ini", "modell"});
}

TEST_F(ExtractApp, WrongUsage) {
  expectUsageError(runProgram(extractMain, {}));
  expectUsageError(run({"--cvs", "x"}));
}

}  // namespace
}  // namespace polemcl::test_extract_app
