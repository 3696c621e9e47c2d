#pragma once
/// \file ObservationPoleExtractor.h
/// \brief The preprocessor: any LiDAR or depth observation of MRPT -> CObservationPoles.

#include <memory>

#include "core/extraction/ExtractionOptions.h"
#include "core/extraction/PoleExtractor.h"
#include "core/sensor/SensorOptions.h"
#include "io/data/Cloud.h"
#include "mrpt/observation/CObservationPoles.h"

namespace polemcl {

struct ObservationPoleExtractorOptions {
  SensorOptions sensor;
  ExtractionOptions extraction;
};

/// \brief Extracts the poles of observations; keeps its buffers, so one object serves one thread.
///
/// Points go to the *lidar frame* that PoleExtractor takes. Its axes are those of the cloud, so
/// that beams stay cones around z whatever the mounting's tilt; turned by 180° about x when the
/// cloud's z axis points down in the robot frame (NCLT's body frame); level with the robot and
/// turned by the sensor's yaw when the cloud lies on its side (more than 45° off: optical frames of
/// cameras). Its origin is that of the cloud moved by `SensorOptions::origin`, along the robot's
/// axes. Nothing is copied when nothing is to be moved. Poles go from there to the planar sensor
/// frame at their middle height, so that a tilted mounting does not shift them.
///
/// | observation | points |
/// |---|---|
/// | CObservationPointCloud | as they are; external storage is loaded and unloaded |
/// | CObservationVelodyneScan | its cloud, generated on a copy when it has none |
/// | CObservation3DRangeScan | its depth image, by the camera's intrinsics (without distortion);
/// the native method takes its rows of pixels for beams, whatever `model` says, in a level frame at
/// the optical centre (`origin` is not used). Without an image, its cloud, as a LiDAR's | |
/// CObservationRotatingScan | range image, elevations from
/// `[sensor]`: refused unless its rows equal the sensor's beams |
class ObservationPoleExtractor {
 public:
  /// \throws Error when an option is out of range.
  explicit ObservationPoleExtractor(const ObservationPoleExtractorOptions& options);
  ~ObservationPoleExtractor();
  ObservationPoleExtractor(ObservationPoleExtractor&&) noexcept;
  ObservationPoleExtractor& operator=(ObservationPoleExtractor&&) noexcept;

  /// \brief True for the classes of the table above.
  static bool canProcess(const mrpt::obs::CObservation& observation);

  /// \brief The poles, with time, label and sensor pose of the observation. A scan without any
  /// valid point gives no poles and `points` = 0. \throws Error on other classes, on external files
  /// that cannot be read, on a rotating scan
  ///         whose elevations are not known, on a depth image without usable intrinsics.
  ///
  /// The first three scans with enough points are compared with the configuration
  /// (SensorConfigCheck); \throws Error when one contradicts it, unless `SensorOptions::checkBeams`
  /// is off. Depth images are not compared.
  CObservationPoles::Ptr process(const mrpt::obs::CObservation& observation);
  /// \brief Whether the next process() compares, instead of counting to three: for those who share
  /// the scans of one rawlog among several objects.
  void checkNext(bool compare);
  /// \brief The points that process() hands to PoleExtractor: a copy, lidar frame.
  /// \throws Error as process().
  io::Cloud lidarPoints(const mrpt::obs::CObservation& observation);
  /// \brief Counters of the last process().
  const ExtractionReport& report() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

}  // namespace polemcl
