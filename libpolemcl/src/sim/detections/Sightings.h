#pragma once
/// \file Sightings.h
/// \brief The objects that each scan of a simulated drive could detect, and what it detected.

#include <array>
#include <optional>
#include <vector>

#include "sim/detections/DetectionModel.h"
#include "sim/drive/Simulation.h"

namespace polemcl::sim {

/// \brief An object in range of a scan. `clutter`: a place with three false detections or more.
struct Sighting {
  DetectionClass kind = DetectionClass::clutter;
  std::size_t object = 0;  ///< id of a true pole; clutter is counted from 0; 0 when passing
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< of the object, m, map frame
  std::size_t scan = 0;
  double range = 0;     ///< of the object, m
  bool hidden = false;  ///< by a house
  /// What the detection says, with errors divided by the reported sigma. Nothing: not detected.
  std::optional<std::array<double, kReported>> reported;
};

/// \brief Assigns the detections of a drive to objects: to true poles within 0.5 m, then to clutter
/// within 0.6 m, one to one in each scan. The others are `passing`.
/// \param poles Detections of each scan, in the frame of the written clouds.
/// \param maxRange Range of the extraction, m.
/// \return Sightings of the poles, of clutter, then passing ones, each by scan.
std::vector<Sighting> sightingsOf(const SimulatedDrive& drive,
                                  const std::vector<std::vector<PoleDetection>>& poles,
                                  double maxRange);

}  // namespace polemcl::sim
