#include <tbb/task_arena.h>

#include "eval/EvalApp.h"
#include "extract/ExtractApp.h"
#include "import/DatasetImport.h"
#include "io/data/Trajectory.h"
#include "io/file/CsvTable.h"
#include "mrpt/rawlog/PoleSequence.h"
#include "simulate/SimulateApp.h"
#include "support/DiskCalls.h"
#include "support/Poles.h"
#include "support/TempFolder.h"

namespace polemcl::test_simulated_poles {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

const std::string kModel = std::string(POLEMCL_SOURCE_DIR) + "/share/models/hdl32e.json";

class SimulatedPoles : public testing::Test {
 protected:
  void configure(const std::string& simulation, const std::string& world = "length_m = 60\n") {
    writeText(folder / "street.ini",
              "[sensor]\nmodel = hdl32e\nheight_m = 1.0\n[simulation]\nspacing_m = 0.7\n" +
                  simulation + "[world]\n" + world);
  }
  Outcome run(const std::string& rawlog, std::vector<std::string> extra = {}) {
    return runProgram(simulateMain, {"--config", at("street.ini"), "--poles", at(rawlog)}, extra);
  }
  std::string at(const std::string& name) { return (folder / name).string(); }
  PoleSequence read(const std::string& name) { return readPoleSequence(at(name), {}); }
  TempFolder folder;
};

using tests::expectSame;

TEST_F(SimulatedPoles, AreThoseOfSimulatingImportingAndExtracting) {
  configure("scans = 5\n");
  ASSERT_EQ(run("streamed.rawlog", {"--output", at("scans")}).code, 0);
  ImportOptions import;
  import.input = folder / "scans";
  import.output = folder / "scans.rawlog";
  importDataset(import);
  ExtractOptions extract;
  extract.input = folder / "scans.rawlog";
  extract.output = folder / "extracted.rawlog";
  extractPoles(extract, loadSettings(at("street.ini")));

  const PoleSequence streamed = read("streamed.rawlog"), extracted = read("extracted.rawlog");
  ASSERT_EQ(streamed.frames.size(), 5u);
  ASSERT_EQ(extracted.frames.size(), 5u);
  std::size_t poles = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    const PoleScan &a = streamed.frames[i], &b = extracted.frames[i];
    EXPECT_EQ(a.time, b.time);
    EXPECT_EQ(a.points, b.points);
    EXPECT_NEAR(a.motion->mean.x, b.motion->mean.x, 1e-8);
    EXPECT_NEAR(a.motion->mean.yaw, b.motion->mean.yaw, 1e-8);
    EXPECT_NEAR(a.motion->covariance(0, 0), b.motion->covariance(0, 0), 1e-6);
    ASSERT_EQ(a.poles_robot.size(), b.poles_robot.size());
    for (std::size_t k = 0; k < a.poles_robot.size(); ++k)
      expectSame(a.poles_robot[k], b.poles_robot[k]);
    poles += a.poles_robot.size();
  }
  EXPECT_GT(poles, 10u);
  const auto truth = io::readTum(folder / "streamed.tum"),
             imported = io::readTum(folder / "scans.tum");
  ASSERT_EQ(truth.size(), imported.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_EQ(truth[i].time, imported[i].time);
    EXPECT_TRUE(truth[i].pose.isApprox(imported[i].pose, 1e-6));
  }
  EXPECT_EQ(readText(folder / "streamed_poles_gt.csv"),
            readText(folder / "scans" / "poles_gt.csv"));
  EXPECT_EQ(readText(folder / "streamed_config.ini"), readText(folder / "scans" / "config.ini"));
}

TEST_F(SimulatedPoles, WithoutAFolderAreTheSameBytesOnAnyNumberOfThreads) {
  configure("scans = 4\n");
  tbb::task_arena(1).execute([&] { ASSERT_EQ(run("one.rawlog").code, 0); });
  tbb::task_arena(2).execute([&] {
    ASSERT_EQ(run("two.rawlog", {"--output", at("scans")}).code, 0);
  });
  EXPECT_EQ(readText(folder / "one.rawlog"), readText(folder / "two.rawlog"));
  EXPECT_GT(readText(folder / "one.rawlog").size(), 2000u);
}

TEST_F(SimulatedPoles, DrawnFromAModelAreTheSameBytesOnAnyNumberOfThreads) {
  configure("detections = " + kModel + "\n", "length_m = 200\n");
  tbb::task_arena(1).execute([&] { ASSERT_EQ(run("one.rawlog").code, 0); });
  tbb::task_arena(2).execute([&] { ASSERT_EQ(run("two.rawlog").code, 0); });
  EXPECT_EQ(readText(folder / "one.rawlog"), readText(folder / "two.rawlog"));
  EXPECT_EQ(read("one.rawlog").frames.size(), 283u);
  EXPECT_EQ(names(folder.path()),
            (std::vector<std::string>{"one.rawlog", "one.tum", "one_config.ini", "one_poles_gt.csv",
                                      "street.ini", "two.rawlog", "two.tum", "two_config.ini",
                                      "two_poles_gt.csv"}));
}

