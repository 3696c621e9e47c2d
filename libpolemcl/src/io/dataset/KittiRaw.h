#pragma once
/// \file KittiRaw.h
/// \brief Drives of KITTI raw (synchronised and rectified).

#include "io/dataset/ScanFolder.h"

namespace polemcl::io {

/// \brief One GPS/IMU measurement, the first six of the thirty numbers of an oxts file.
struct OxtsPose {
  double latitude = 0, longitude = 0;   ///< deg
  double altitude = 0;                  ///< m
  double roll = 0, pitch = 0, yaw = 0;  ///< rad; yaw 0 = east, counter-clockwise
};

/// \brief The IMU in a plane with x east, y north, z up, by the devkit's Mercator projection:
/// x = s·R·lon, y = s·R·ln tan(π/4 + lat/2), R = 6378137 m; attitude Rz(yaw)·Ry(pitch)·Rx(roll).
/// \param scale s = cos(latitude of the first measurement).
Eigen::Isometry3d mercatorPose(const OxtsPose& measurement, double scale);

/// \brief "2011-09-26 13:02:25.964389445" as seconds since 1970, taken as UTC.
/// \throws Error starting with `where` when the text is no such time.
double parseKittiTime(std::string_view text, const std::string& where);

/// \brief Reads a drive: `velodyne_points/data/*.bin`, `velodyne_points/timestamps.txt`,
/// `oxts/data/*.txt`, `oxts/timestamps.txt`; `calib_imu_to_velo.txt` in the folder of the date.
///
/// Frames are paired by file number; scans without a GPS/IMU frame are left out, and gaps noted.
/// A line of timestamps belongs to the frame of its number (from 0); where frames are missing, a
/// list without lines for them is understood too. A scan has the time of timestamps.txt (the LiDAR
/// looks ahead) and the pose of its oxts frame.
///
/// Map frame: that of the first oxts frame, levelled: origin at the IMU, x along its heading, z up.
/// T_map_lidar = T_map_imu · T_velo_imu⁻¹. No odometry.
/// \param calibration Folder of calib_imu_to_velo.txt.
/// \param T_robot_sensor The LiDAR in the robot frame: turns LiDAR poses into robot poses.
/// \throws Error naming file and line: as readScanFolder(), no pair of frames, malformed times,
///         oxts files or calibration.
ScanFolder readKittiRaw(const std::filesystem::path& drive,
                        const std::filesystem::path& calibration,
                        const Eigen::Isometry3d& T_robot_sensor);

}  // namespace polemcl::io
