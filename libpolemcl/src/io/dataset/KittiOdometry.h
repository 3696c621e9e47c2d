#pragma once
/// \file KittiOdometry.h
/// \brief Sequences of the KITTI odometry benchmark (and SemanticKITTI).

#include "io/dataset/ScanFolder.h"

namespace polemcl::io {

/// \brief Reads `sequences/NN`: `velodyne/*.bin`, `times.txt`, `calib.txt` and the poses. Poses
/// come from `poses.txt` in the same folder (SemanticKITTI), otherwise from `../../poses/NN.txt`.
/// Without either file there are no poses.
///
/// Scan 000012.bin belongs to row 12 (from 0) of times and poses, even if other scans are missing.
/// The pose files describe camera 0. With `Tr` (or `Tr_velo_to_cam`) of calib.txt they become poses
/// of the LiDAR, in the LiDAR frame of scan 0: T_map_lidar = Tr⁻¹ · T_cam · Tr. There is no
/// odometry.
/// \param T_robot_sensor Pose of the LiDAR in the robot frame; converts LiDAR poses to robot poses.
/// \throws Error with file and line: as readScanFolder(), scan names that are not numbers,
///         calib.txt missing or without `Tr`.
ScanFolder readKittiOdometry(const std::filesystem::path& sequence,
                             const Eigen::Isometry3d& T_robot_sensor);

}  // namespace polemcl::io
