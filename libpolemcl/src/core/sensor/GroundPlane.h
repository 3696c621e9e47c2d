#pragma once
/// \file GroundPlane.h
/// \brief The plane a sensor stands over, found in one cloud: mounting height and tilt.

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include <polemcl/core/common/Types.h>

namespace polemcl {

/// \brief The ground: all p with normal · p + offset = 0, in the frame of the cloud.
struct GroundPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit length, towards the sensor
  double offset = 0;                                  ///< m
  double share = 0;    ///< of the outermost return of each cell of the surroundings, within 0.15 m
  bool above = false;  ///< it lies on the side of +z: the cloud stands on its head

  /// \brief Height of a place over the plane, m.
  double heightOf(const Eigen::Vector3d& place) const { return normal.dot(place) + offset; }
  /// \brief Attitude of the cloud's axes over the plane, rad, MRPT's signs: roll + when left is up,
  /// pitch + when the front is down. For a cloud on its head, after half a turn about x.
  double roll() const;
  double pitch() const;
};

/// \brief Finds the ground within 25 m: the lowest returns around the sensor, or the highest ones
/// where these, not the lowest, form a plane.
/// \param points One turn; NaN and zeros are passed over. Their order does not matter.
/// \param sensor The optical centre in the frame of the cloud, m; it is at least 0.1 m over the
/// ground.
/// \return None when less than a quarter of the surroundings lies in a plane within 25° of level.
std::optional<GroundPlane> findGroundPlane(const PointsView& points,
                                           const Eigen::Vector3d& sensor = Eigen::Vector3d::Zero());

}  // namespace polemcl
