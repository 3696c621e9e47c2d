#pragma once
/// \file Drive.h
/// \brief The path of the sensor through a world: true poses, times, odometry.

#include <Eigen/Geometry>
#include <vector>

#include "sim/common/Random.h"
#include "sim/drive/WheelOdometry.h"
#include "sim/world/World.h"

namespace polemcl::sim {

/// \brief One element per scan, in `odometry` one less.
struct Drive {
  std::vector<double> time;                     ///< s, from 0
  std::vector<Eigen::Isometry3d> T_map_sensor;  ///< includes slope and sway
  std::vector<OdometryStep> odometry;           ///< of the frame of the clouds
};

/// \brief Seed of everything that differs between drives of one day: noise of scans and odometry,
/// sway. \param seed Seed of drive 0.
inline std::uint64_t driveSeed(const SimulationOptions& options, std::uint64_t seed) {
  return options.driveSeed == 0 ? seed : hash(seed, 0xd21feedull, options.driveSeed);
}

/// \brief Pose of the cloud frame in the map (see SimulationOptions::originX).
Eigen::Isometry3d cloudFrame(const Eigen::Isometry3d& T_map_sensor,
                             const SimulationOptions& options);

/// \brief Drives along the street, or along the detour of the options, at constant speed.
/// \throws Error when the street is too short for two scans.
Drive makeDrive(const World& world, const SimulationOptions& options);

}  // namespace polemcl::sim
