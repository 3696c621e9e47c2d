#pragma once
/// \file DetectionTracks.h
/// \brief What became of each pole and each false object while a drive passed it.

#include <limits>

#include "sim/detections/DetectionModelFit.h"

namespace polemcl::sim {

/// \brief A scan that might have shown it.
struct Chance {
  std::size_t scan = 0;
  double range = 0;                          ///< m
  bool hidden = false;                       ///< behind a house
  const PoleDetection* detection = nullptr;  ///< none: not found
  /// As the model has it with errorExponent 1; of a detection.
  std::array<double, kReported> reported{};
};

struct Track {
  DetectionClass kind = DetectionClass::clutter;
  std::uint64_t id = 0;                             ///< the same on both days
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< m, map frame
  double radius = 0;
  std::vector<Chance> chances;  ///< by scan, ascending
};

/// \brief One drive taken apart.
struct TrackedDrive {
  std::vector<Track> tracks;
  std::vector<Chance> passing;  ///< false detections that belong to nothing lasting
  std::size_t scans = 0;
};

TrackedDrive trackDrive(const ObservedDrive& drive, double maxRange);

/// \brief Both days of a street; lasting false objects found on both have one id.
struct TrackedStreet {
  TrackedDrive first, second;
  std::size_t clutterOnBoth = 0;
};
TrackedStreet trackStreet(const ObservedStreet& street, double maxRange);

}  // namespace polemcl::sim
