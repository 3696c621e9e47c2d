#pragma once
/// \file CObservationPoles.h
/// \brief The poles of one scan as an observation of MRPT.

#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose3D.h>

#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>
#include <polemcl/mrpt/common/Compatibility.h>

namespace polemcl {

/// \brief The poles of one scan, small enough to replace the scan in a rawlog.
///
/// Frame: the *planar sensor frame*, with its origin at x, y of `sensorPose`, rotated by its yaw, z
/// up. A pole in the robot frame is `Pose2D(sensorPose) ⊕ (x, y)`. Heights are above local ground
/// and independent of the frame. Covariances are in the planar sensor frame.
class POLEMCL_EXPORT CObservationPoles : public mrpt::obs::CObservation, public viz::Visualizable {
  DEFINE_SERIALIZABLE(CObservationPoles, polemcl)

 public:
  std::vector<PoleDetection> poles;  ///< planar sensor frame; empty: a scan without poles
  mrpt::poses::CPose3D sensorPose;   ///< pose of the sensor in the robot frame
  /// Visibility range per direction, m (see core/extraction/VisibilityRange.h); 0 = unknown.
  /// Element i of n has the azimuth -pi + (i + 0.5)·2pi/n in the planar sensor frame. Empty:
  /// unknown in all directions.
  std::vector<float> visibilityRange;
  std::uint32_t points = 0;  ///< valid points of the scan; 0: none or unknown

  /// \brief The poles with centre and covariance transformed to the robot frame by the planar part
  /// of `sensorPose`.
  std::vector<PoleDetection> polesInRobotFrame() const;
  /// \brief x, y and yaw of `sensorPose`.
  Pose2D planarSensorPose() const;

  using CObservation::getSensorPose;
  using CObservation::setSensorPose;
  void getSensorPose(mrpt::poses::CPose3D& out_sensorPose) const override {
    out_sensorPose = sensorPose;
  }
  void setSensorPose(const mrpt::poses::CPose3D& newSensorPose) override;
  void getDescriptionAsText(std::ostream& o) const override;
  bool exportTxtSupported() const override { return true; }
  std::string exportTxtHeader() const override;
  /// \brief Number of poles, then x y radius bottom top confidence of each.
  std::string exportTxtDataRow() const override;
  /// \brief A cylinder from bottom to top for each pole, robot frame, ground at z = 0.
  void getVisualizationInto(viz::CSetOfObjects& o) const override;
};

}  // namespace polemcl
