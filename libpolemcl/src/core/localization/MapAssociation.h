#pragma once
/// \file MapAssociation.h
/// \brief Which observed poles stand on the map, if the robot is where the estimate says.

#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>
#include "core/common/PoleIndex.h"
#include "core/common/PoseEstimate.h"

namespace polemcl {

/// \brief One observed pole against the map.
struct PoleMatch {
  double confidence = 1;  ///< of the detection, in [0, 1]
  bool matched = false;   ///< it has a map pole to itself, within the gates
  std::size_t pole = 0;   ///< index of that map pole; 0 without a match
  /// Squared Mahalanobis distance from it, 2 degrees of freedom; 0 without a match.
  double squared = 0;
};

/// \brief When an observed pole counts as one of the map.
struct AssociationOptions {
  double sigma = 0.05;  ///< of map against place, beside both covariances, m
  double gate = 3.5;    ///< greatest Mahalanobis distance (99.8 % of two-dimensional errors)
  double reach = 1.0;   ///< greatest distance, m: an estimate that knows nothing matches nothing
};

/// \brief One to one, the nearest pairs by Mahalanobis distance first. The covariance of a pair is
/// that of the detection, of the map pole (half its trace on both axes), sigma² and that of the
/// pose, whose heading moves what is far away.
/// \param poles_robot Detections, robot frame. \param robot Map frame. \return Element i belongs to
/// detection i; detections that are not finite match nothing.
POLEMCL_EXPORT std::vector<PoleMatch> associate(const std::vector<PoleDetection>& poles_robot,
                                                const PoseWithCovariance& robot,
                                                const PoleIndex& index,
                                                const AssociationOptions& options);

/// \brief Poles near the robot, of a scan and of the map.
struct NearPoles {
  double seen = 0;      ///< sum of the confidences of observed poles
  double matched = 0;   ///< of those on the map
  double expected = 0;  ///< number of map poles that the scan could see, if the robot is there
};

/// \brief Within 20 m, where each LiDAR sees most poles. Without visibility ranges, each map pole
/// there is expected.
/// \param matches Of the poles of the scan. \param robot Map frame.
/// \param poles Of the map, those of `index`.
POLEMCL_EXPORT NearPoles nearPoles(const PoleScan& scan, const std::vector<PoleMatch>& matches,
                                   const Pose2D& robot, const PoleIndex& index,
                                   const std::vector<MapPole>& poles);

}  // namespace polemcl
