#pragma once
/// \file Scanner.h
/// \brief Casts the rays of one turn of a LiDAR through the world.

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/common/Types.h"
#include "sim/lidar/LidarModel.h"
#include "sim/world/World.h"

namespace polemcl::sim {

/// \brief Points of one turn in firing order (column by column, beams from top to bottom), in the
/// sensor frame: origin at the optical centre, x forward, y left, z up, m.
struct SimulatedScan {
  std::vector<float> x, y, z, intensity;
  /// Id of the object hit, 0 the ground; on the crown of a tree with kFoliageBit set.
  std::vector<std::uint32_t> label;
  std::size_t size() const { return x.size(); }
  PointsView view() const { return {x.data(), y.data(), z.data(), x.size()}; }
};

/// \brief How the sensor moves during one turn, in its own frame.
struct Motion {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
  double yawRate = 0;                                  ///< rad/s
};

/// \brief A LiDAR in a world. Holds direction tables; one object may serve many threads.
class Scanner {
 public:
  Scanner(const World& world, const LidarModel& lidar);
  ~Scanner();
  /// \brief One turn.
  /// \param T_map_sensor Pose of the optical centre in the middle of the turn.
  /// \param seed Of noise and dropouts; the same seed gives the same scan.
  /// \param time Of the scan, s: where things that walk are.
  /// \param motion Distorts the scan: points are given as if the sensor had not moved.
  SimulatedScan scan(const Eigen::Isometry3d& T_map_sensor, std::uint64_t seed, double time = 0,
                     const Motion& motion = {}) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

/// \brief One scan; for many, keep a Scanner.
SimulatedScan scan(const World& world, const Eigen::Isometry3d& T_map_sensor,
                   const LidarModel& lidar, std::uint64_t seed);

}  // namespace polemcl::sim
