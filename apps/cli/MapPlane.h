#pragma once
/// \file MapPlane.h
/// \brief The plane of a map on WGS 84, by the library PROJ.

#include <Eigen/Geometry>
#include <memory>

#include "io/map/Datum.h"

namespace polemcl {

/// \brief The plane that touches the ellipsoid at the datum of a map.
///
/// A place and its longitude and latitude lie on the same vertical of the ellipsoid. Heights play
/// no part.
class MapPlane {
 public:
  explicit MapPlane(const io::Datum& datum);
  ~MapPlane();
  MapPlane(const MapPlane&) = delete;
  MapPlane& operator=(const MapPlane&) = delete;

  /// \brief Longitude and latitude (x, y of the result), deg.
  /// \param place On the map, m. \throws Error when it lies 100 km and more from the datum.
  Eigen::Vector2d lonLat(const Eigen::Vector2d& place) const;

  /// \brief Place on the map, m; the inverse of lonLat().
  /// \param lonLat deg. \throws Error as lonLat(); it says when the two numbers are swapped.
  Eigen::Vector2d place(const Eigen::Vector2d& lonLat) const;

  /// \brief Straight from the datum, m. \param lonLat deg.
  double distanceTo(const Eigen::Vector2d& lonLat) const;

 private:
  struct Projection;
  Eigen::Vector3d eastNorthUp(const Eigen::Vector2d& lonLat, double height) const;
  void requireNear(double distance) const;

  io::Datum m_datum;
  Eigen::Rotation2Dd m_turn;  ///< from the axes of the map to east and north
  std::unique_ptr<Projection> m_projection;
};

}  // namespace polemcl
