#pragma once
/// \brief A straight drive past poles whose places mislead: even rows, a lorry beside the vehicle.

#include <Eigen/Core>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "sim/common/Random.h"
#include "support/Poles.h"

namespace polemcl::tests {

using Places = std::vector<Eigen::Vector2d>;

/// \brief 300 scans at 10 Hz, `step` metres apart, past poles that are seen half of the time within
/// 30 m. Others stay at the places `alongside`, robot frame, from scan 21 on. The odometry is 1 %
/// long, with covariances of 2 %.
inline std::vector<PoleScan> straightDrive(const Places& places, double step,
                                           const Places& alongside, std::uint64_t seed) {
  sim::Random random(seed);
  std::vector<PoleScan> scans;
  for (int i = 0; i < 300; ++i) {
    PoleScan scan;
    scan.time = 0.1 * i;
    const double sigma = 0.02 * step;
    scan.motion = PoseWithCovariance{{1.01 * step, 0, 0},
                                     Eigen::Vector3d(sigma * sigma, 1e-6, 1e-8).asDiagonal()};
    const auto see = [&](const Eigen::Vector2d& place, double chance) {
      if (place.norm() < 30 && random.chance(chance))
        scan.poles_robot.push_back(detectionAt(place.x() + 0.03 * random.normal(),
                                               place.y() + 0.03 * random.normal(), 2e-3));
    };
    for (const Eigen::Vector2d& place : places) see(place - Eigen::Vector2d(i * step, 0), 0.5);
    for (const Eigen::Vector2d& place : alongside) see(place, i > 20 ? 0.9 : 0);
    scans.push_back(scan);
  }
  scans[0].motion.reset();
  return scans;
}

/// \brief Posts at an even distance on one side, a few others on the other side.
inline Places evenRow(double distance) {
  Places row;
  for (double x = -40; x < 700; x += distance) row.emplace_back(x, -6);
  for (double x = -40; x < 700; x += 37) row.emplace_back(x + 3 * std::sin(x), 8);
  return row;
}

/// \brief A pole every 9 m in the mean, and five that stand on a lorry beside the vehicle.
inline Places streetPoles() {
  Places street;
  for (double x = -40; x < 400; x += 9) street.emplace_back(x + 4 * std::sin(x), x > 100 ? 7 : -8);
  return street;
}
inline const Places kLorry{{6, -3}, {7.5, -2.6}, {9, -3}, {10.5, -2.6}, {12, -3}};

}  // namespace polemcl::tests