TEST_F(SimulatedPoles, AppearTogetherWithTruthAndSettings) {
  configure("scans = 2\ndetections = " + kModel + "\n");
  const testing_disk::DiskCalls calls;
  ASSERT_EQ(run("drive.rawlog").code, 0);
  EXPECT_EQ(
      calls.of("rename"),
      (std::vector<std::string>{"rename drive.tum, locked", "rename drive_poles_gt.csv, locked",
                                "rename drive_config.ini, locked", "rename drive.rawlog, locked"}));
}

TEST_F(SimulatedPoles, OfAnotherDriveOfTheDayDifferInNoiseOnly) {
  configure("detections = " + kModel + "\n");
  ASSERT_EQ(run("a.rawlog").code, 0);
  configure("drive_seed = 4\ndetections = " + kModel + "\n");
  ASSERT_EQ(run("b.rawlog").code, 0);
  EXPECT_EQ(readText(folder / "a_poles_gt.csv"), readText(folder / "b_poles_gt.csv"));
  const PoleSequence a = read("a.rawlog"), b = read("b.rawlog");
  ASSERT_EQ(a.frames.size(), b.frames.size());
  std::size_t differ = 0;
  for (std::size_t i = 1; i < a.frames.size(); ++i) {
    EXPECT_EQ(a.frames[i].time, b.frames[i].time);
    EXPECT_NE(a.frames[i].motion->mean.x, b.frames[i].motion->mean.x);
    differ += a.frames[i].poles_robot.empty() || b.frames[i].poles_robot.empty() ||
              a.frames[i].poles_robot[0].x != b.frames[i].poles_robot[0].x;
  }
  EXPECT_EQ(differ, a.frames.size() - 1);
}

TEST_F(SimulatedPoles, RefusesAModelOfAnotherLidar) {
  writeText(folder / "street.ini",
            "[sensor]\nmodel = vlp16\nheight_m = 1.0\n[simulation]\n"
            "detections = " +
                kModel + "\n");
  expectFailure(run("p.rawlog"), {"hdl32e.json", "hdl32e", "vlp16", "fit_detections.py"});
  EXPECT_EQ(names(folder.path()), std::vector<std::string>{"street.ini"});
}

TEST_F(SimulatedPoles, RefusesAModelThatIsNotThere) {
  configure("detections = nothing.json\n");
  expectFailure(run("p.rawlog"), {"nothing.json", "cannot read nothing.json"});
}

TEST_F(SimulatedPoles, RefusesScansOfADriveThatHasNone) {
  configure("detections = " + kModel + "\n");
  expectFailure(run("p.rawlog", {"--output", at("scans")}), {"detections", "--output"});
}

TEST_F(SimulatedPoles, RefusesANameThatIsNoRawlog) {
  configure("");
  expectFailure(run("poles.txt"), {"poles.txt", ".rawlog"});
}

TEST_F(SimulatedPoles, WantsToKnowWhatToWrite) {
  configure("");
  expectUsageError(runProgram(simulateMain, {"--config", at("street.ini")}));
}

TEST_F(SimulatedPoles, GiveATableOfSightingsWithoutTheirScans) {
  configure("detections = " + kModel + "\n");
  ASSERT_EQ(run("a.rawlog").code, 0);
  const auto sightings = [&](const std::string& rawlog) {
    return runProgram(evalMain, {"sightings", "--poles", at(rawlog), "--output", at("a.csv")});
  };
  const Outcome seen = succeeded(sightings("a.rawlog"));
  const io::CsvTable table(folder / "a.csv");
  const std::size_t points = table.column("points");
  std::size_t detections = 0, found = 0;
  for (const PoleScan& scan : read("a.rawlog").frames) detections += scan.poles_robot.size();
  for (std::size_t i = 0; i < table.rows(); ++i) found += !table.text(i, points).empty();
  EXPECT_EQ(found, detections);
  EXPECT_GT(table.rows(), detections);
  EXPECT_HAS(readText(folder / "a.csv"), "# sensor hdl32e\n# height_m 1\n");

  fs::copy(folder / "a.rawlog", folder / "b.rawlog");
  expectFailure(sightings("b.rawlog"), {"b_config.ini"});
  configure("scans = 3\ndetections = " + kModel + "\n");
  ASSERT_EQ(run("b.rawlog").code, 0);
  fs::copy(folder / "a.rawlog", folder / "b.rawlog", fs::copy_options::overwrite_existing);
  expectFailure(sightings("b.rawlog"), {"b.rawlog", "scans"});
}

}  // namespace
}  // namespace polemcl::test_simulated_poles
