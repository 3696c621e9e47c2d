#pragma once
/// \file Trajectory.h
/// \brief Trajectory files: TUM (time and pose) and KITTI (twelve numbers per pose).

#include <Eigen/Geometry>
#include <filesystem>
#include <vector>

#include "core/evaluation/TrajectoryEvaluation.h"

namespace polemcl::io {

class AtomicFile;

struct StampedPose3D {
  double time = 0;                                         ///< s
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< in the map frame, m
};

/// \brief x, y and yaw of a pose. Yaw is the direction of the x axis seen from above.
Pose2D planar(const Eigen::Isometry3d& pose);
std::vector<StampedPose2D> planar(const std::vector<StampedPose3D>& trajectory);
/// \brief The 3D pose with z = 0, roll = 0 and pitch = 0.
Eigen::Isometry3d spatial(const Pose2D& pose);

/// \brief The pose with the attitude Rz(yaw)·Ry(pitch)·Rx(roll), rad.
Eigen::Isometry3d poseFromAngles(const Eigen::Vector3d& position, double roll, double pitch,
                                 double yaw);

/// \brief Reads rows `time x y z qx qy qz qw`; s, m. `#` starts a comment. Plain text or gzip.
/// Quaternions whose length differs from 1 by at most 1 % (rounding) are normalised.
/// \throws Error with file and line: wrong number of columns, not a number, not a unit quaternion,
///         times not increasing. Also when the file holds no pose.
std::vector<StampedPose3D> readTum(const std::filesystem::path& file);
/// \brief Planar version of readTum(). It needs at most 100 bytes of memory per pose.
std::vector<StampedPose2D> readPlanarTum(const std::filesystem::path& file);

/// \brief One row of a TUM file, with its line end: 9 decimals, z = 0.
/// \throws Error when a value is not finite.
std::string tumRow(const StampedPose2D& pose);

/// \brief Writes a TUM file with 9 decimals, atomically. Planar poses get z = 0.
/// \throws Error when it cannot be written, or a value is not finite.
void writeTum(const std::filesystem::path& file, const std::vector<StampedPose2D>& trajectory);
void writeTum(const std::filesystem::path& file, const std::vector<StampedPose3D>& trajectory);
/// \brief The same with a file that was begun before, to know early that it can be written.
void writeTum(AtomicFile& output, const std::vector<StampedPose3D>& trajectory);

/// \brief Reads poses as twelve numbers per line (row-major 3×4), as in KITTI odometry and in the
/// plain folder layout. `#` starts a comment. Plain text or gzip.
/// Rotations with rounding errors (up to 1e-3 in any element of RᵀR) are replaced by the nearest
/// rotation.
/// \throws Error with file and line: wrong number of columns, not a number, not a rotation. Also
///         when the file holds no pose.
std::vector<Eigen::Isometry3d> readKittiPoses(const std::filesystem::path& file);

/// \brief Pose from twelve numbers (row-major 3×4). \param where Prefix of the error message.
/// \throws Error when the 3×3 part is not a rotation.
Eigen::Isometry3d poseFromRows(const std::vector<double>& values, const std::string& where);

}  // namespace polemcl::io
