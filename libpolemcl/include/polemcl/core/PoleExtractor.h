#pragma once
/// \file PoleExtractor.h
/// \brief Scan in, poles out: steps A to B3 of the paper on one screen, and the native method.

#include <polemcl/core/ExtractionOptions.h>
#include <polemcl/core/PinholeCamera.h>
#include <polemcl/core/Types.h>

#include <memory>
#include <vector>

namespace polemcl {

/// \brief Why a candidate is no pole. Counted per scan, so that a setting can be judged.
enum class Refusal {
  tooFewPoints,
  tooWide,        ///< wider than tall, or wider than any pole
  notForeground,  ///< something nearer stands beside it
  tooLow,         ///< its top is below `min_top_m`
  startsTooHigh,  ///< its bottom is above `max_bottom_m`
  tooShort,       ///< its visible height is below `min_height_m`
  badFit,         ///< no circle, or a radius out of range
  notFree,        ///< its surroundings are not free
  tilted,         ///< its axis leans more than `max_tilt_deg`
  notStraight,    ///< its slices do not stand above one another
  lowConfidence,
  duplicate,  ///< beside a more confident one
  count_      ///< number of reasons
};
const char* name(Refusal reason);

/// \brief Counters of one extraction.
struct ExtractionReport {
  std::size_t points = 0;      ///< in the cloud
  std::size_t invalid = 0;     ///< NaN, infinite, or at the sensor: dropped
  std::size_t outOfView = 0;   ///< match no beam: dropped
  std::size_t outOfRange = 0;  ///< dropped
  std::size_t candidates = 0;
  std::size_t refused[static_cast<int>(Refusal::count_)] = {};
  double ground = 0;  ///< median height of the ground below the sensor origin, m (negative)
};

/// \brief Extracts poles; keeps its buffers between scans, so one object serves one thread.
class PoleExtractor {
 public:
  /// \throws Error when an option is out of range or the sensor's geometry is unknown.
  explicit PoleExtractor(const SensorOptions& sensor, const ExtractionOptions& extraction);
  /// \brief For the depth images of one camera, by the native method. Of `sensor` only the height
  /// and the ranges are used. extract() takes points in a level frame with the origin at the
  /// optical centre, in which the camera stands as `R_lidar_camera` says.
  /// \throws Error when an option or an intrinsic is out of range.
  PoleExtractor(const PinholeCamera& camera, const SensorOptions& sensor,
                const NativeOptions& options);
  ~PoleExtractor();
  PoleExtractor(PoleExtractor&&) noexcept;
  PoleExtractor& operator=(PoleExtractor&&) noexcept;

  /// \brief Poles of one full turn, sorted by azimuth then range so that the order is defined.
  /// \param points Cloud in the LiDAR's own frame, origin at its optical centre, z up
  ///        (within the mounting tilt; see SensorOptions). Order of points is of no consequence.
  /// \param upright By so much an upright pole moves along x and y per height along z: the known
  /// lean of the lidar. Used by the native method.
  /// \return Poles in that same frame; heights above the local ground. Centres of the native method
  /// are those at the height of the lidar, or the nearest that was seen.
  const std::vector<PoleDetection>& extract(
      const PointsView& points, const Eigen::Vector2f& upright = Eigen::Vector2f::Zero());
  const ExtractionReport& report() const;
  /// \brief Of the last scan: FreeRangeFinder::kSectors free ranges (see there), m, in the frame of
  /// the points. Empty by the paper's method and of depth cameras: not known.
  const std::vector<float>& freeRange() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

}  // namespace polemcl
