#include <cmath>
#include <set>

#include "core/evaluation/MapEvaluation.h"
#include "io/data/Trajectory.h"
#include "io/dataset/LabelledScans.h"
#include "io/map/PoleMapFile.h"
#include "io/map/PoleTables.h"
#include "labels/LabelsApp.h"
#include "sim/drive/Simulation.h"
#include "support/ScanFolders.h"
#include "support/StreetDatasets.h"

namespace polemcl::test_labels_app {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

constexpr std::uint32_t trunk = 71, pole = 80, building = 50;

std::string bytesOf(const std::vector<std::uint32_t>& labels) {
  return {reinterpret_cast<const char*>(labels.data()), labels.size() * 4};
}

class LabelsApp : public testing::Test {
 protected:
  std::string at(const std::string& name) const { return (folder / name).string(); }
  Outcome run(const std::string& output = "truth.polemap",
              const std::vector<std::string>& more = {}) {
    return runProgram(labelsMain, {"--input", at("00"), "--output", at(output)}, more);
  }
  /// Scans a metre apart along x, at y = 0; KITTI's camera looks along x and has z ahead.
  void writeSequence(std::size_t scans) {
    std::string times, poses;
    for (std::size_t i = 0; i < scans; ++i) {
      const auto x = static_cast<float>(i);
      Points points;
      std::vector<std::uint32_t> labels;
      for (float z = -1.5f; z < 2; z += 0.1f) {
        points.push_back({10 - x, 4, z, 0});
        labels.push_back(pole);
        points.push_back({6 - x, -5, z, 0});
        labels.push_back(trunk | 0x30000u);
        points.push_back({8 - x, 2, z, 0});
        labels.push_back(building);
      }
      points.push_back({0, 0, 0, 0});  // no return: dropped with its label
      labels.push_back(pole);
      writeBin(folder / "00/velodyne" / scanName(i), points);
      writeText((folder / "00/labels" / scanName(i)).replace_extension(".label"), bytesOf(labels));
      times += std::to_string(0.1 * static_cast<double>(i)) + '\n';
      poses += "1 0 0 0 0 1 0 0 0 0 1 " + std::to_string(i) + '\n';
    }
    writeText(folder / "00/times.txt", times);
    writeText(folder / "00/poses.txt", poses);
    writeText(folder / "00/calib.txt",
              "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n");
  }
  TempFolder folder;
};

TEST_F(LabelsApp, MapsTheLabelsOfASequence) {
  writeSequence(5);
  const Outcome outcome = succeeded(run());
  EXPECT_HAS(outcome.out, "2 poles from 350 points in 5 scans");
  const auto map = io::readPoleMap(folder / "truth.polemap");
  ASSERT_EQ(map.poles.size(), 2u);
  EXPECT_NEAR(map.poles[0].x, 6, 1e-3);  // the LiDAR's frame of scan 0
  EXPECT_NEAR(map.poles[0].y, -5, 1e-3);
  EXPECT_NEAR(map.poles[1].x, 10, 1e-3);
  EXPECT_NEAR(map.poles[1].y, 4, 1e-3);
  EXPECT_NEAR(map.poles[1].top, 3.4, 0.11);
  EXPECT_EQ(map.poles[1].count, 5u);
  EXPECT_EQ(map.info.at("inputs"), "00");
  ASSERT_EQ(run("truth.csv").code, 0);
  EXPECT_EQ(io::readPolePositions(folder / "truth.csv").size(), 2u);
}

TEST_F(LabelsApp, ClassesCanBeChosen) {
  writeSequence(5);
  ASSERT_EQ(run("truth.polemap", {"--stems", "80"}).code, 0);
  EXPECT_EQ(io::readPoleMap(folder / "truth.polemap").poles.size(), 1u);
  ASSERT_EQ(run("truth.polemap", {"--stems", "50", "80", "71"}).code, 0);
  EXPECT_EQ(io::readPoleMap(folder / "truth.polemap").poles.size(), 3u);
}

TEST_F(LabelsApp, FindsThePolesOfASimulatedDrive) {
  sim::SimulationOptions options;
  options.sensor = "vlp16";
  options.world.seed = 501;
  options.world.length = 150;
  options.spacing = 2;
  fs::create_directories(folder / "00");
  sim::simulate(options, folder / "00");
  const auto poles = io::readWorldPoles(folder / "00/poles_gt.csv");
  std::set<std::uint32_t> ids;
  for (const auto& truePole : poles) ids.insert(truePole.id);
  relabel(folder / "00", ids);
  writeText(folder / "00/calib.txt", "Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n");
  ASSERT_EQ(run().code, 0);
  const auto way = io::readKittiPoses(folder / "00/poses.txt");
  std::vector<Eigen::Vector2d> truth;
  for (const auto& truePole : poles) {
    double nearest = 1e9;
    for (const auto& pose : way)
      nearest = std::min(nearest, std::hypot(pose.translation().x() - truePole.x,
                                             pose.translation().y() - truePole.y));
    if (nearest < 20) truth.emplace_back(truePole.x, truePole.y);
  }
  const MapScore score =
      scoreMap(truth, io::readPolePositions(folder / "truth.polemap"), 0.5, true);
  RecordProperty("precision", std::to_string(score.precision));
  RecordProperty("recall", std::to_string(score.recall));
  EXPECT_GT(score.truthPoles, 20u);
  EXPECT_GE(score.f1, 0.9) << score.precision << ' ' << score.recall;
}

TEST_F(LabelsApp, RefusesWhatIsMissing) {
  expectFailure(run(), {"00"});
  writeSequence(3);
  expectFailure(run("truth.png"), {"truth.png", ".polemap"});
  expectFailure(run("truth.csv", {"--min-scans", "4"}), {"00", "no pole found", "3 scans"});
  expectFailure(run("truth.csv", {"--min-scans", "0"}), {"min_scans", "at least 1"});
  EXPECT_FALSE(fs::exists(folder / "truth.csv"));
  writeText(folder / "00/labels/000001.label", "1234");
  expectFailure(run(), {"000001.label", "4 bytes"});
  fs::remove(folder / "00/labels/000001.label");
  expectFailure(run(), {"000001.label"});
  fs::remove(folder / "00/poses.txt");
  expectFailure(run(), {"00", "no poses"});
  EXPECT_FALSE(fs::exists(folder / "truth.polemap"));
}

TEST_F(LabelsApp, RefusesAnOutputBeforeItReadsScans) {
  writeSequence(3);
  writeText(folder / "00/labels/000000.label", "damaged");
  expectFailure(run("none/truth.polemap"), {"cannot write", "none/truth.polemap"});
  expectFailure(run(), {"000000.label"});
  EXPECT_EQ(names(folder.path()), std::vector<std::string>({"00"}));
}

TEST_F(LabelsApp, WrongUsage) {
  expectUsageError(runProgram(labelsMain, {}));
  expectUsageError(runProgram(labelsMain, {"--input", "a"}));
  expectUsageError(runProgram(labelsMain, {"--input", "a", "--output", "b", "--stems", "x"}));
}

}  // namespace
}  // namespace polemcl::test_labels_app
