#pragma once
/// \file Scanner.h
/// \brief Simulates one revolution of a LiDAR in the world by ray casting.

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "sim/lidar/PulseReturn.h"
#include "sim/lidar/SolidView.h"
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
///
/// Casting works object by object into a buffer of sub-rays, like a rasterizer. An object touches
/// only the beams and firing steps whose rays can hit it. Several sub-rays sample the width of one
/// pulse; their hits are merged into its return at the end.
class Scanner {
 public:
  Scanner(const World& world, const LidarModel& lidar);
  /// \brief Simulates one revolution.
  /// \param T_map_sensor Pose of the optical centre in the middle of the revolution.
  /// \param seed Seed of noise and dropouts; equal seeds give equal scans.
  /// \param motion Distorts the scan: points are computed as if the sensor had not moved.
  SimulatedScan scan(const Eigen::Isometry3d& T_map_sensor, std::uint64_t seed,
                     const Motion& motion = {}) const;

 private:
  double azimuthStep() const;
  std::size_t pixel(std::size_t beam, int column) const { return beam * m_lidar.columns + column; }
  std::vector<ColumnView> columnViews(const Motion& motion) const;
  void castGround(const Eigen::Isometry3d& T_map_sensor, const std::vector<ColumnView>& columns,
                  std::vector<SubHit>& hits) const;
  std::vector<SolidView> solidsAround(const Eigen::Isometry3d& T_map_sensor) const;
  void castSolid(const SolidView& solid, std::int32_t index, const std::vector<ColumnView>& columns,
                 const SolidBounds& bounds, std::uint64_t seed, std::vector<SubHit>& hits) const;

  const World& m_world;
  LidarModel m_lidar;
  std::vector<BeamView> m_beams;
  double m_lowestRise = 0, m_highestRise = 0;
};

}  // namespace polemcl::sim
