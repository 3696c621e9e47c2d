#pragma once
// Scans of the simulated street with the visible poles.

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <polemcl/core/extraction/PoleExtractor.h>
#include "sim/drive/Drive.h"
#include "sim/lidar/Scanner.h"

namespace polemcl::clouds {

/// \brief A true pole in the sensor frame of one scan.
struct ScannedPole {
  double x = 0, y = 0, radius = 0;  ///< m, at 1.5 m above ground
  bool visible = false;  ///< at least 6 returns on its trunk, over 0.6 m of height, within 40 m
};

struct LabelledScan {
  sim::SimulatedScan scan;
  std::vector<ScannedPole> poles;  ///< all of the world
};

/// \brief The world's poles in a scan's frame, with their visibility in the scan.
inline std::vector<ScannedPole> scannedPoles(const sim::World& world,
                                             const Eigen::Isometry3d& T_map_sensor,
                                             const sim::SimulatedScan& scan) {
  struct Seen {
    int returns = 0;
    float low = 1e9f, high = -1e9f;
  };
  std::vector<ScannedPole> poles;
  std::map<std::uint32_t, std::size_t> index;
  for (const sim::TruePole& pole : world.poles()) {
    const double z = world.terrain().height(pole.x, pole.y) + 1.5;
    const Eigen::Vector3d p = T_map_sensor.inverse() * Eigen::Vector3d(pole.x, pole.y, z);
    index[pole.id] = poles.size();
    poles.push_back({p.x(), p.y(), pole.radius, false});
  }
  std::vector<Seen> seen(poles.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const auto found = index.find(scan.label[i]);
    if (found == index.end()) continue;
    const ScannedPole& pole = poles[found->second];
    if (std::hypot(scan.x[i] - pole.x, scan.y[i] - pole.y) > pole.radius + 0.25) continue;
    Seen& s = seen[found->second];
    ++s.returns;
    s.low = std::min(s.low, scan.z[i]);
    s.high = std::max(s.high, scan.z[i]);
  }
  for (std::size_t i = 0; i < poles.size(); ++i)
    poles[i].visible = seen[i].returns >= 6 && seen[i].high - seen[i].low >= 0.6f &&
                       std::hypot(poles[i].x, poles[i].y) < 40;
  return poles;
}

/// \brief `count` scans spread over a street of 200 m.
inline std::vector<LabelledScan> streetScans(std::uint64_t world, const std::string& sensor,
                                             double height, int count) {
  sim::SimulationOptions options;
  options.world.seed = world;
  options.world.length = 200;
  options.sensor = sensor;
  options.height = height;
  options.spacing = 5;
  const sim::World street = sim::makeWorld(options.world);
  const sim::Drive drive = sim::makeDrive(street, options);
  const sim::Scanner scanner(street, sim::makeLidar(sensor));
  std::vector<LabelledScan> scans;
  for (int i = 0; i < count; ++i) {
    const auto& pose = drive.T_map_sensor[(i + 1) * drive.T_map_sensor.size() / (count + 1)];
    LabelledScan labelled;
    labelled.scan = scanner.scan(pose, world * 100 + i);
    labelled.poles = scannedPoles(street, pose, labelled.scan);
    scans.push_back(std::move(labelled));
  }
  return scans;
}

/// \brief Comparison of detections with the poles of one or more scans; each pole matches once,
/// within 0.5 m.
struct Score {
  int detections = 0, right = 0, visible = 0, found = 0;
  double precision() const { return static_cast<double>(right) / std::max(1, detections); }
  double recall() const { return static_cast<double>(found) / std::max(1, visible); }
  void add(const std::vector<PoleDetection>& detected, const std::vector<ScannedPole>& poles) {
    std::vector<char> taken(poles.size(), 0);
    for (const PoleDetection& d : detected) {
      double best = 0.5;
      std::size_t match = poles.size();
      for (std::size_t i = 0; i < poles.size(); ++i) {
        const double distance = std::hypot(poles[i].x - d.x, poles[i].y - d.y);
        if (distance < best && !taken[i]) {
          best = distance;
          match = i;
        }
      }
      ++detections;
      if (match == poles.size()) continue;
      taken[match] = 1;
      ++right;
    }
    for (std::size_t i = 0; i < poles.size(); ++i) {
      visible += poles[i].visible;
      found += poles[i].visible && taken[i];
    }
  }
};

}  // namespace polemcl::clouds
