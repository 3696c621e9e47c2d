#pragma once
/// \file ObservationPoleExtractor.h
/// \brief Preprocessor: converts any LiDAR or depth observation of MRPT to CObservationPoles.

#include <memory>
#include <optional>

#include <polemcl/core/extraction/ExtractionOptions.h>
#include <polemcl/core/extraction/PoleExtractor.h>
#include <polemcl/core/sensor/SensorOptions.h>
#include <polemcl/export.h>
#include <polemcl/io/data/Cloud.h>
#include <polemcl/mrpt/observation/CObservationPoles.h>

namespace polemcl {

struct POLEMCL_EXPORT ObservationPoleExtractorOptions {
  SensorOptions sensor;
  ExtractionOptions extraction;
  /// Pose of the sensor in the robot frame, in the place of that of the observations.
  std::optional<mrpt::poses::CPose3D> sensorPose = {};

  /// \throws Error when it has a number that is not finite.
  mrpt::poses::CPose3D poseOf(const mrpt::obs::CObservation& observation) const;
};

/// \brief Extracts the poles of observations. Reuses its buffers: use one object per thread.
///
/// Points are transformed to the *LiDAR frame* of PoleExtractor. Its axes depend on the mounting:
/// - Usually they are the axes of the cloud. Beams thus stay cones around z for any tilt of the
///   mounting.
/// - If the cloud's z axis points down in the robot frame (NCLT's body frame), they are turned by
///   180° about x.
/// - If the cloud is tilted by more than 45° (optical frames of cameras), they are level with the
///   robot and rotated by the sensor's yaw.
///
/// The origin is that of the cloud, shifted by `SensorOptions::origin` along the robot's axes.
/// Points are not copied if no transformation is needed. Poles are transformed to the planar sensor
/// frame at the height where their centre is known (of the sensor; `rangeImage`: their middle), so
/// that a tilted mounting does not shift them.
///
/// Sources of the points by class:
/// - CObservationPointCloud: the cloud as it is; external storage is loaded and unloaded.
/// - CObservationVelodyneScan: its cloud; without one, that of its packets.
/// - CObservation3DRangeScan: its depth image, with the camera's intrinsics and lens distortion
///   (plumb_bob; what lies outside the undistorted image of the same size is not used). The method
///   scan_line treats pixel rows as rings for any `model`, in a level frame at the optical centre
///   (`origin` is not used). Without an image, its cloud is treated as that of a LiDAR.
/// - CObservationRotatingScan: its range image, with elevations from `[sensor]`. The number of
///   rings must equal the number of the sensor's beams.
class POLEMCL_EXPORT ObservationPoleExtractor {
 public:
  /// \brief The points of a scan are not in the order of measuring, which `moving_cut` needs.
  class POLEMCL_EXPORT UnorderedScan : public Error {
   public:
    UnorderedScan();
  };

  /// \throws Error when an option is out of range.
  explicit ObservationPoleExtractor(const ObservationPoleExtractorOptions& options);
  ~ObservationPoleExtractor();
  ObservationPoleExtractor(ObservationPoleExtractor&&) noexcept;
  ObservationPoleExtractor& operator=(ObservationPoleExtractor&&) noexcept;

  /// \brief Whether the class is in the list above.
  static bool canProcess(const mrpt::obs::CObservation& observation);

  /// \brief The poles, with time, label and sensor pose of the observation (or that of the
  /// options). A scan without valid points gives no poles and `points` = 0.
  ///
  /// The first three scans with enough points are compared with the configuration
  /// (SensorConfigCheck), unless `SensorOptions::checkBeams` is off. Depth images are not compared.
  /// \throws Error for other classes, unreadable external files, a rotating scan with unknown
  ///         elevations, a depth image without usable intrinsics. Also when a compared scan
  ///         contradicts the configuration. UnorderedScan.
  CObservationPoles::Ptr process(const mrpt::obs::CObservation& observation);
  /// \brief Sets whether the next process() compares its scan, instead of counting to three. For
  /// several objects that share the scans of one rawlog.
  void checkNext(bool compare);
  /// \brief What the recording says of the measuring times of its scans; used if `[sensor] turn =
  /// auto` and the observation itself says nothing. process() sets PoleDetection::timeOffset of
  /// each pole accordingly.
  void setRecordedTiming(const ScanTiming& timing);
  /// \brief Copy of the points that process() passes to PoleExtractor, LiDAR frame.
  /// \throws Error as process().
  io::Cloud lidarPoints(const mrpt::obs::CObservation& observation);
  /// \brief Counters of the last process().
  const ExtractionReport& report() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

}  // namespace polemcl
