#include "support/StreetDatasets.h"

#include <cmath>
#include <cstdio>

#include <polemcl/io/data/Cloud.h>
#include "io/data/Trajectory.h"
#include "io/dataset/LabelledScans.h"
#include "io/dataset/Mulran.h"
#include "io/file/Bytes.h"
#include "io/file/TextFile.h"
#include "support/NcltSamples.h"
#include "support/NumpyFiles.h"
#include "support/ScanFolders.h"

namespace testing_apps {
namespace {

using namespace polemcl;
using Pose = Eigen::Isometry3d;

constexpr double degree = M_PI / 180;

/// A simulated folder that was read back.
struct Drive {
  std::vector<fs::path> scans;
  std::vector<double> times;                   ///< s, from 0
  std::vector<Pose> poses;                     ///< pose of the sensor in the map
  std::vector<std::array<double, 6>> motions;  ///< odometry.txt: one less than scans
};

Drive simulated(const sim::SimulationOptions& options, const fs::path& folder) {
  fs::create_directories(folder);
  sim::simulate(options, folder);
  Drive drive;
  for (const auto& entry : fs::directory_iterator(folder / "velodyne"))
    drive.scans.push_back(entry.path());
  std::sort(drive.scans.begin(), drive.scans.end());
  drive.poses = io::readKittiPoses(folder / "poses.txt");
  std::ifstream times(folder / "times.txt");
  for (double time; times >> time;) drive.times.push_back(time);
  for (const std::string& line : io::readLines(folder / "odometry.txt")) {
    if (line.front() == '#') continue;
    std::istringstream numbers(line);
    std::array<double, 6> row{};
    for (double& number : row) numbers >> number;
    drive.motions.push_back(row);
  }
  EXPECT_EQ(drive.scans.size(), drive.poses.size());
  EXPECT_EQ(drive.scans.size(), drive.motions.size() + 1);
  return drive;
}

std::string bytesOf(const std::vector<std::uint32_t>& labels) {
  return {reinterpret_cast<const char*>(labels.data()), labels.size() * 4};
}

/// [R|t] row by row, as a line with fields separated by this character.
std::string matrixRow(const Pose& pose, char between) {
  std::string row;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) {
      char number[40];
      std::snprintf(number, sizeof number, "%.12g", pose(i, j));
      row += (row.empty() ? "" : std::string(1, between)) + number;
    }
  return row;
}

/// Roll, pitch and yaw of Rz(yaw) Ry(pitch) Rx(roll).
Eigen::Vector3d anglesOf(const Eigen::Matrix3d& R) {
  return {std::atan2(R(2, 1), R(2, 2)), -std::asin(R(2, 0)), std::atan2(R(1, 0), R(0, 0))};
}

std::string frameName(std::size_t i, const char* ending) {
  char name[32];
  std::snprintf(name, sizeof name, "%010zu%s", i, ending);
  return name;
}

}  // namespace

void relabel(const fs::path& sequence, const std::set<std::uint32_t>& poles) {
  constexpr std::uint32_t vegetation = 70, pole = 80, building = 50;
  for (const auto& entry : fs::directory_iterator(sequence / "labels")) {
    const std::string bytes = readText(entry.path());
    std::vector<std::uint32_t> labels;
    for (std::size_t i = 0; i < bytes.size(); i += 4) {
      const auto id = io::loadLittleEndian<std::uint32_t>(bytes.data() + i);
      const bool crown = (id & sim::kFoliageBit) != 0;
      const bool isPole = poles.count(id & ~sim::kFoliageBit) > 0;
      labels.push_back(crown ? vegetation : isPole ? pole : building);
    }
    writeText(entry.path(), bytesOf(labels));
  }
}

void writeSemanticKitti(const sim::SimulationOptions& options, const fs::path& sequence) {
  const Drive drive = simulated(options, sequence);
  std::set<std::uint32_t> poles;
  for (const auto& pole : io::readWorldPoles(sequence / "poles_gt.csv")) poles.insert(pole.id);
  relabel(sequence, poles);
  Pose T_cam_lidar = Pose::Identity();  // the camera looks along x; its z points forward
  T_cam_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  std::string poseRows;
  for (const Pose& pose : drive.poses)
    poseRows +=
        matrixRow(T_cam_lidar * drive.poses.front().inverse() * pose * T_cam_lidar.inverse(), ' ') +
        '\n';
  writeText(sequence / "poses.txt", poseRows);
  writeText(sequence / "calib.txt",
            "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr: " + matrixRow(T_cam_lidar, ' ') + "\n");
}

