#pragma once
/// \file GnssFix.h
/// \brief A position from satellites (GPS, Galileo, ...). Private to the library.

#include <Eigen/Core>

namespace polemcl {

/// \brief Where the antenna was, by its receiver.
struct GnssFix {
  double time = 0;                                          ///< s, clock of the scans
  double latitude = 0;                                      ///< deg on WGS 84, north positive
  double longitude = 0;                                     ///< deg on WGS 84, east positive
  double sigma = 0;                                         ///< along each horizontal axis, m
  Eigen::Vector2d antenna_robot = Eigen::Vector2d::Zero();  ///< m
};

}  // namespace polemcl
