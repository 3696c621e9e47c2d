#pragma once
/// \file CObservationPoles.h
/// \brief The poles of one scan, as an observation of MRPT.

#include <mrpt/obs/CObservation.h>
#include <mrpt/opengl/Visualizable.h>
#include <mrpt/poses/CPose3D.h>

#include <vector>

#include "core/common/Types.h"

namespace polemcl {

/// \brief The poles seen in one scan, small enough to be stored in a rawlog in its place.
///
/// Frame: the *planar sensor frame*, origin at x, y of `sensorPose`, turned by its yaw, z up. So a
/// pole in the robot frame is `Pose2D(sensorPose) ⊕ (x, y)`; heights are above local ground and
/// know no frame. Covariances are in the same planar frame.
class CObservationPoles : public mrpt::obs::CObservation, public mrpt::opengl::Visualizable {
  DEFINE_SERIALIZABLE(CObservationPoles, polemcl)

 public:
  std::vector<PoleDetection> poles;  ///< planar sensor frame; may be empty: a scan without poles
  mrpt::poses::CPose3D sensorPose;   ///< the sensor in the robot frame
  /// Free range per direction, m (see core/VisibilityRange.h); 0 = unknown. Element i of n looks to
  /// azimuth -pi + (i + 0.5)·2pi/n in the planar sensor frame. Empty: not known for any direction.
  std::vector<float> visibilityRange;
  std::uint32_t points = 0;  ///< valid points of the scan; 0: none, or not known

  /// \brief The poles with centre and covariance moved to the robot frame by the planar part of
  /// `sensorPose`.
  std::vector<PoleDetection> polesInRobotFrame() const;
  /// \brief x, y and yaw of `sensorPose`.
  Pose2D planarSensorPose() const;

  using CObservation::getSensorPose;
  using CObservation::setSensorPose;
  void getSensorPose(mrpt::poses::CPose3D& out_sensorPose) const override;
  void setSensorPose(const mrpt::poses::CPose3D& newSensorPose) override;
  void getDescriptionAsText(std::ostream& o) const override;
  bool exportTxtSupported() const override { return true; }
  std::string exportTxtHeader() const override;
  /// \brief Number of poles, then x y radius bottom top confidence of each.
  std::string exportTxtDataRow() const override;
  /// \brief A cylinder from bottom to top for each pole, robot frame, ground at z = 0.
  void getVisualizationInto(mrpt::opengl::CSetOfObjects& o) const override;
};

}  // namespace polemcl
