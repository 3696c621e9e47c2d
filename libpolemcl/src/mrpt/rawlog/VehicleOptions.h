#pragma once
/// \file VehicleOptions.h
/// \brief Several LiDARs on one vehicle.

#include <optional>
#include <string>
#include <vector>

#include <polemcl/export.h>
#include <polemcl/mrpt/observation/ObservationPoleExtractor.h>
#include "core/common/Binder.h"

namespace polemcl {

/// \brief One LiDAR, known by the sensor label of its observations. `[sensor:LABEL]`,
/// `[range_image:LABEL]` and `[scan_line:LABEL]` in INI files.
struct POLEMCL_EXPORT LidarOptions {
  std::string label;
  SensorOptions sensor;
  ExtractionOptions extraction;
  /// x, y, z (m), yaw, pitch, roll (degrees) of the sensor on the vehicle, in the place of the
  /// sensor pose of its observations; or empty.
  std::vector<double> pose = {};

  ObservationPoleExtractorOptions extractor() const;
};

/// \brief The LiDARs whose poles are fused before they are used. `[vehicle]` in INI files.
struct POLEMCL_EXPORT VehicleOptions {
  /// Empty: the scans of one LiDAR are used, that of the first scan, without its label being known.
  std::vector<LidarOptions> lidars;
  double fuseWithin = 0.05;  ///< greatest time between scans that are fused, s (`fuse_within_s`)
  double wait = 0.1;         ///< longest time by which a scan comes after later ones, s (`wait_s`)

  std::optional<std::size_t> indexOf(const std::string& label) const;  ///< in `lidars`
};

/// \brief Binds `[vehicle]`, then the sections of each LiDAR that it lists.
/// \param sensor, extraction What a LiDAR has where its own sections say nothing: already bound.
/// \throws Error also on labels that are no names of sections, and on a label given twice, and on
/// more than 64 of them.
POLEMCL_EXPORT void bind(Binder& binder, VehicleOptions& vehicle, const SensorOptions& sensor,
                         const ExtractionOptions& extraction);
/// \brief Binds the sections of one LiDAR.
POLEMCL_EXPORT void bind(Binder& binder, LidarOptions& lidar);

}  // namespace polemcl
