#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <fstream>

#include <polemcl/core/common/Types.h>
#include <polemcl/io/data/Cloud.h>
#include "io/dataset/ScanFolder.h"
#include "io/map/PolePositions.h"
#include "sim/drive/Drive.h"
#include "sim/drive/Simulation.h"
#include "support/TempFolder.h"

namespace polemcl::test_simulation {

using namespace polemcl::sim;
namespace fs = std::filesystem;

namespace {
class Simulation : public testing::Test {
 protected:
  Simulation() {
    m_options.sensor = "vlp16";
    m_options.scans = 6;
    m_options.world.length = 60;
  }
  fs::path folder(const std::string& name) const {
    fs::create_directories(m_folder / name);
    return m_folder / name;
  }
  SimulationOptions m_options;

 private:
  testing_apps::TempFolder m_folder;
};
}  // namespace

TEST_F(Simulation, WritesAFolderThatReadsBackAsTheDrive) {
  const fs::path out = folder("out");
  std::vector<std::size_t> steps;
  const SimulationSummary summary =
      simulate(m_options, out, [&](std::size_t done, std::size_t) { steps.push_back(done); });
  EXPECT_EQ(summary.scans, 6u);
  EXPECT_EQ(steps, (std::vector<std::size_t>{1, 2, 3, 4, 5, 6}));
  const World world = makeWorld(m_options.world);
  const Drive drive = makeDrive(world, m_options);
  const io::ScanFolder read = io::readScanFolder(out, Eigen::Isometry3d::Identity());
  ASSERT_EQ(read.scans.size(), 6u);
  std::size_t points = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const io::ScanEntry& entry = read.scans[i];
    EXPECT_NEAR(entry.time, drive.time[i], 1e-6);
    EXPECT_TRUE(entry.T_map_robot->isApprox(drive.T_map_sensor[i], 1e-6));
    const io::Cloud cloud = io::readKittiBin(entry.cloud);
    EXPECT_EQ(cloud.invalid, 0u);
    points += cloud.x.size();
    const fs::path labels = out / "labels" / entry.cloud.stem().replace_extension(".label");
    EXPECT_EQ(fs::file_size(labels), 4 * cloud.x.size());
    if (i == 0) continue;
    EXPECT_NEAR(entry.motion->mean.x, drive.odometry[i - 1].dx, 1e-6);
    EXPECT_NEAR(entry.motion->covariance(0, 0), std::pow(drive.odometry[i - 1].sx, 2), 1e-6);
  }
  EXPECT_EQ(points, summary.points);
  const auto poles = io::readPolePositions(out / "poles_gt.csv");
  ASSERT_EQ(poles.size(), world.poles().size());
  EXPECT_EQ(poles.size(), summary.poles);
  EXPECT_NEAR(poles[0].x(), world.poles()[0].x, 1e-4);
}

TEST_F(Simulation, AnOriginBelowMovesCloudsAndPosesButNotTheWorld) {
  m_options.scans = 2;
  const fs::path plain = folder("plain"), moved = folder("moved");
  simulate(m_options, plain);
  m_options.originZ = 0.9;
  simulate(m_options, moved);
  const auto a = io::readScanFolder(plain, Eigen::Isometry3d::Identity()),
             b = io::readScanFolder(moved, Eigen::Isometry3d::Identity());
  const io::Cloud there = io::readKittiBin(a.scans[1].cloud),
                  here = io::readKittiBin(b.scans[1].cloud);
  ASSERT_EQ(there.x.size(), here.x.size());
  const auto inMap = [](const io::ScanEntry& scan, const io::Cloud& cloud, std::size_t i) {
    return Eigen::Vector3d(*scan.T_map_robot * Eigen::Vector3d(cloud.x[i], cloud.y[i], cloud.z[i]));
  };
  for (std::size_t i = 0; i < here.x.size(); i += 97) {
    EXPECT_EQ(here.x[i], there.x[i]);
    EXPECT_NEAR(here.z[i] - there.z[i], 0.9, 1e-4);
    EXPECT_LT((inMap(a.scans[1], there, i) - inMap(b.scans[1], here, i)).norm(), 1e-4);
  }
}

/// Two LiDARs of one vehicle are two simulations.
TEST_F(Simulation, AnOriginAsideIsAnotherPlaceOnTheSameVehicle) {
  m_options.scans = 2;
  const fs::path plain = folder("plain"), moved = folder("moved");
  simulate(m_options, plain);
  m_options.originX = 1.2;
  m_options.originY = -0.5;
  simulate(m_options, moved);
  const auto a = io::readScanFolder(plain, Eigen::Isometry3d::Identity()),
             b = io::readScanFolder(moved, Eigen::Isometry3d::Identity());
  EXPECT_LT((a.scans[1].T_map_robot->matrix() - b.scans[1].T_map_robot->matrix()).norm(), 1e-5);
  const io::Cloud cloud = io::readKittiBin(b.scans[1].cloud);
  double nearest = 1e9;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    nearest = std::min(nearest, std::hypot(cloud.x[i] - 1.2, cloud.y[i] + 0.5));
  EXPECT_GT(nearest, 0.9) << "nothing is nearer to the LiDAR than its least range";
}

TEST_F(Simulation, BytesDoNotDependOnTheNumberOfThreads) {
  const fs::path one = folder("one"), many = folder("many");
  m_options.scans = 16;
  tbb::task_arena(1).execute([&] { simulate(m_options, one); });
  tbb::task_arena(2).execute([&] { simulate(m_options, many); });
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(one)) {
    if (!entry.is_regular_file()) continue;
    EXPECT_EQ(testing_apps::readText(entry.path()),
              testing_apps::readText(many / fs::relative(entry.path(), one)))
        << entry.path();
    ++files;
  }
  EXPECT_EQ(files, 16u + 16u + 4u);
}

TEST_F(Simulation, RefusesAFolderItCannotWriteTo) {
  const fs::path file = folder("out") / "file";
  std::ofstream(file) << "in the way";
  EXPECT_THROW(simulate(m_options, file), Error);
}

TEST_F(Simulation, RefusesOptionsBeforeItWritesAnything) {
  m_options.spacing = -1;
  const fs::path out = folder("out");
  EXPECT_THROW(simulate(m_options, out), Error);
  EXPECT_TRUE(fs::is_empty(out));
}

}  // namespace polemcl::test_simulation
