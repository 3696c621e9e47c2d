#pragma once
/// \file SolidView.h
/// \brief Beams, firing steps and solids in the sensor frame of one scan.

#include <Eigen/Geometry>

#include "sim/lidar/Intersection.h"
#include "sim/lidar/LidarModel.h"
#include "sim/world/Solid.h"

namespace polemcl::sim {

constexpr int kSubRays = 5;  ///< centre, left, right, up, down of a pulse

/// \brief One firing step: azimuth of the rotor and position of the sensor.
struct ColumnView {
  Eigen::Vector3f origin;
  float cosine, sine;                   ///< true azimuth
  double reportedCosine, reportedSine;  ///< azimuth written into the points
};

/// \brief One beam with the directions of its sub-rays.
class BeamView {
 public:
  BeamView(const Beam& beam, double divergence);
  Eigen::Vector3f direction(int subRay, const ColumnView& column) const {
    const Eigen::Vector3f& local = m_local[subRay];
    return {column.cosine * local.x() - column.sine * local.y(),
            column.sine * local.x() + column.cosine * local.y(), local.z()};
  }
  /// \brief The point that the sensor reports for a range.
  Eigen::Vector3d reported(const ColumnView& column, double range) const;

  Eigen::Vector3f start;           ///< start of the ray in the sensor frame, m
  double azimuth, halfAngle;       ///< rad
  double lowTangent, highTangent;  ///< elevations covered by the pulse

 private:
  Eigen::Vector3f m_local[kSubRays];  ///< at rotor azimuth 0
  Eigen::Vector3d m_reported;
};

/// \brief Conservative bounds of a solid.
struct SolidBounds {
  double nearest = 0;                      ///< smallest range, m
  double azimuth = 0, halfAzimuth = M_PI;  ///< rad
  double lowTangent = -1e9, highTangent = 1e9;
};

/// \brief Largest offset of the ray origins from the sensor's origin.
struct BoundsMargin {
  double translation = 0;  ///< m
  double azimuth = 0;      ///< rad
  double lowestRise = 0, highestRise = 0;
};

/// \brief A solid in the sensor frame of one scan.
class SolidView {
 public:
  SolidView(const Solid& solid, const Eigen::Isometry3d& T_sensor_map, std::uint64_t seed);
  SolidBounds bounds(const BoundsMargin& margin) const;
  /// \param draw Random bits for this ray and solid.
  ShapeHit intersect(const LocalRay& ray, std::uint64_t draw) const;

  Eigen::Matrix3f toLocal;  ///< local = toLocal * sensor + offset
  Eigen::Vector3f offset;
  Material material;
  std::uint32_t object;

 private:
  void boundFrustum(SolidBounds& bounds, double margin, double& low, double& high,
                    double& farthest) const;
  void boundBox(SolidBounds& bounds, double margin, double& low, double& high,
                double& farthest) const;
  void boundEllipsoid(SolidBounds& bounds, double margin, double& low, double& high,
                      double& farthest) const;
  Shape m_shape;
  Eigen::Vector3d m_position;
  Eigen::Matrix3d m_axes;
  Eigen::Vector3f m_size;
  float m_density, m_cell;
  std::uint64_t m_seed;
};

}  // namespace polemcl::sim
