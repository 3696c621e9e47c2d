#pragma once
/// \file Trajectory.h
/// \brief Trajectories as files: TUM (time and pose), KITTI (twelve numbers a pose).

#include <Eigen/Geometry>
#include <filesystem>
#include <vector>

#include "core/evaluation/TrajectoryEvaluation.h"

namespace polemcl::io {

struct StampedPose3D {
  double time = 0;                                         ///< s
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< in the map frame, m
};

/// \brief x, y and yaw of a pose. Yaw is the direction of the x axis seen from above.
Pose2D planar(const Eigen::Isometry3d& pose);
std::vector<StampedPose2D> planar(const std::vector<StampedPose3D>& trajectory);
/// \brief The planar pose at z = 0, upright.
Eigen::Isometry3d spatial(const Pose2D& pose);

/// \brief Rows `time x y z qx qy qz qw`; s, m. `#` starts a comment. Plain or gzip.
/// Quaternions may be off unit length by rounding (1 %) and are normalised.
/// \throws Error naming file and line: wrong columns, not a number, no unit quaternion, times not
///         increasing; and when there is no pose at all.
std::vector<StampedPose3D> readTum(const std::filesystem::path& file);
/// \brief The same, planar: no more than 100 bytes a pose are in memory at any time.
std::vector<StampedPose2D> readPlanarTum(const std::filesystem::path& file);

/// \brief One row of a TUM file, with its line end: 9 decimals, z = 0.
/// \throws Error when a value is not finite.
std::string tumRow(const StampedPose2D& pose);

/// \brief Writes a TUM file with 9 decimals, atomically. Planar poses get z = 0.
/// \throws Error when it cannot be written, or a value is not finite.
void writeTum(const std::filesystem::path& file, const std::vector<StampedPose2D>& trajectory);
void writeTum(const std::filesystem::path& file, const std::vector<StampedPose3D>& trajectory);

/// \brief Poses of twelve numbers a line, row-major 3×4, as KITTI odometry and the plain folder
/// layout have them. `#` starts a comment. Plain or gzip.
/// Rotations may be off by rounding (1e-3 in any element of RᵀR) and become the nearest ones.
/// \throws Error naming file and line: wrong columns, not a number, no rotation; and when there is
///         no pose at all.
std::vector<Eigen::Isometry3d> readKittiPoses(const std::filesystem::path& file);

/// \brief Twelve numbers, row-major 3×4, as a pose. \param where Start of the message.
/// \throws Error when the rotation is none.
Eigen::Isometry3d poseFromRows(const std::vector<double>& values, const std::string& where);

}  // namespace polemcl::io