void writeKittiRaw(const sim::SimulationOptions& options, const fs::path& drive) {
  const TempFolder temporary;
  const Drive street = simulated(options, temporary.path());
  const double latitude = 49 * degree, radius = 6378137;
  const double metres = std::cos(latitude) * radius;
  const double north = metres * std::log(std::tan(M_PI / 4 + latitude / 2));
  std::string times;
  for (std::size_t i = 0; i < street.scans.size(); ++i) {
    const Pose& pose = street.poses[i];
    const Eigen::Vector3d at = pose.translation() - street.poses.front().translation();
    const Eigen::Vector3d angles = anglesOf(pose.linear());
    char row[512], time[64];
    std::snprintf(row, sizeof row, "%.13f %.13f %.9f %.15f %.15f %.15f",
                  (2 * std::atan(std::exp((north + at.y()) / metres)) - M_PI / 2) / degree,
                  8.4 + at.x() / metres / degree, 112 + at.z(), angles.x(), angles.y(), angles.z());
    std::string text = row;
    for (int field = 6; field < 30; ++field) text += " 0";
    writeText(drive / "oxts/data" / frameName(i, ".txt"), text + '\n');
    fs::create_directories(drive / "velodyne_points/data");
    fs::copy_file(street.scans[i], drive / "velodyne_points/data" / frameName(i, ".bin"));
    std::snprintf(time, sizeof time, "2011-09-26 13:02:%012.9f\n", street.times[i]);
    times += time;
  }
  writeText(drive / "velodyne_points/timestamps.txt", times);
  writeText(drive / "oxts/timestamps.txt", times);
  writeText(drive.parent_path() / "calib_imu_to_velo.txt", "R: 1 0 0 0 1 0 0 0 1\nT: 0 0 0\n");
}

void writeMulran(const sim::SimulationOptions& options, const fs::path& sequence,
                 std::uint64_t startNanoseconds) {
  const TempFolder temporary;
  const Drive street = simulated(options, temporary.path());
  const Pose turned(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()));
  std::string rows;
  for (std::size_t i = 0; i < street.scans.size(); ++i) {
    const std::string stamp =
        std::to_string(startNanoseconds + static_cast<std::uint64_t>(street.times[i] * 1e9));
    const io::Cloud cloud = io::readKittiBin(street.scans[i]);
    Points points;
    for (std::size_t k = 0; k < cloud.x.size(); ++k)
      points.push_back({-cloud.x[k], -cloud.y[k], cloud.z[k], cloud.intensity[k]});
    writeBin(sequence / "Ouster" / (stamp + ".bin"), points);
    Pose base = street.poses[i] * turned * io::mulranBaseLidar().inverse();
    base.translation() += Eigen::Vector3d(355000, 4025000, 0);
    rows += stamp + ',' + matrixRow(base, ',') + '\n';
  }
  writeText(sequence / "global_pose.csv", rows);
}

void writeNclt(const sim::SimulationOptions& options, const fs::path& session,
               std::uint64_t startMicroseconds, const fs::path& truth) {
  const TempFolder temporary;
  const Drive street = simulated(options, temporary.path());
  Eigen::Matrix3d mapAxes;  // from east, north, up to north, east, down
  mapAxes << 0, 1, 0, 1, 0, 0, 0, 0, -1;
  const Eigen::Matrix3d bodyAxes = Eigen::Vector3d(1, -1, -1).asDiagonal();
  std::string truthRows, steps, covariances;
  for (std::size_t i = 0; i < street.scans.size(); ++i) {
    const auto utime = startMicroseconds + static_cast<std::uint64_t>(street.times[i] * 1e6);
    std::string points;
    const io::Cloud cloud = io::readKittiBin(street.scans[i]);
    for (std::size_t k = 0; k < cloud.x.size(); ++k)
      points += testing_nclt::point(cloud.x[k], -cloud.y[k], -cloud.z[k]);
    writeText(session / "velodyne_sync" / (std::to_string(utime) + ".bin"), points);
    const Eigen::Vector3d at = mapAxes * street.poses[i].translation();
    const Eigen::Vector3d angles = anglesOf(mapAxes * street.poses[i].linear() * bodyAxes);
    truthRows +=
        testing_nclt::poseRow(utime, at.x(), at.y(), at.z(), angles.x(), angles.y(), angles.z());
    const std::array<double, 6> motion =
        i == 0 ? std::array<double, 6>{0, 0, 0, 0.01, 0.01, 0.001} : street.motions[i - 1];
    steps += testing_nclt::poseRow(utime, motion[0], -motion[1], 0, 0, 0, -motion[2]);
    Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
    covariance.diagonal() << motion[3] * motion[3], motion[4] * motion[4], 0, 0, 0,
        motion[5] * motion[5];
    covariances += testing_nclt::covarianceRow(utime, covariance);
  }
  writeText(session / ("groundtruth_" + session.filename().string() + ".csv"), truthRows);
  writeText(session / "odometry_mu.csv", steps);
  writeText(session / "odometry_cov.csv", covariances);
  std::vector<double> poles;
  for (const auto& pole : io::readWorldPoles(temporary / "poles_gt.csv"))
    poles.insert(poles.end(), {pole.x, pole.y, 1});
  const std::string shape = "(" + std::to_string(poles.size() / 3) + ", 3)";
  const std::string bytes(reinterpret_cast<const char*>(poles.data()), 8 * poles.size());
  writeText(truth,
            io::test::zip({{"poleparams.npy",
                            io::test::npy(io::test::dictionary("<f8", "False", shape), bytes)}}));
}

}  // namespace testing_apps
