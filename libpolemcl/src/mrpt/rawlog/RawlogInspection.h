#pragma once
/// \file RawlogInspection.h
/// \brief What LiDAR made the scans of a rawlog?

#include <mrpt/poses/CPose3D.h>

#include <string>
#include <vector>

#include "core/sensor/SensorIdentification.h"

namespace polemcl {

struct RawlogInspection {
  std::size_t scans = 0;          ///< in the rawlog
  std::vector<std::size_t> used;  ///< 0-based indices of those that were looked at
  std::string label;              ///< class and sensor label of the scans
  mrpt::poses::CPose3D sensorPose;
  /// In the lidar frame of ObservationPoleExtractor before `origin` is applied.
  SensorIdentification sensor;
  /// `[sensor]` for this rawlog; `origin` is along the robot's axes. When `sensor.onItsHead`, for
  /// the same clouds with a sensor pose that tells so.
  SensorOptions options;
};

/// \brief Looks at up to eight scans, spread over the rawlog.
/// \throws Error as RawlogReader, ObservationPoleExtractor and estimateBeamTable() do, naming the
/// file; when there is
///         no scan, or scans have no beams by nature (depth cameras) or do not tell their
///         elevations (rotating scans).
RawlogInspection inspectRawlog(const std::string& path, bool allowTruncated = false);

}  // namespace polemcl
