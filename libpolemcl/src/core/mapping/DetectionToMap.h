#pragma once
/// \file DetectionToMap.h
/// \brief A scan's detections at a known pose -> observations in the map frame.

#include <string>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "core/mapping/LandmarkFusion.h"

namespace polemcl {

/// \brief How far poses of scans can be trusted.
struct PoseTrust {
  double sigma = 0;         ///< of the position, m
  double headingSigma = 0;  ///< rad
  /// Covariance of this pose beyond that: x, y, yaw; m², m·rad, rad².
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// \brief A detection in the map frame, made less certain by what the scan's pose is not known to.
/// \param pole Robot frame. \param pose Robot in the map frame. \param scan Number of the scan.
LandmarkObservation landmarkObservation(const PoleDetection& pole, const Pose2D& pose,
                                        std::uint32_t scan, const PoseTrust& trust);

/// \throws Error on a pose or detection that is not finite, a confidence outside [0, 1], or a
///         covariance that is not symmetric positive semidefinite, naming the detection.
/// \param where Names the scan, e.g. "scan 12".
void checkScan(const Pose2D& pose, const std::vector<PoleDetection>& poles,
               const std::string& where);

}  // namespace polemcl
