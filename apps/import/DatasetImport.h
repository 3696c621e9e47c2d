#pragma once
/// \file DatasetImport.h
/// \brief From the datasets' own files to a rawlog with the truth beside it.

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <polemcl/core/sensor/SensorOptions.h>
#include "io/dataset/Rosbag2.h"

namespace polemcl::apps {

enum class Dataset { folder, kittiOdometry, kittiRaw, nclt, mulran, pcd, rosbag2 };

/// \brief What to import, and how.
struct ImportOptions {
  Dataset dataset = Dataset::folder;
  std::filesystem::path input;   ///< folder of the dataset; a bag may be one file
  std::filesystem::path output;  ///< `S.rawlog`; the truth goes to `S.tum`
  /// Folder of calib_imu_to_velo.txt, KITTI raw only; without it the folder that holds `input`.
  std::optional<std::filesystem::path> calibration;
  /// TUM file of poses that replace those of the dataset; see io::takeTumPoses().
  std::optional<std::filesystem::path> poses;
  bool posesOfSensor = false;  ///< they are of the sensor, not of the robot
  /// TUM file of an odometry that replaces that of the dataset; see io::takeTumMotions().
  std::optional<std::filesystem::path> odometry;
  bool odometryOfSensor = false;  ///< it is of the sensor, not of the robot
  /// Clouds inside the rawlog, not by absolute path; PCD, NCLT and bags always are.
  bool embed = false;
  bool skipDamaged = false;  ///< PCD files that cannot be read are dropped, as empty scans are
  std::size_t every = 1;     ///< N: take scans K, K+N, …; at least 1
  std::size_t offset = 0;    ///< K, from 0, less than the number of scans
  /// K: odometry is the true motion with noise of σ = K·|component|, instead of the folder's.
  std::optional<double> odometryNoise;
  std::uint64_t seed = 0;  ///< of that noise
  /// Errors of that odometry that stay and that its covariance does not know: a share of the
  /// distance, and rad per metre.
  double odometryScale = 0, odometryYaw = 0;
  /// The sensor in the robot frame: stored in every observation, turns sensor poses into robot
  /// poses. Without it that of the bag, else the dataset's own, see datasetSensorPose().
  std::optional<Eigen::Isometry3d> T_robot_sensor;
  /// When the points of a scan were measured; stored in the comment of the rawlog. Without it,
  /// `scan_timing.ini` in the folder of the dataset, else that of the bag, else datasetTiming().
  std::optional<ScanTiming> timing;
  io::RosbagTopics topics;  ///< of a bag
  /// \throws Error naming the option.
  void validate() const;
};

/// \brief Default pose of the frame of the clouds on the robot: NCLT's body, turned
/// upright; MulRan's Ouster on the vehicle; else identity.
Eigen::Isometry3d datasetSensorPose(Dataset dataset);

/// \brief Measuring times of the scans as a dataset publishes them; `automatic`: not known.
ScanTiming datasetTiming(Dataset dataset);

/// \brief What an import did.
struct ImportReport {
  std::size_t scans = 0;         ///< written
  std::size_t skipped = 0;       ///< left out by `every` and `offset`
  std::size_t emptyScans = 0;    ///< dropped: no valid point; their motion went into the next one's
  std::size_t damagedScans = 0;  ///< of these, by ImportOptions::skipDamaged; each has a note
  std::size_t points = 0;        ///< valid ones, counted when embedded only
  std::size_t invalidPoints = 0;  ///< dropped: NaN, infinite or at the sensor; embedded only
  bool embedded = false;          ///< clouds are inside the rawlog
  bool hasTruth = false;          ///< `S.tum` was written
  bool hasMotion = false;         ///< actions carry odometry
  std::vector<std::string> notes;
};

/// \brief Imports a dataset.
///
/// The rawlog holds pairs: an action with one `CActionRobotMovement2D` (`emScan2DMatching`,
/// `CPosePDFGaussian`), the first identity, and a frame with one `CObservationPointCloud`, label
/// `lidar`. Without odometry and noise the later actions are empty. Motions across scans that were
/// left out are composed, covariances too; noise is put on the true motion between the scans
/// written. Both files appear once both are complete; until then older ones stay as they are.
/// One cloud is in memory at a time.
/// Positions from satellites become single `CObservationGPS`, each before the first scan later than
/// it; see gnssObservation().
/// \param progress Called with scans done and in all, before that with MB where a large file is
///        searched for scans; may be empty.
/// \throws Error when the dataset cannot be read (see the readers in io/), nothing usable is left,
///         noise is asked for without poses, or the output cannot be written.
ImportReport importDataset(const ImportOptions& options,
                           const std::function<void(std::size_t, std::size_t)>& progress = {});

/// \brief Parses `x y z yaw_deg pitch_deg roll_deg` (m, degrees; rotation Rz·Ry·Rx).
/// \throws Error unless it is six finite numbers.
Eigen::Isometry3d parseSensorPose(const std::string& text);

}  // namespace polemcl::apps
