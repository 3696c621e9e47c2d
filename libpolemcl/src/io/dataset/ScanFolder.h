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

#include <polemcl/core/sensor/SensorOptions.h>
#include <polemcl/io/data/Cloud.h>
#include "core/common/GnssFix.h"
#include "io/data/PlanarMotion.h"

namespace polemcl::io {

/// \brief One scan of a dataset. The cloud stays on disk.
struct ScanEntry {
  std::filesystem::path cloud;  ///< absolute path; see ScanFolder::read
  std::uint64_t offset = 0;  ///< where the scan is in a file with many scans: bytes; in a bag, id
  double time = 0;           ///< s; strictly increasing from entry to entry
  std::optional<Eigen::Isometry3d> T_map_robot =
      {};  ///< set in all entries of a folder or in no entry
  /// Motion since the previous entry, in the robot frame of that entry. Never set in the first
  /// entry; set in all others or in no entry.
  std::optional<PoseWithCovariance> motion = {};
  std::size_t number = 0;  ///< set by pole-import: 0-based, before entries are left out
};

struct ScanFolder {
  std::vector<ScanEntry> scans;    ///< at least one
  std::vector<std::string> notes;  ///< messages for the user: gaps, empty scans, unused rows
  /// Reads the cloud of an entry, in the sensor frame. If it is empty, `cloud` is a KITTI `.bin`,
  /// which rawlogs can reference by its path.
  std::function<Cloud(const ScanEntry&)> read;
  bool nominalTimes = false;  ///< the dataset has no times: the entries have invented ones
  /// Pose of the sensor in the robot frame, if the recording states it.
  std::optional<Eigen::Isometry3d> T_robot_sensor = {};
  ScanTiming timing = {};           ///< when points were measured, if the recording states it
  std::vector<GnssFix> fixes = {};  ///< from satellites, in order of time; often none
};

/// \brief Reads the plain layout:
/// - `velodyne/*.bin`, sorted by name
/// - `times.txt`: one time per scan, s
/// - `poses.txt` (optional): poses of the sensor in the map, see readKittiPoses()
/// - `odometry.txt` (optional): one line per scan after the first, `dx dy dyaw sx sy syaw`: motion
///   in the previous *robot* frame (m, m, rad) and its standard deviations
///
/// `#` starts a comment. Rows beyond the last scan are ignored with a note if the scans are
/// numbered 0, 1, 2, …. With any other numbering they are an error, because the assignment of rows
/// to scans is ambiguous.
/// \param T_robot_sensor Pose of the sensor in the robot frame; converts sensor poses to robot
///        poses.
/// \throws Error with the file, and with both counts where they disagree: no scan, no usable
///         (non-empty) scan, fewer times, poses or motions than scans, times not increasing, a
///         truncated scan, negative standard deviations, names with unpadded numbers (10.bin sorts
///         before 2.bin).
ScanFolder readScanFolder(const std::filesystem::path& folder,
                          const Eigen::Isometry3d& T_robot_sensor);

/// \brief Reads a folder of `*.pcd`, sorted by name, with the same text files beside them. All text
/// files are optional: without `times.txt` the scans are 0.1 s apart, with a note. The scans
/// themselves are not read; empty files are noted. \throws Error as readScanFolder().
ScanFolder readPcdFolder(const std::filesystem::path& folder,
                         const Eigen::Isometry3d& T_robot_sensor);

/// \brief Sigma of a fix of which none is stated, m. Assumed: a single receiver under open sky.
constexpr double kAssumedFixSigma = 2.5;

/// \brief Adds a fix. One that is not finite or not on the globe is left out.
void takeFix(const GnssFix& fix, ScanFolder& folder);

/// \brief Sorts the fixes by time, and adds a note with their number and source.
void finishFixes(const std::string& source, ScanFolder& folder);

}  // namespace polemcl::io
