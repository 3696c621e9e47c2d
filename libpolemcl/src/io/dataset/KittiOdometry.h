#pragma once
/// \file KittiOdometry.h
/// \brief Sequences of the KITTI odometry benchmark (and SemanticKITTI).

#include "io/dataset/ScanFolder.h"

namespace polemcl::io {

/// \brief Reads `sequences/NN`: `velodyne/*.bin`, `times.txt`, `calib.txt`, and poses from
/// `poses.txt` in it (SemanticKITTI), else from `../../poses/NN.txt`; without either, no poses.
///
/// Scan 000012.bin has row 12 (from 0) of times and poses, whichever scans are there. Poses are of
/// camera 0; with `Tr` (or `Tr_velo_to_cam`) of calib.txt they become those of the LiDAR in the
/// LiDAR frame of scan 0: T_map_lidar = Tr⁻¹ · T_cam · Tr. No odometry.
/// \param T_robot_sensor The LiDAR in the robot frame: turns LiDAR poses into robot poses.
/// \throws Error naming file and line: as readScanFolder(), scans without a number as name, no
///         calib.txt or no `Tr` in it.
ScanFolder readKittiOdometry(const std::filesystem::path& sequence,
                             const Eigen::Isometry3d& T_robot_sensor);

}  // namespace polemcl::io
