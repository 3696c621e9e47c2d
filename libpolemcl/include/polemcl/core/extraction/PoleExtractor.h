#pragma once
/// \file PoleExtractor.h
/// \brief Scan in, poles out: steps A to B3 of the paper on one screen, and the scan-line
/// method.

#include <memory>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/core/extraction/ExtractionOptions.h>
#include <polemcl/core/extraction/ExtractionReport.h>
#include <polemcl/core/sensor/SensorOptions.h>
#include <polemcl/export.h>

namespace polemcl {

struct PinholeCamera;  // private to the library

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
  /// \param points Cloud in the LiDAR's own frame, origin at its optical centre, z up (within the
  ///        mounting tilt). Their order only tells which of equally near ones in a pixel counts.
  /// \param upright Shift of an upright pole along x and y per unit of height along z: the known
  /// lean of the lidar. Used by the scan-line method.
  /// \return Poles in that same frame. Heights are above the local ground. Centres of the scan-line
  /// method are those at the height of the lidar, or the nearest that was seen. Times are 0: to
  /// correct a pole for the motion during a turn, set its `timeOffset` to ScanTiming::offset() of
  /// its azimuth, and its `turnRate`.
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
