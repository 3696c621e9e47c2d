#pragma once
/// \file CoordinateSystem.h
/// \brief Places in the coordinate systems of other people's data, by the library PROJ.

#include <Eigen/Core>
#include <memory>
#include <string>

namespace polemcl::apps {

/// \brief A coordinate system on Earth, by any name that PROJ knows: `EPSG:25833`, `EPSG:4326`.
class CoordinateSystem {
 public:
  /// \throws Error when PROJ does not know the name, or the system has no places on Earth.
  explicit CoordinateSystem(const std::string& name);
  ~CoordinateSystem();
  CoordinateSystem(const CoordinateSystem&) = delete;
  CoordinateSystem& operator=(const CoordinateSystem&) = delete;

  /// \brief Longitude and latitude on WGS 84 (x, y of the result), deg.
  /// \param place East before north, or longitude before latitude, whatever the order that the
  /// system itself defines; in its units. \throws Error when the place is outside of the system.
  Eigen::Vector2d lonLat(const Eigen::Vector2d& place) const;

 private:
  struct Impl;
  std::string m_name;
  std::unique_ptr<Impl> m_impl;
};

}  // namespace polemcl::apps
