#pragma once
/// \file PoleExtractor.h
/// \brief Scan in, poles out: steps A to B3 of the paper on one screen, and the scan-line
/// method.

#include <cstddef>
#include <memory>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/core/extraction/ExtractionOptions.h>
#include <polemcl/core/sensor/SensorOptions.h>
#include <polemcl/export.h>

namespace polemcl {

struct PinholeCamera;  // private to the library

/// \brief Why a candidate is no pole. Counted per scan, so that a setting can be judged.
enum class RejectionReason {
  tooFewPoints,
  tooWide,        ///< wider than tall, or wider than any pole
  notForeground,  ///< something nearer stands beside it
  tooLow,         ///< its top is below `min_top_m`
  startsTooHigh,  ///< its bottom is above `max_bottom_m`
  tooShort,       ///< its visible height is below `min_height_m`
  badFit,         ///< no circle, or a radius out of range
  notFree,        ///< its surroundings are not free
  tilted,         ///< its axis leans more than `max_tilt_deg`
  notStraight,    ///< its segments do not stand above one another
  lowConfidence,
  duplicate,  ///< beside a more confident one
  count_      ///< number of reasons
};
POLEMCL_EXPORT const char* name(RejectionReason reason);

/// \brief Counters of one extraction.
struct ExtractionReport {
  std::size_t points = 0;      ///< in the cloud
  std::size_t invalid = 0;     ///< NaN, infinite, or at the sensor: dropped
  std::size_t outOfView = 0;   ///< match no beam: dropped
  std::size_t outOfRange = 0;  ///< dropped
  std::size_t candidates = 0;
  std::size_t refused[static_cast<int>(RejectionReason::count_)] = {};
  double ground = 0;  ///< median height of the ground below the sensor origin, m (negative)

  /// \brief Adds the counters of another scan; the height of the ground is that of the first.
  POLEMCL_EXPORT ExtractionReport& operator+=(const ExtractionReport& other);
};

/// \brief Extracts poles; keeps its buffers between scans, so one object serves one thread.
class POLEMCL_EXPORT PoleExtractor {
 public:
  /// \throws Error when an option is out of range or the sensor's geometry is unknown.
  explicit PoleExtractor(const SensorOptions& sensor, const ExtractionOptions& extraction);
  /// \brief For the depth images of one camera. Only the height and the ranges of `sensor` are
  /// used. extract() takes points in a level frame with the origin
  /// at the optical centre, in which the camera stands as `R_lidar_camera` says.
  /// \throws Error when an option or an intrinsic is out of range.
  PoleExtractor(const PinholeCamera& camera, const SensorOptions& sensor,
                const ExtractionOptions& extraction);
  ~PoleExtractor();
  PoleExtractor(PoleExtractor&&) noexcept;
  PoleExtractor& operator=(PoleExtractor&&) noexcept;

  /// \brief Poles of one full turn, sorted by azimuth then range so that the order is defined.
  /// \param points Cloud in the LiDAR's own frame, origin at its optical centre, z up
  ///        (within the mounting tilt; see SensorOptions). The order of points does not matter.
  /// \param upright Shift of an upright pole along x and y per unit of height along z: the known
  /// lean of the lidar. Used by the scan-line method.
  /// \return Poles in that same frame; heights above the local ground. Centres of the scan-line
  /// method are those at the height of the lidar, or the nearest that was seen.
  const std::vector<PoleDetection>& extract(
      const PointsView& points, const Eigen::Vector2f& upright = Eigen::Vector2f::Zero());
  const ExtractionReport& report() const;
  /// \brief Visibility ranges of the last scan: VisibilityRangeFinder::kSectors (see there), m, in
  /// the frame of the points. Empty for the paper's method and for depth cameras: not known.
  const std::vector<float>& visibilityRange() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

}  // namespace polemcl
