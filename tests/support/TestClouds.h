#pragma once
// Clouds of an invented place, cast ray by ray: flat ground, vertical cylinders, a round
// wall.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/sensor/SensorModel.h"
#include "support/Clouds.h"

namespace polemcl::samples {

struct TestPole {
  double x = 0, y = 0, radius = 0.12, top = 4;  ///< robot frame, m; top above ground
};

/// \brief The poles of the place: robot frame, ground at z = 0. They do not hide each other.
inline std::vector<TestPole> testPoles() {
  return {{8, 1}, {6, 7}, {-2, 9}, {-9, 4}, {-7, -6}, {1, -8}, {9, -7}, {13, 4}};
}

/// \brief Range of one ray; 0 if it hits nothing within 40 m.
inline double castRay(const Eigen::Vector3d& from, const Eigen::Vector3d& along,
                      const std::vector<TestPole>& poles) {
  double nearest = std::numeric_limits<double>::infinity();
  const auto cylinder = [&](double cx, double cy, double radius, double top, bool inside) {
    const double dx = from.x() - cx, dy = from.y() - cy;
    const double a = along.x() * along.x() + along.y() * along.y();
    const double b = dx * along.x() + dy * along.y();
    const double root = b * b - a * (dx * dx + dy * dy - radius * radius);
    if (a < 1e-12 || root < 0) return;
    const double t = (-b + (inside ? 1 : -1) * std::sqrt(root)) / a;
    const double height = from.z() + t * along.z();
    if (t > 0 && height >= 0 && height <= top) nearest = std::min(nearest, t);
  };
  for (const auto& pole : poles) cylinder(pole.x, pole.y, pole.radius, pole.top, false);
  cylinder(0, 0, 30, 8, true);  // the wall
  if (along.z() < 0) nearest = std::min(nearest, -from.z() / along.z());
  return nearest < 40 ? nearest : 0;
}

using TestCloud = clouds::PointList;  ///< LiDAR frame

/// \brief Unit direction of a beam in the LiDAR frame, and its start.
inline std::pair<Eigen::Vector3d, Eigen::Vector3d> ray(const SensorModel& model, int row,
                                                       double azimuth) {
  const double elevation = std::atan(model.beam(row).slope);
  return {Eigen::Vector3d(0, 0, model.beam(row).offset),
          Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                          std::cos(elevation) * std::sin(azimuth), std::sin(elevation))};
}

/// \brief One revolution of the sensor. \param T_robot_lidar Pose of the LiDAR; the ground is at z
/// = 0 of the robot.
inline TestCloud castScan(const SensorOptions& options, const Eigen::Isometry3d& T_robot_lidar,
                          const std::vector<TestPole>& poles) {
  const SensorModel model(options);
  TestCloud cloud;
  for (int column = 0; column < model.columns(); ++column)
    for (int row = 0; row < model.beamCount(); ++row) {
      const double azimuth = 2 * M_PI * column / model.columns() - M_PI;
      const auto [start, along] = ray(model, row, azimuth);
      const double range = castRay(T_robot_lidar * start, T_robot_lidar.linear() * along, poles);
      if (range == 0) continue;
      const Eigen::Vector3d point = start + range * along;
      cloud.add(point.x(), point.y(), point.z());
    }
  return cloud;
}

}  // namespace polemcl::samples
