#pragma once
/// \file KittiRaw.h
/// \brief Drives of KITTI raw (synchronised and rectified).

#include "io/dataset/ScanFolder.h"

namespace polemcl::io {

/// \brief One GPS/IMU measurement: numbers 1 to 6 and 24 of the thirty in an oxts file.
struct OxtsPose {
  double latitude = 0, longitude = 0;   ///< deg
  double altitude = 0;                  ///< m
  double roll = 0, pitch = 0, yaw = 0;  ///< rad; yaw 0 = east, counter-clockwise
  double accuracy = 0;                  ///< of north and east, m
};

/// \brief Pose of the IMU in a plane with x east, y north, z up. Mercator projection of the KITTI
/// devkit: x = s·R·lon, y = s·R·ln tan(π/4 + lat/2), R = 6378137 m. Attitude:
/// Rz(yaw)·Ry(pitch)·Rx(roll).
/// \param scale s = cos(latitude of the first measurement).
Eigen::Isometry3d mercatorPose(const OxtsPose& measurement, double scale);

/// \brief Parses "2011-09-26 13:02:25.964389445" to seconds since 1970, read as UTC.
/// \throws Error with the prefix `where` when the text is not such a time.
double parseKittiTime(std::string_view text, const std::string& where);

/// \brief Reads a drive: `velodyne_points/data/*.bin`, `velodyne_points/timestamps.txt`,
/// `oxts/data/*.txt`, `oxts/timestamps.txt`. `calib_imu_to_velo.txt` lies in the folder of the
/// date.
///
/// Scans and GPS/IMU frames are paired by file number. Scans without a GPS/IMU frame are dropped;
/// gaps are reported in the notes. Line N of a timestamps file (from 0) belongs to frame N. A file
/// with exactly one line per existing frame is accepted too. A scan has the time from
/// timestamps.txt (when the LiDAR faces forward) and the pose of its oxts frame.
///
/// Map frame: the first oxts frame, levelled. Origin at the IMU, x along its heading, z up.
/// T_map_lidar = T_map_imu · T_velo_imu⁻¹. There is no odometry. Each oxts frame of a scan is also
/// a fix, with the IMU as antenna.
/// \param calibration Folder of calib_imu_to_velo.txt.
/// \param T_robot_sensor Pose of the LiDAR in the robot frame; converts LiDAR poses to robot poses.
/// \throws Error with file and line: as readScanFolder(), no scan with an oxts frame, malformed
///         times, oxts files or calibration.
ScanFolder readKittiRaw(const std::filesystem::path& drive,
                        const std::filesystem::path& calibration,
                        const Eigen::Isometry3d& T_robot_sensor);

}  // namespace polemcl::io
