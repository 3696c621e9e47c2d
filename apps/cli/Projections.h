#pragma once
/// \file Projections.h
/// \brief Places on Earth and on the plane of a map, by the library PROJ.

#include <Eigen/Geometry>
#include <memory>
#include <string>

#include "io/map/Datum.h"

namespace polemcl::apps {

struct Projection;  ///< one of PROJ, with its context

/// \brief A coordinate system on Earth, by any name that PROJ knows: `EPSG:25833`, `EPSG:4326`.
class CoordinateSystem {
 public:
  /// \throws Error when PROJ does not know the name, or the system has no places on Earth.
  explicit CoordinateSystem(const std::string& name);

  /// \brief Longitude and latitude on WGS 84 (x, y of the result), deg.
  /// \param place East before north, or longitude before latitude, whatever the order that the
  /// system itself defines; in its units. \throws Error when the place is outside of the system.
  Eigen::Vector2d lonLat(const Eigen::Vector2d& place) const;

 private:
  std::string m_name;
  std::shared_ptr<Projection> m_toLonLat;
};

/// \brief The plane that touches the ellipsoid WGS 84 at the datum of a map.
///
/// A place and its longitude and latitude lie on the same vertical of the ellipsoid. Heights play
/// no part.
class MapPlane {
 public:
  explicit MapPlane(const io::Datum& datum);

  /// \brief Longitude and latitude (x, y of the result), deg.
  /// \param place On the map, m. \throws Error when it lies 100 km and more from the datum.
  Eigen::Vector2d lonLat(const Eigen::Vector2d& place) const;

  /// \brief Place on the map, m; the inverse of lonLat().
  /// \param lonLat deg. \throws Error as lonLat(); it says when the two numbers are swapped.
  Eigen::Vector2d place(const Eigen::Vector2d& lonLat) const;

  /// \brief Straight from the datum, m. \param lonLat deg.
  double distanceTo(const Eigen::Vector2d& lonLat) const;

 private:
  Eigen::Vector3d eastNorthUp(const Eigen::Vector2d& lonLat, double height) const;
  void requireNear(double distance) const;

  io::Datum m_datum;
  Eigen::Rotation2Dd m_turn;              ///< from the axes of the map to east and north
  std::shared_ptr<Projection> m_toPlane;  ///< from degrees and height to east, north, up
};

}  // namespace polemcl::apps
