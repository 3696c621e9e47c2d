#pragma once
// Files of NCLT, byte by byte as in read_vel_sync.py and read_vel_hits.py of the dataset.

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>

#include "support/NumpyFiles.h"

namespace testing_nclt {

using polemcl::io::test::little;

/// uint16 x y z in steps of 5 mm from -100 m, uint8 intensity, uint8 laser.
inline std::string point(double x, double y, double z, int intensity = 7, int laser = 3) {
  std::string bytes;
  for (const double value : {x, y, z})
    bytes += little(static_cast<std::uint64_t>(std::lround((value + 100) / 0.005)), 2);
  return bytes + little(static_cast<std::uint64_t>(intensity), 1) +
         little(static_cast<std::uint64_t>(laser), 1);
}

/// Four times 44444, number of points, time in us, padding, points.
inline std::string packet(std::uint64_t utime, const std::string& points) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += little(44444, 2);
  return bytes + little(points.size() / 8, 4) + little(utime, 8) + little(0, 4) + points;
}

/// A row "utime, x, y, z, roll, pitch, heading".
inline std::string poseRow(std::uint64_t utime, double x, double y, double z, double roll,
                           double pitch, double heading) {
  char row[256];
  std::snprintf(row, sizeof row, "%llu,%.9f,%.9f,%.9f,%.9f,%.9f,%.9f\n",
                static_cast<unsigned long long>(utime), x, y, z, roll, pitch, heading);
  return row;
}

/// A row of a covariance: utime and the upper triangle of x y z roll pitch heading.
inline std::string covarianceRow(std::uint64_t utime, const Eigen::Matrix<double, 6, 6>& c) {
  std::string row = std::to_string(utime);
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) {
      char value[32];
      std::snprintf(value, sizeof value, ",%.9g", c(i, j));
      row += value;
    }
  }
  return row + "\n";
}

inline constexpr std::uint64_t start = 1326652795000000;  ///< us; 2012-01-15

/// Packets of a rotating LiDAR: one point at 10 m every `step` degrees.
inline std::string turning(int packets, double step, std::uint64_t begin = start,
                           std::uint64_t period = 10000) {
  std::string bytes;
  for (int i = 0; i < packets; ++i) {
    const double azimuth = step * i * M_PI / 180;
    bytes += packet(begin + static_cast<std::uint64_t>(i) * period,
                    point(0, 0, 0) + point(10 * std::cos(azimuth), 10 * std::sin(azimuth), 1));
  }
  return bytes;
}

}  // namespace testing_nclt
