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

}  // namespace polemcl
