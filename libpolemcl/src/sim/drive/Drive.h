#pragma once
/// \file Drive.h
/// \brief The way of the sensor through a world: true poses, times, odometry.

#include <Eigen/Geometry>
#include <vector>

#include "sim/common/Random.h"
#include "sim/world/World.h"

namespace polemcl::sim {

/// \brief Planar motion since the pose before, in its frame, as a wheel odometer reports it.
struct OdometryStep {
  double dx = 0, dy = 0, dyaw = 0;  ///< m, m, rad
  double sx = 0, sy = 0, syaw = 0;  ///< standard deviations
};

/// \brief One element per scan; odometry one less.
struct Drive {
  std::vector<double> time;                     ///< s, from 0
  std::vector<Eigen::Isometry3d> T_map_sensor;  ///< follows slope and sway
  std::vector<OdometryStep> odometry;           ///< of the frame of the clouds
};

/// \brief Seed of what differs between two drives of one day (noise of scans and odometry, sway)
/// from the seed it has in the drive 0.
inline std::uint64_t driveSeed(const SimulationOptions& options, std::uint64_t seed) {
  return options.driveSeed == 0 ? seed : hash(seed, 0xd21feedull, options.driveSeed);
}

/// \brief The frame of the written clouds in the map (see SimulationOptions::originX).
Eigen::Isometry3d cloudFrame(const Eigen::Isometry3d& T_map_sensor,
                             const SimulationOptions& options);

/// \brief Drives along the street, or round by the detour of the options, at constant speed.
/// \throws Error when the street is shorter than two scans.
Drive makeDrive(const World& world, const SimulationOptions& options);

}  // namespace polemcl::sim
