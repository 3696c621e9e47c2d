#pragma once
/// \file RawlogInspection.h
/// \brief Identifies the LiDAR that made the scans of a rawlog.

#include <mrpt/poses/CPose3D.h>

#include <string>
#include <vector>

#include "core/sensor/PointOrder.h"
#include "core/sensor/SensorIdentification.h"

namespace polemcl {

struct RawlogInspection {
  std::size_t scans = 0;          ///< number of scans in the rawlog
  std::vector<std::size_t> used;  ///< 0-based indices of the examined scans
  std::string label;              ///< class and sensor label of the scans
  mrpt::poses::CPose3D sensorPose;
  /// In the LiDAR frame of ObservationPoleExtractor before `origin` is applied.
  SensorIdentification sensor;
  /// `[sensor]` for this rawlog; `origin` is along the robot's axes. If `sensor.onItsHead`, the
  /// options are for the same clouds with a sensor pose that is corrected accordingly.
  SensorOptions options;
  /// As the comment of the rawlog states it, or the packets of the examined scans do. Not `known()`
  /// where they do not, or where the cut moves.
  ScanTiming stated;
  bool isTimed = false;  ///< comment or packets state how it turns, also where the cut moves
  /// One for each examined scan; empty if the points of one are not in the order of measuring.
  std::vector<PointOrder> orders;
};

/// \brief Examines up to eight scans, spread over the rawlog.
/// \throws Error with the file, as RawlogReader, ObservationPoleExtractor and estimateBeamTable()
///         do. Also when there is no scan, when the scans have no beams (depth cameras), or when
///         they do not state their elevations (rotating scans).
RawlogInspection inspectRawlog(const std::string& path, bool allowTruncated = false);

}  // namespace polemcl
