#pragma once
/// \file Drive.h
/// \brief The path of the sensor through a world: true poses, times, odometry, that of wheels
/// among it.

#include <Eigen/Geometry>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "sim/common/Random.h"
#include "sim/common/SimulationOptions.h"
#include "sim/world/World.h"

namespace polemcl::sim {

/// \brief Planar motion since the previous pose, in its frame, as a wheel odometer reports it.
struct OdometryStep {
  double dx = 0, dy = 0, dyaw = 0;  ///< m, m, rad
  double sx = 0, sy = 0, syaw = 0;  ///< standard deviations
};

/// \brief Reads one motion after the other.
///
/// Distance: wrong by `scale`, which sways with `drift`, and counted in whole ticks. Turns: wrong
/// by `yaw` per metre, which sways alike, and by `slip` of the turn itself. Both together are an
/// arc; sideways motion of the vehicle itself is not seen. White noise of 0.2 % of the distance and
/// 0.01°/m^½ is added. The standard deviations are what a user would write down without knowing any
/// of this: 2 % of the distance and 2 mm along, 1 % and 2 mm across, 0.1°/m, 2 % of the turn and
/// 0.02° for the heading.
class WheelOdometry {
 public:
  WheelOdometry(const OdometryBias& bias, Random noise);
  /// \param step True motion since the previous pose, in its frame.
  OdometryStep read(const Pose2D& step);

 private:
  double sway(double wavelength) const;

  OdometryBias m_bias;
  Random m_noise;
  double m_driven = 0;    ///< true distance, m
  double m_measured = 0;  ///< distance before counting ticks, m
  double m_counted = 0;   ///< distance reported, m
};

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
