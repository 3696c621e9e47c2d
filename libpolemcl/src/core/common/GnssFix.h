#pragma once
/// \file GnssFix.h
/// \brief A position from satellites (GPS, Galileo, ...). Private to the library.

#include <Eigen/Core>
#include <cmath>

namespace polemcl {

/// \brief Where the antenna was, by its receiver.
struct GnssFix {
  double time = 0;                                          ///< s, clock of the scans
  double latitude = 0;                                      ///< deg on WGS 84, north positive
  double longitude = 0;                                     ///< deg on WGS 84, east positive
  double sigma = 0;                                         ///< along each horizontal axis, m
  Eigen::Vector2d antenna_robot = Eigen::Vector2d::Zero();  ///< m
};

/// \brief Whether latitude is within ±90 and longitude within ±180 deg; false for NaN.
inline bool isOnGlobe(const GnssFix& fix) {
  return std::abs(fix.latitude) <= 90 && std::abs(fix.longitude) <= 180;
}

}  // namespace polemcl
