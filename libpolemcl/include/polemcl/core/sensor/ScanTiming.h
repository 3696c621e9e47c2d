#pragma once
/// \file ScanTiming.h
/// \brief When the points of a scan were measured: a LiDAR turns while the vehicle moves.

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

/// \brief `turn`, `turn_s`, `cut_deg`, `moving_cut`, `stamp_turn`, `clock_offset_s` in the open
/// section.
POLEMCL_EXPORT void bindTiming(Binder& binder, ScanTiming& timing);

}  // namespace polemcl
