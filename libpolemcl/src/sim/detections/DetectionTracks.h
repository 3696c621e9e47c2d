#pragma once
/// \file DetectionTracks.h
/// \brief Detection history of each pole and each false object during a drive.

#include <limits>

#include "sim/detections/DetectionModelFit.h"

namespace polemcl::sim {

/// \brief A scan that could have detected the object.
struct Chance {
  std::size_t scan = 0;
  double range = 0;                          ///< m
  bool hidden = false;                       ///< hidden by a house
  const PoleDetection* detection = nullptr;  ///< null: not found
  /// Values of the detection, with errors divided by the reported sigma (errorExponent 1).
  std::array<double, kReported> reported{};
};

struct Track {
  DetectionClass kind = DetectionClass::clutter;
  std::uint64_t id = 0;                             ///< equal on both days
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< m, map frame
  double radius = 0;
  std::vector<Chance> chances;  ///< ascending by scan
};

/// \brief The detections of one drive, assigned to objects.
struct TrackedDrive {
  std::vector<Track> tracks;
  std::vector<Chance> passing;  ///< false detections that belong to no lasting object
  std::size_t scans = 0;
};

TrackedDrive trackDrive(const ObservedDrive& drive, double maxRange);

/// \brief Both days of a street; a lasting false object found on both has the same id.
struct TrackedStreet {
  TrackedDrive first, second;
  std::size_t clutterOnBoth = 0;
};
TrackedStreet trackStreet(const ObservedStreet& street, double maxRange);

}  // namespace polemcl::sim
