#include <polemcl/core/common/Types.h>
#include "cli/Settings.h"
#include "io/dataset/ScanFolder.h"
#include "simulate/SimulateApp.h"
#include "support/TempFolder.h"

namespace polemcl::test_simulate_app {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

class SimulateApp : public testing::Test {
 protected:
  SimulateApp() { configure("vlp16\nheight_m = 1.2"); }
  void configure(const std::string& model) {
    writeText(folder / "street.ini",
              "[sensor]\nmodel = " + model + "\n[simulation]\nscans = 3\n[world]\nlength_m = 40\n");
  }
  Outcome run(std::vector<std::string> extra = {}) {
    return runProgram(simulateMain, {"--config", at("street.ini"), "--output", at("drive")}, extra);
  }
  std::string at(const std::string& name) { return (folder / name).string(); }
  TempFolder folder;
};
TEST_F(SimulateApp, WritesTheFolderLayoutAndTheEffectiveSettings) {
  const Outcome outcome =
      succeeded(run({"--seed", "7", "--day", "2", "--length", "50", "--sensor", "os1_64"}));
  EXPECT_NE(outcome.out.find("3 scans over 1.0 m"), std::string::npos) << outcome.out;
  EXPECT_EQ(names(folder / "drive"),
            (std::vector<std::string>{"config.ini", "labels", "odometry.txt", "poles_gt.csv",
                                      "poses.txt", "times.txt", "velodyne"}));
  EXPECT_EQ(io::readScanFolder(folder / "drive", Eigen::Isometry3d::Identity()).scans.size(), 3u);
  const AllSettings effective = loadSettings(at("drive/config.ini"));
  EXPECT_EQ(effective.simulation.world.seed, 7u);
  EXPECT_EQ(effective.simulation.world.day, 2);
  EXPECT_EQ(effective.simulation.world.length, 50);
  EXPECT_EQ(effective.simulation.sensor, "os1_64");
  EXPECT_EQ(effective.simulation.height, 1.2);
}

TEST_F(SimulateApp, RunningAgainReplacesWithTheSameBytes) {
  ASSERT_EQ(run().code, 0);
  const std::string first = readText(folder / "drive" / "velodyne" / "000002.bin");
  ASSERT_EQ(run().code, 0);
  EXPECT_EQ(readText(folder / "drive" / "velodyne" / "000002.bin"), first);
  EXPECT_FALSE(first.empty());
  ASSERT_EQ(run({"--seed", "8"}).code, 0);
  EXPECT_NE(readText(folder / "drive" / "velodyne" / "000002.bin"), first);
  EXPECT_EQ(names(folder.path()), (std::vector<std::string>{"drive", "street.ini"}));
}

TEST_F(SimulateApp, RunningAgainReplacesTheTimingToo) {
  for (int i = 0; i < 2; ++i)
    ASSERT_EQ(run({"--set", "simulation.motion_distortion=true"}).code, 0) << i;
  EXPECT_TRUE(std::filesystem::exists(folder / "drive" / "scan_timing.ini"));
  ASSERT_EQ(run().code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "drive" / "scan_timing.ini"));
}

TEST_F(SimulateApp, RefusesToReplaceWhatItDidNotWrite) {
  writeText(folder / "drive" / "holiday.jpg", "sea");
  expectFailure(run(), {"drive", "holiday.jpg"});
  EXPECT_EQ(names(folder / "drive"), std::vector<std::string>{"holiday.jpg"});
}

TEST_F(SimulateApp, RefusesALidarItDoesNotKnowAndListsThoseItDoes) {
  const Outcome outcome = run({"--sensor", "lms200"});
  expectUsageError(outcome);
  EXPECT_NE(outcome.err.find("lms200 not in {hdl32e,"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(folder / "drive"));
}

TEST_F(SimulateApp, RefusesBeamsThatAreNotListed) {
  expectFailure(run({"--sensor", "table"}), {"street.ini", "elevations_deg", "at least 2 rings"});
  EXPECT_FALSE(fs::exists(folder / "drive"));
}

// Other programs take a sensor at any height.
TEST_F(SimulateApp, RefusesAHeightThatNoVehicleHas) {
  configure("vlp16\nheight_m = 9");
  expectFailure(run(), {"street.ini", "height_m = 9", "0.3 to 5"});
  EXPECT_NO_THROW(saveSettings(loadSettings(at("street.ini")), at("saved.ini")));
}

TEST_F(SimulateApp, RefusesASettingOutOfRange) {
  expectFailure(run({"--length", "3"}), {"length_m = 3", "20 to 50000"});
  EXPECT_FALSE(fs::exists(folder / "drive"));
}

TEST_F(SimulateApp, NamesAMissingConfiguration) {
  fs::remove(folder / "street.ini");
  expectFailure(run(), {"street.ini"});
}

TEST_F(SimulateApp, WrongUsageEndsWithTwo) {
  expectUsageError(runProgram(simulateMain, {"--output", at("drive")}));
  expectUsageError(run({"--length", "long"}));
}

TEST_F(SimulateApp, QuietSaysNothing) {
  const Outcome outcome = run({"--quiet"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
}

}  // namespace
}  // namespace polemcl::test_simulate_app
