#pragma once
/// \file SensorOptions.h
/// \brief The settings of the sensor, and when its points are measured.

#include <string>
#include <utility>
#include <vector>

#include <polemcl/export.h>

namespace polemcl {

class Binder;

/// \brief How the points of a scan follow each other in time.
enum class Turn {
  automatic,    ///< as the recording says; compensated if it says nothing
  compensated,  ///< all points as if measured at the time stamp
  clockwise,    ///< seen from above, z up in the frame of the cloud
  counterclockwise
};

/// \brief Measuring times of a LiDAR that turns at constant speed. In `[sensor]` of INI files, and
/// in the comment of a rawlog.
struct POLEMCL_EXPORT ScanTiming {
  Turn turn = Turn::automatic;
  double seconds = 0.1;                 ///< duration of a turn, s (`turn_s`)
  double cut = 3.14159265358979323846;  ///< azimuth at which a scan begins and ends, frame of the
                                        ///< cloud, rad (`cut_deg`)
  double stamp =
      0.5;  ///< moment of the time stamp: 0 the begin of the turn, 1 its end (`stamp_turn`)
  /// Added to the stamps: the clocks of scans and odometry or truth may differ, s
  /// (`clock_offset_s`). For compensated scans as well.
  double clock = 0;
  /// Each scan begins at its first point, not at `cut`: for clouds in the order of measuring whose
  /// begin moves (`moving_cut`).
  bool movingCut = false;

  /// \brief Whether points have measuring times of their own.
  bool known() const { return turn == Turn::clockwise || turn == Turn::counterclockwise; }
  /// \brief Time from the stamp, in the clock of the odometry, to the moment the LiDAR faces
  /// `azimuth`, s; `clock` unless known().
  /// \param azimuth In the frame of the cloud, rad, any number of turns.
  double offset(double azimuth) const;
  /// \brief rad/s, positive counterclockwise; 0 unless known().
  double turnRate() const;
};

/// \brief The words of INI files.
POLEMCL_EXPORT const std::vector<std::pair<Turn, std::string>>& turnNames();
/// \brief Its word there.
POLEMCL_EXPORT const std::string& name(Turn turn);

/// \brief `turn`, `turn_s`, `cut_deg`, `moving_cut`, `stamp_turn`, `clock_offset_s` in the open
/// section.
POLEMCL_EXPORT void bindTiming(Binder& binder, ScanTiming& timing);

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
  double fovDown = static_cast<double>(-24.83L * 3.14159265358979323846L /
                                       180);  ///< rad, only for `uniform` (`fov_down_deg`)
  int columns = 0;                            ///< firing steps of a turn; 0: those of the model
  double height = 1.73;                       ///< optical centre above ground, m (`height_m`)
  /// Optical centre in the *robot frame after the sensor pose*, when clouds come in another frame
  /// than the LiDAR's own (NCLT: body frame, 0.957 m above its origin): `origin = x y z`, m.
  double originX = 0, originY = 0, originZ = 0;
  double minRange = 1.0;   ///< m, nearer returns are the vehicle
  double maxRange = 60.0;  ///< m
  /// Corrects the distance of each pole: scale * distance + offset. LiDARs measure some centimetres
  /// too short or too long; the error often depends on the distance.
  double rangeOffset = 0;  ///< m (`range_offset_m`)
  double rangeScale = 1;   ///< (`range_scale`)
  ScanTiming timing;       ///< when the points of a scan are measured (`turn`, …)
  /// ObservationPoleExtractor and the programs compare the first scans with the rings above and
  /// refuse scans that contradict them. PoleExtractor does not.
  bool checkBeams = true;
};

POLEMCL_EXPORT void bind(Binder& binder, SensorOptions& options);  ///< `[sensor]`

}  // namespace polemcl
