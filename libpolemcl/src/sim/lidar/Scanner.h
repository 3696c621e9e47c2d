#pragma once
/// \file Scanner.h
/// \brief Simulates one revolution of a LiDAR in the world by ray casting.

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "sim/lidar/LidarModel.h"
#include "sim/world/World.h"

namespace polemcl::sim {

/// \brief Points of one revolution in firing order (column by column, beams from top to bottom).
/// Sensor frame: origin at the optical centre, x forward, y left, z up, m.
struct SimulatedScan {
  std::vector<float> x, y, z, intensity;
  /// Id of the hit object, 0 for the ground; points on the crown of a tree have kFoliageBit set.
  std::vector<std::uint32_t> label;
  std::size_t size() const { return x.size(); }
  PointsView view() const { return {x.data(), y.data(), z.data(), x.size()}; }
};

/// \brief Motion of the sensor during one revolution, in its own frame.
struct Motion {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
  double yawRate = 0;                                  ///< rad/s
};

/// \brief A LiDAR in a world. Holds direction tables; one object may serve many threads.
class Scanner {
 public:
  Scanner(const World& world, const LidarModel& lidar);
  ~Scanner();
  /// \brief Simulates one revolution.
  /// \param T_map_sensor Pose of the optical centre in the middle of the revolution.
  /// \param seed Seed of noise and dropouts; equal seeds give equal scans.
  /// \param time Time of the scan, s; determines the position of walking objects.
  /// \param motion Distorts the scan: points are computed as if the sensor had not moved.
  SimulatedScan scan(const Eigen::Isometry3d& T_map_sensor, std::uint64_t seed, double time = 0,
                     const Motion& motion = {}) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

/// \brief Simulates a single scan; for many, keep a Scanner.
SimulatedScan scan(const World& world, const Eigen::Isometry3d& T_map_sensor,
                   const LidarModel& lidar, std::uint64_t seed);

}  // namespace polemcl::sim
