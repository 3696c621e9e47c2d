#pragma once
/// \file ScanFolder.h
/// \brief Folders of scans with times, poses and odometry: the plain `folder` layout.

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/data/Cloud.h"
#include "io/data/PlanarMotion.h"

namespace polemcl::io {

/// \brief One scan of a dataset. The cloud stays on disk.
struct ScanEntry {
  std::filesystem::path cloud;                   ///< absolute; see ScanFolder::read
  std::uint64_t offset = 0;                      ///< where it begins, in files of many scans, bytes
  double time = 0;                               ///< s; strictly increasing from entry to entry
  std::optional<Eigen::Isometry3d> T_map_robot;  ///< all entries of a folder have it, or none
  /// Since the entry before, in the robot frame of that entry. Never in the first entry; all
  /// others have it, or none.
  std::optional<PlanarMotion> motion;
};

struct ScanFolder {
  std::vector<ScanEntry> scans;    ///< at least one
  std::vector<std::string> notes;  ///< what the user should know: gaps, empty scans, unused rows
  /// Reads the cloud of an entry, in the sensor frame. Without it `cloud` is a KITTI `.bin`, which
  /// rawlogs can refer to by its path.
  std::function<Cloud(const ScanEntry&)> read;
  bool nominalTimes = false;  ///< the dataset tells no times: the entries have made up ones
};

/// \brief Reads the plain layout:
/// `velodyne/*.bin` in name order · `times.txt`, s, one a scan · `poses.txt`, optional, the sensor
/// in the map (see readKittiPoses()) · `odometry.txt` or `odom.txt`, optional, a line per scan
/// after the first: `dx dy dyaw sx sy syaw`, motion in the previous *robot* frame (m, m, rad) and
/// its standard deviations. `#` starts a comment.
///
/// Rows beyond the last scan are left out with a note if the scans are numbered 0, 1, 2, …;
/// otherwise nobody knows which row belongs to which scan.
/// \param T_robot_sensor The sensor in the robot frame: turns sensor poses into robot poses.
/// \throws Error naming the file, with both counts where they disagree: no scan, no usable
///         (non-empty) scan, fewer times, poses or motions than scans, times not increasing, a
///         scan cut short, negative deviations, odometry.txt and odom.txt both there, unpadded
///         numbers as names (10.bin sorts before 2.bin).
ScanFolder readScanFolder(const std::filesystem::path& folder,
                          const Eigen::Isometry3d& T_robot_sensor);

/// \brief Reads a folder of `*.pcd`, in name order, with the same text files beside them; all are
/// optional here: without `times.txt` the scans are 0.1 s apart, with a note. The scans are not
/// looked into. \throws Error as readScanFolder().
ScanFolder readPcdFolder(const std::filesystem::path& folder,
                         const Eigen::Isometry3d& T_robot_sensor);

}  // namespace polemcl::io
