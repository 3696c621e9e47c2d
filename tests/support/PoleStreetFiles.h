#pragma once
// A street of bare poles on flat ground, seen by an HDL-32E 1.0 m above it, as a scan
// folder.

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/ScanFolders.h"

namespace testing_apps {

struct StreetPole {
  double x, y;  ///< map frame, m
};
constexpr double streetPoleRadius = 0.12, streetPoleTop = 5.0, streetSensorHeight = 1.0;  ///< m

/// Two rows of poles along x, 9 m apart, one side shifted.
inline std::vector<StreetPole> streetPoles() {
  std::vector<StreetPole> poles;
  for (int i = -2; i < 6; ++i) {
    poles.push_back({9.0 * i, 6.0});
    poles.push_back({9.0 * i + 4.0, -7.0});
  }
  return poles;
}

/// Range of a horizontal ray from (x, y) to the nearest pole; infinity if it hits none.
inline double rangeToPoles(const std::vector<StreetPole>& poles, double x, double y, double yaw) {
  const double dx = std::cos(yaw), dy = std::sin(yaw);
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& pole : poles) {
    const double px = pole.x - x, py = pole.y - y;
    const double along = px * dx + py * dy, across = px * dy - py * dx;
    const double half2 = streetPoleRadius * streetPoleRadius - across * across;
    if (half2 > 0 && along > 0) nearest = std::min(nearest, along - std::sqrt(half2));
  }
  return nearest;
}

/// Range of a ray of this slope: that of the pole where it hits it, else of the ground, or
/// infinity.
inline double rangeOfRay(double pole, double slope) {
  const double ground =
      slope < 0 ? streetSensorHeight / -slope : std::numeric_limits<double>::infinity();
  return pole < ground && streetSensorHeight + pole * slope < streetPoleTop ? pole : ground;
}

/// One revolution of the sensor at a pose: 32 beams, 0.2 degrees per step, no noise, 60 m.
inline Points scanStreet(const std::vector<StreetPole>& poles, double x, double y, double yaw) {
  Points points;
  const double degree = M_PI / 180;
  for (int step = 0; step < 1800; ++step) {
    const double azimuth = step * 0.2 * degree;
    const double pole = rangeToPoles(poles, x, y, yaw + azimuth);
    for (int beam = 0; beam < 32; ++beam) {
      const double slope = std::tan((10.67 - beam * 41.34 / 31) * degree);
      const double rho = rangeOfRay(pole, slope);
      if (!(rho < 60)) continue;
      points.push_back({static_cast<float>(rho * std::cos(azimuth)),
                        static_cast<float>(rho * std::sin(azimuth)),
                        static_cast<float>(rho * slope), 0.5f});
    }
  }
  return points;
}

/// A drive along x at y = 0, one scan per metre and 0.2 s, with a slowly swinging heading and exact
/// odometry.
inline void writeStreet(const fs::path& folder, std::size_t scans,
                        const std::vector<StreetPole>& poles = streetPoles(), double startTime = 50,
                        double startX = 0) {
  std::string times, rows, odometry;
  const auto yawAt = [](std::size_t i) { return 0.05 * std::sin(0.7 * static_cast<double>(i)); };
  for (std::size_t i = 0; i < scans; ++i) {
    const double x = startX + static_cast<double>(i), yaw = yawAt(i);
    writeBin(folder / "velodyne" / scanName(i), scanStreet(poles, x, 0, yaw));
    times += std::to_string(startTime + 0.2 * static_cast<double>(i)) + '\n';
    rows += poseRow(x, 0, yaw);
    if (i == 0) continue;
    char row[160];
    const double before = yawAt(i - 1);
    std::snprintf(row, sizeof row, "%.17g %.17g %.17g 0.02 0.01 0.003\n", std::cos(before),
                  -std::sin(before), yaw - before);
    odometry += row;
  }
  writeText(folder / "times.txt", times);
  writeText(folder / "poses.txt", rows);
  writeText(folder / "odometry.txt", odometry);
}

}  // namespace testing_apps
