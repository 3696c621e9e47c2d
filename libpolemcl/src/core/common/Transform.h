#pragma once
/// \file Transform.h
/// \brief Detections moved by a planar pose, with their covariances.

#include <Eigen/Geometry>
#include <vector>

#include <polemcl/core/common/Types.h>

namespace polemcl {

inline Eigen::Matrix2d rotationOf(double yaw) {
  return Eigen::Rotation2Dd(yaw).toRotationMatrix();
}

/// \brief Centre of a pole in the plane, m; also of a record or an observation with a `pole`.
template <class Pole>
auto centreOf(const Pole& pole) -> decltype(pole.x, Eigen::Vector2d()) {
  return {pole.x, pole.y};
}
template <class Record>
auto centreOf(const Record& record) -> decltype(centreOf(record.pole)) {
  return centreOf(record.pole);
}

/// \brief centreOf() each.
template <class Pole>
std::vector<Eigen::Vector2d> centresOf(const std::vector<Pole>& poles) {
  std::vector<Eigen::Vector2d> centres;
  centres.reserve(poles.size());
  for (const Pole& pole : poles) centres.push_back(centreOf(pole));
  return centres;
}

/// \brief The mean of a matrix and its transpose: symmetric to the last bit.
template <int size>
Eigen::Matrix<double, size, size> symmetrized(const Eigen::Matrix<double, size, size>& matrix) {
  return (matrix + matrix.transpose()) / 2;
}

/// \brief Centre and covariance of a detection, with the vector that a derivative by yaw needs.
struct MovedCentre {
  Eigen::Vector2d arm;         ///< from the base to the centre, axes of the base's parent frame, m
  Eigen::Vector2d centre;      ///< in the base's parent frame, m
  Eigen::Matrix2d covariance;  ///< turned only: the uncertainty of the base is not in it, m²
};

/// \brief Centre and covariance of a detection, expressed in the parent frame of `base`.
/// \param pole In the frame of `base`.
MovedCentre movedCentre(const Pose2D& base, const PoleDetection& pole);

/// \brief A detection expressed in the parent frame of `base`: the centre is moved, the covariance
/// turned and made symmetric. The centre is that of compose(), which rounds in another order than
/// movedCentre(). \param pole In the frame of `base`.
PoleDetection moved(const Pose2D& base, const PoleDetection& pole);

}  // namespace polemcl
