#pragma once
/// \file PinholeCamera.h
/// \brief The image of a depth camera: what it needs to sort points into rows of pixels.

#include <Eigen/Core>

#include <polemcl/export.h>

namespace polemcl {

/// \brief Pinhole intrinsics and attitude of a depth camera without distortion.
///
/// Camera axes: x ahead, y left, z up, as `CObservation3DRangeScan` has them. The pixel (row r,
/// column c), counted from the top left, looks along (1, (cx - c) / fx, (cy - r) / fy).
struct POLEMCL_EXPORT PinholeCamera {
  int width = 0, height = 0;  ///< px
  double fx = 0, fy = 0;      ///< focal lengths, px
  double cx = 0, cy = 0;      ///< principal point, px from the middle of the top left pixel
  /// Attitude of the camera in the frame the points are given in (z up).
  Eigen::Matrix3d R_lidar_camera = Eigen::Matrix3d::Identity();

  /// \throws Error when a focal length is not positive, the principal point not finite, or the
  /// image smaller than 2 x 2 or larger than 16384 x 16384 pixels.
  void validate() const;
  bool operator==(const PinholeCamera& other) const;
};

}  // namespace polemcl
