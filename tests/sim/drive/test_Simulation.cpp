#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <fstream>

#include <polemcl/core/common/Types.h>
#include <polemcl/io/data/Cloud.h>
#include "io/dataset/ScanFolder.h"
#include "io/map/PoleTables.h"
#include "sim/drive/Drive.h"
#include "sim/drive/Simulation.h"
#include "support/TempFolder.h"

namespace polemcl::test_simulation {
namespace {

using namespace polemcl::sim;
namespace fs = std::filesystem;

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

// Points on poles, seen while the vehicle turns round a corner and put back by its true motion.
TEST_F(Simulation, DistortionIsThatOfTheMotionInBends) {
  m_options.motionDistortion = true;
  m_options.scans = 1000;
  m_options.spacing = 1.5;
  m_options.world.length = 400;
  m_options.world.sideStreets = 1;
  m_options.detour = 1;
  const SimulatedDrive simulated(m_options);
  const Drive& drive = simulated.drive();
  const ScanTiming timing = timingOf(simulated.lidar());
  const auto yaw = [&](std::size_t i) {
    const Eigen::Matrix3d turn = drive.T_map_sensor[i].linear();
    return std::atan2(turn(1, 0), turn(0, 0));
  };
  // A wrong velocity across the vehicle moves what is seen at its sides, the more the longer ago.
  double products = 0, squares = 0;
  for (std::size_t i = 1; i + 1 < simulated.scans(); ++i) {
    const double dt = drive.time[i + 1] - drive.time[i - 1];
    const double rate = std::remainder(yaw(i + 1) - yaw(i - 1), 2 * M_PI) / dt;
    if (std::abs(rate) < 0.3) continue;
    const Eigen::Vector3d velocity =
        (drive.T_map_sensor[i + 1].translation() - drive.T_map_sensor[i - 1].translation()) / dt;
    const SimulatedScan scan = simulated.scan(i);
    for (std::size_t k = 0; k < scan.size(); ++k)
      for (const TruePole& pole : simulated.world().poles()) {
        if (pole.id != scan.label[k] || std::abs(scan.z[k]) > 0.7f) continue;  // no arm, no plate
        const double t = timing.offset(std::atan2(scan.y[k], scan.x[k]));
        if (std::abs(t) < 0.03) continue;  // near the middle of the turn nothing moves
        const Eigen::Vector3d seen(scan.x[k], scan.y[k], scan.z[k]);
        const Eigen::Vector3d place = drive.T_map_sensor[i].translation() + t * velocity +
                                      Eigen::AngleAxisd(rate * t, Eigen::Vector3d::UnitZ()) *
                                          (drive.T_map_sensor[i].linear() * seen);
        const Eigen::Vector2d beyond(place.x() - pole.x, place.y() - pole.y);
        const Eigen::Vector2d ray = Eigen::Vector2d(beyond + Eigen::Vector2d(pole.x, pole.y) -
                                                    drive.T_map_sensor[i].translation().head<2>())
                                        .normalized();
        const double u = t * scan.y[k] / std::hypot(scan.x[k], scan.y[k]) * (rate > 0 ? 1 : -1);
        products += u * (beyond.dot(ray) + pole.radius);
        squares += u * u;
      }
  }
  ASSERT_GT(squares, 0.1);
  EXPECT_NEAR(products / squares, 0, 0.1);  // m/s
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

}  // namespace
}  // namespace polemcl::test_simulation
