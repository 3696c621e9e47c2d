#pragma once
// A simulated drive whose poles are measured at known moments.

#include <cmath>
#include <random>
#include <vector>

#include "core/common/Deskew.h"
#include "core/sensor/TimingSearch.h"

namespace polemcl::tests {

/// A drive of 300 m with bends and changing speed, poles on both sides, 2 cm of noise, a scan each
/// 0.1 s; each pole is measured at the moment that `timing` says.
inline std::vector<TimedScan> timedDrive(const ScanTiming& timing) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0, 0.02);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Velocity> speeds;
  std::vector<Pose2D> poses{{0, 0, 0}};
  constexpr int fine = 200;  // steps a second
  for (int k = 0; k < 60 * fine; ++k) {
    const double t = static_cast<double>(k) / fine;
    speeds.push_back({6 + 4 * std::sin(t), 0, 0.4 * std::sin(0.7 * t)});
    poses.push_back(compose(poses.back(), motionAfter(speeds.back(), 1.0 / fine)));
  }
  std::vector<Eigen::Vector2d> poles;
  for (std::size_t k = 0; k < poses.size(); k += 2 * fine) {
    const Pose2D at = compose(poses[k], {0, (k / fine) % 4 ? 7.0 : -6.0, 0});
    const double y = at.y + uniform(random);
    poles.emplace_back(at.x + uniform(random), y);
  }
  const auto poseAt = [&](double time) {
    const auto k = static_cast<std::size_t>(time * fine);
    return compose(poses[k], motionAfter(speeds[k], time - static_cast<double>(k) / fine));
  };
  std::vector<TimedScan> scans;
  for (double time = 1; time < 55; time += 0.1) {
    TimedScan scan{time, poseAt(time), {}};
    for (const Eigen::Vector2d& pole : poles) {
      Pose2D seen = relative(scan.pose_map_robot, {pole.x(), pole.y(), 0});
      for (int round = 0; round < 3; ++round)  // until azimuth and moment agree
        seen = relative(poseAt(time + timing.offset(std::atan2(seen.y, seen.x))),
                        {pole.x(), pole.y(), 0});
      if (std::hypot(seen.x, seen.y) > 30) continue;
      const double azimuth = std::atan2(seen.y, seen.x);
      scan.poles_robot.push_back({seen.x + noise(random), seen.y + noise(random), azimuth});
    }
    scans.push_back(scan);
  }
  return scans;
}

}  // namespace polemcl::tests
