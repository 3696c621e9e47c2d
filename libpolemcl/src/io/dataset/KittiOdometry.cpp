#include "io/dataset/KittiOdometry.h"

#include "io/data/Trajectory.h"
#include "io/dataset/ScanFiles.h"
#include "io/file/TextFile.h"

namespace polemcl::io {

namespace fs = std::filesystem;

namespace {

/// Pose of the LiDAR in the frame of camera 0, from a line "Tr: twelve numbers".
Eigen::Isometry3d readLidarInCamera(const fs::path& file) {
  const auto lines = readLines(file);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string_view line = lines[i];
    const auto colon = line.find(':');
    if (colon == std::string_view::npos) continue;
    const std::string_view key = trimmed(line.substr(0, colon));
    if (key != "Tr" && key != "Tr_velo_to_cam") continue;
    const auto values = parseNumbers(line.substr(colon + 1), file, i + 1);
    if (values.size() != 12) {
      throw Error(at(file, i + 1) + std::to_string(values.size()) + " numbers after " +
                  std::string(key) + ", 12 expected: row-major 3x4, LiDAR to camera 0");
    }
    return poseFromRows(values, at(file, i + 1));
  }
  throw Error(file.string() + ": no line Tr: or Tr_velo_to_cam: (LiDAR to camera 0)");
}

fs::path findPoses(const fs::path& sequence) {
  if (isThere(sequence / "poses.txt")) return sequence / "poses.txt";
  const fs::path full = folderNamed(sequence);
  const fs::path beside =
      full.parent_path().parent_path() / "poses" / (full.filename().string() + ".txt");
  return isThere(beside) ? beside : fs::path();
}

/// Throws unless the file has a row for the highest scan number.
void requireRow(const fs::path& file, const std::string& what, std::size_t rows,
                const std::vector<fs::path>& scans, std::uint64_t highest) {
  if (highest < rows) return;
  throw Error(file.string() + ": " + std::to_string(rows) + " " + what + " for " +
              std::to_string(scans.size()) + " scans up to " + scans.back().filename().string() +
              "; row N (from 0) belongs to scan N");
}

}  // namespace

ScanFolder readKittiOdometry(const fs::path& sequence, const Eigen::Isometry3d& T_robot_sensor) {
  if (!fs::is_directory(sequence / "velodyne"))
    throw Error(sequence.string() +
                ": no folder velodyne in it; name the folder of one sequence, such as "
                "dataset/sequences/00");
  const auto files = listFiles(sequence / "velodyne", ".bin");
  const auto numbers = fileNumbers(files);
  ScanFolder result;
  checkScanSizes(files, result.notes);

  const fs::path timesFile = sequence / "times.txt";
  const auto times = readNumberRows(timesFile, 1, "one time a line, s");
  requireRow(timesFile, "times", times.size(), files, numbers.back());
  requireIncreasing(timesFile, times);

  const fs::path posesFile = findPoses(sequence);
  std::vector<Eigen::Isometry3d> T_cam0_cam;
  Eigen::Isometry3d T_cam_lidar = Eigen::Isometry3d::Identity();
  if (posesFile.empty()) {
    result.notes.push_back("no poses: neither poses.txt nor ../../poses/NN.txt is there");
  } else {
    T_cam_lidar = readLidarInCamera(sequence / "calib.txt");
    T_cam0_cam = readKittiPoses(posesFile);
    requireRow(posesFile, "poses", T_cam0_cam.size(), files, numbers.back());
  }

  const Eigen::Isometry3d T_lidar_robot = T_robot_sensor.inverse();
  for (std::size_t i = 0; i < files.size(); ++i) {
    result.scans.push_back({files[i], 0, times[numbers[i]].values[0]});
    if (!T_cam0_cam.empty()) {
      result.scans.back().T_map_robot =
          T_cam_lidar.inverse() * T_cam0_cam[numbers[i]] * T_cam_lidar * T_lidar_robot;
    }
  }
  if (times.size() > files.size()) {
    result.notes.push_back(std::to_string(files.size()) + " scans of a sequence of " +
                           std::to_string(times.size()));
  }
  return result;
}

}  // namespace polemcl::io
