#pragma once
/// \file TimingSearch.h
/// \brief When the points of a scan were measured, and how far off its ranges are, found from the
/// poles of a drive.
///
/// A standing pole has one place. With the right measuring times and ranges, successive scans agree
/// on it best.

#include <optional>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/core/sensor/SensorOptions.h>

namespace polemcl {

/// \brief Standard errors by which an estimate must be better than none.
constexpr double kEnoughErrors = 4;

/// \brief Greatest clock offset that is searched, s.
constexpr double kGreatestClock = 0.15;

/// \brief A pole as it was measured.
struct TimedPole {
  double x = 0, y = 0;  ///< robot frame at the moment it was measured, m
  double azimuth = 0;   ///< in the frame of the cloud, rad
};

/// \brief A scan of a drive. Poses may drift: only the motion over some metres matters.
struct TimedScan {
  double time = 0;  ///< its stamp, s
  Pose2D pose_map_robot;
  std::vector<TimedPole> poles_robot;
};

/// \brief What fits a drive best.
struct TimingEstimate {
  /// compensated, or the direction of turning, with `seconds` as given and `stamp` = 0.5; or what
  /// was stated, see `isStated`. Its `clock` is 0 unless the drive shows another one.
  ScanTiming timing;
  std::size_t pairs = 0;  ///< of sightings of one pole in two scans
  double before = 0;      ///< mean distance of a pair, all as measured at the stamps, m
  double after = 0;       ///< the same with `timing`, m
  /// Standard errors by which turning is better than not turning; if `isStated`, by which the best
  /// other timing is better.
  double turnSignificance = 0;
  double clockSignificance = 0;  ///< standard errors by which the best clock is better than 0
  /// The best turn, where it is better than none by too few standard errors; else not known().
  ScanTiming candidate;
  double withCandidate = 0;  ///< mean distance of a pair with it, m
  bool isStated = false;     ///< `timing` is the stated one, but for `clock`
};

/// \brief What corrects the distance of a pole from the LiDAR: scale * distance + offset.
struct RangeCorrection {
  double offset = 0;  ///< m
  double scale = 1;
  double before = 0, after = 0;  ///< mean distance of a pair without and with it, m
  double significance = 0;       ///< standard errors by which it is better than none
  /// \brief Whether it is better, and within what `[sensor]` allows.
  bool isClear() const;
};

/// \brief Searches directions, cuts and clock offsets (±kGreatestClock).
/// \param turnSeconds Duration of a turn of the LiDAR, s.
/// \param stated Of the file, if `known()`: kept unless another one is better by kEnoughErrors. Its
///        `movingCut` must be false.
/// \param clocks False: clocks do not differ; much quicker.
/// \return `pairs` is 0 where no pole was seen twice.
TimingEstimate searchTiming(const std::vector<TimedScan>& scans, double turnSeconds,
                            const ScanTiming& stated = {}, bool clocks = true);

/// \brief Fits the pairs by least squares (Cauchy's weights). A pole that one drives past shows the
/// offset: ahead and behind, it errs in opposite directions. A scale of the poses cannot be told
/// from one of the ranges.
/// \param timing As found. \param lidar_robot The LiDAR in the robot frame, m.
/// \return None with fewer than 100 pairs, or where they do not tell it, as those of a vehicle that
///         stands.
std::optional<RangeCorrection> searchRangeCorrection(const std::vector<TimedScan>& scans,
                                                     const ScanTiming& timing,
                                                     const Eigen::Vector2d& lidar_robot);

}  // namespace polemcl
