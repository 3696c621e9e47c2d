#pragma once
/// \file Mulran.h
/// \brief Sequences of MulRan, as its owners publish them.

#include "io/dataset/ScanFolder.h"

namespace polemcl::io {

/// \brief The Ouster on MulRan's vehicle frame (x ahead, y left, z up), from its calibration file
/// calib_base2ouster.txt: 1.7042 −0.021 1.8047 m, roll, pitch, yaw 0.0001° 0.0003° 179.6654°.
Eigen::Isometry3d mulranBaseLidar();

/// \brief Reads a sequence: `Ouster/*.bin` (float32 x y z intensity, LiDAR frame; named by their
/// times in ns), `global_pose.csv` (time in ns, the vehicle in UTM as row-major 3×4), optional,
/// `ouster_front_stamp.csv` (the times of all scans), optional. The first and the last may lie in
/// `sensor_data/`; the truth in the folder.
///
/// Poses are interpolated at the times of the scans; scans at times without one are left out, with
/// a note. Map frame: UTM, x east, y north, z up. No odometry.
/// \param T_robot_lidar The LiDAR in the robot frame; mulranBaseLidar() makes the robot frame the
///        vehicle's.
/// \throws Error naming the file (and line): as readScanFolder(), rows too short, no rotation,
///         times of poses and scans that do not overlap.
ScanFolder readMulran(const std::filesystem::path& sequence,
                      const Eigen::Isometry3d& T_robot_lidar);

}  // namespace polemcl::io
