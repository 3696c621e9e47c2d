#pragma once
/// \file PointTimes.h
/// \brief How a LiDAR turns, from the times that its points have.

#include <optional>
#include <string>
#include <vector>

#include <polemcl/core/sensor/SensorOptions.h>
#include <polemcl/io/rosbag/PackedCloud.h>

namespace polemcl::io {

/// \brief Estimates the timing of scans. To be fed with the first scans of a recording until it is
/// complete, then with some of the rest, which tell whether the cut moves.
///
/// The azimuth of each point is fitted as a line over its time, in both directions; the better one
/// is the direction of the turn. Its slope gives the duration. The first and the last time of a
/// scan give the moment of the stamp within the turn; the azimuth then is the cut. If the cut moves
/// and all points are in the order of measuring, each scan begins at its first point.
class TimingEstimate {
 public:
  /// \brief Takes a scan into account if it is a full turn: points in three quarters of all
  /// directions.
  void add(const TimedCloud& scan);
  /// \brief Whether the timing needs no more scans.
  bool complete() const;

  /// \brief The timing, medians over the first scans. `automatic` when the points do not tell.
  ScanTiming timing() const;
  /// \brief Note for the user: what was found, or why nothing was.
  std::string note() const;

 private:
  /// One scan: azimuth = atStamp + rate · time.
  struct Fit {
    double rate = 0;     ///< rad/s, above 0: counter-clockwise
    double atStamp = 0;  ///< azimuth at the time stamp, rad
    double middle = 0;   ///< from the stamp to the middle of the turn, s
  };
  static std::optional<Fit> fit(const TimedCloud& scan);
  std::string problem() const;
  bool cutMoves() const;

  std::vector<Fit> m_fits, m_later;  ///< of the first scans, of the rest
  std::size_t m_scans = 0;           ///< in all
  std::size_t m_untimed = 0;         ///< points without times, or all with the same one
  std::size_t m_partial = 0;         ///< not a full turn
  bool m_inOrder = true;             ///< the points of all fits are in the order of measuring
};

}  // namespace polemcl::io
