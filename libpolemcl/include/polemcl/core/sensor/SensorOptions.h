#pragma once
/// \file SensorOptions.h
/// \brief The settings of the sensor, with units, defaults and sources.

#include <string>
#include <vector>

#include <polemcl/core/common/Binder.h>
#include <polemcl/core/sensor/ScanTiming.h>
#include <polemcl/export.h>

namespace polemcl {

/// \brief The LiDAR's geometry and mounting. `[sensor]` in INI files.
struct POLEMCL_EXPORT SensorOptions {
  /// Names as in SensorModel::modelNames(): rings of a data sheet, or as measured
  /// (`hdl64e`: KITTI's unit; `os1_64_gen2`). `table`: `elevations_deg`; `uniform`: `rings` rings
  /// from `fov_up_deg` to `fov_down_deg`.
  std::string model = "hdl64e";
  /// Upside down mounting: the rings are listed as seen upright, z up (elevations change sign).
  bool upsideDown = false;
  std::vector<double> elevations;  ///< rad, any order, only for `table` (`elevations_deg`)
  /// Lower block of a two-block sensor (HDL-64E), all below those of `elevations`, rad, only for
  /// `table` (`lower_elevations_deg`).
  std::vector<double> lowerElevations;
  /// Where the beams of `elevations` and of `lowerElevations` start, above the origin, m, only for
  /// `table` (`apex_m = upper lower`).
  double upperApex = 0, lowerApex = 0;
  int rings = 64;                                     ///< number, only for `uniform`
  double fovUp = 2.0 * 3.14159265358979323846 / 180;  ///< rad, only for `uniform` (`fov_up_deg`)
  double fovDown =
      -24.83 * 3.14159265358979323846 / 180;  ///< rad, only for `uniform` (`fov_down_deg`)
  int columns = 0;                            ///< firing steps of a turn; 0: those of the model
  double height = 1.73;                       ///< optical centre above ground, m (`height_m`)
  /// Optical centre in the *robot frame after the sensor pose*, when clouds come in another frame
  /// than the LiDAR's own (NCLT: body frame, 0.957 m above its origin): `origin = x y z`, m.
  double originX = 0, originY = 0, originZ = 0;
  double minRange = 1.0;   ///< m, nearer returns are the vehicle
  double maxRange = 60.0;  ///< m
  ScanTiming timing;       ///< when the points of a scan are measured (`turn`, …)
  /// ObservationPoleExtractor and the programs compare the first scans with the rings above and
  /// refuse scans that contradict them. PoleExtractor does not.
  bool checkBeams = true;
};

POLEMCL_EXPORT void bind(Binder& binder, SensorOptions& options);  ///< `[sensor]`

}  // namespace polemcl
