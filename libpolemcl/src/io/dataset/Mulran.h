#pragma once
/// \file Mulran.h
/// \brief Sequences of MulRan in their published form.

#include "io/dataset/ScanFolder.h"

namespace polemcl::io {

/// \brief Pose of the Ouster in MulRan's vehicle frame (x forward, y left, z up). From the
/// calibration file calib_base2ouster.txt: 1.7042 −0.021 1.8047 m; roll, pitch, yaw 0.0001° 0.0003°
/// 179.6654°.
Eigen::Isometry3d mulranBaseLidar();

/// \brief Reads a sequence. `Ouster/*.bin`: float32 x y z intensity in the LiDAR frame, file names
/// are times in ns. `global_pose.csv` (optional): time in ns, pose of the vehicle in UTM as
/// row-major 3×4. `ouster_front_stamp.csv` (optional): the times of all scans. Each of them may
/// also lie in `sensor_data/`. So may `gps.csv` (optional): time in ns, latitude, longitude (deg),
/// altitude, 3×3 covariance (m², east and north first), one row a position from satellites; rows
/// without a covariance get the assumed sigma, and the antenna counts as at the robot.
///
/// Poses are interpolated at the times of the scans. Scans without a pose are dropped, with a note.
/// Map frame: UTM, x east, y north, z up. There is no odometry.
/// \param T_robot_lidar Pose of the LiDAR in the robot frame; with mulranBaseLidar() the robot
///        frame is the vehicle frame.
/// \throws Error with the file (and line): as readScanFolder(), rows too short, not a rotation,
///         times of poses and scans that do not overlap.
ScanFolder readMulran(const std::filesystem::path& sequence,
                      const Eigen::Isometry3d& T_robot_lidar);

}  // namespace polemcl::io
