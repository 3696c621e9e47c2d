#pragma once
// A street of poles with a drive through it, made of plain numbers, for tests.

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include <polemcl/mrpt/map/CPoleMap.h>
#include "mrpt/rawlog/PoleSequence.h"

namespace polemcl::tests {

/// \brief Uniform numbers in [0, 1) and normal numbers, equal on every standard library.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : m_generator(seed) {}
  double uniform() { return static_cast<double>(m_generator() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double normal() {
    return std::sqrt(-2 * std::log(1 - uniform())) * std::cos(2 * M_PI * uniform());
  }

 private:
  std::mt19937_64 m_generator;
};

struct PoleStreet {
  std::shared_ptr<CPoleMap> map;
  std::vector<Pose2D> truth;
  std::vector<PoleScan> frames;
};

struct StreetOptions {
  int scans = 200;
  double step = 0.5;        ///< m
  double detection = 0.05;  ///< σ of detections, m
  double odometry = 0.02;   ///< σ of each component of the motion, relative to it
  double missed = 0.25;     ///< share of poles not detected
  double falsePerScan = 1;  ///< greatest number of false detections; mean: half of it
  double unmapped = 0.15;   ///< share of poles that are not on the map
  double range = 35;        ///< m
  std::uint64_t seed = 1;
};

/// \brief A street with bends, poles on both sides about every 18 m, 6 to 10 m from the middle.
inline PoleStreet makeStreet(const StreetOptions& options = {}) {
  Dice dice(options.seed);
  PoleStreet street;
  Pose2D pose{3, -2, 0.4};
  double nextPole[2] = {2, 9};
  std::vector<Eigen::Vector2d> poles;
  for (int i = 0; i < options.scans; ++i) {
    street.truth.push_back(pose);
    const double travelled = i * options.step;
    for (int side = 0; side < 2; ++side)
      if (travelled >= nextPole[side]) {
        const Pose2D pole = compose(pose, {0, (side ? 1 : -1) * dice.uniform(6, 10), 0});
        poles.emplace_back(pole.x, pole.y);
        nextPole[side] = travelled + dice.uniform(8, 28);
      }
    const double bend = std::sin(travelled / 30) > 0.7 ? 0.04 : 0.0;  // rad/m
    pose = compose(pose, {options.step, 0, bend * options.step});
  }
  std::vector<MapPole> mapped;
  for (const auto& pole : poles)
    if (dice.uniform() >= options.unmapped) {
      MapPole entry;
      entry.x = pole.x(), entry.y = pole.y();
      entry.radius = 0.1, entry.top = 4, entry.count = 5;
      mapped.push_back(entry);
    }
  street.map = std::make_shared<CPoleMap>();
  street.map->setPoles(mapped);
  LikelihoodOptions likelihood;
  likelihood.weighted = false;
  likelihood.sigma = 0.1;
  likelihood.outlier = 0.01;
  street.map->likelihoodOptions = likelihood;
  for (int i = 0; i < options.scans; ++i) {
    PoleScan frame;
    frame.time = 100 + 0.1 * i;
    PoseWithCovariance motion;
    if (i > 0) {
      const Pose2D move = relative(street.truth[i - 1], street.truth[i]);
      const double sigmas[3] = {options.odometry * std::abs(move.x),
                                options.odometry * std::abs(move.y),
                                options.odometry * std::abs(move.yaw)};
      motion.mean = {move.x + sigmas[0] * dice.normal(), move.y + sigmas[1] * dice.normal(),
                     move.yaw + sigmas[2] * dice.normal()};
      for (int k = 0; k < 3; ++k) motion.covariance(k, k) = sigmas[k] * sigmas[k];
    }
    frame.motion = motion;
    const auto see = [&](double x, double y) {
      PoleDetection detection;
      detection.x = x, detection.y = y;
      frame.poles_robot.push_back(detection);
    };
    for (const auto& pole : poles) {
      const Pose2D seen = relative(street.truth[i], {pole.x(), pole.y(), 0});
      if (std::hypot(seen.x, seen.y) >= options.range || dice.uniform() < options.missed) continue;
      const double y = seen.y + options.detection * dice.normal();
      see(seen.x + options.detection * dice.normal(), y);
    }
    for (double k = dice.uniform(0, options.falsePerScan); k >= 0.5; k -= 1) {
      const double y = dice.uniform(-20, 20);
      see(dice.uniform(-20, 20), y);
    }
    frame.points = 1000;
    street.frames.push_back(frame);
  }
  return street;
}

}  // namespace polemcl::tests
