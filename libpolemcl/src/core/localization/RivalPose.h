#pragma once
/// \file RivalPose.h
/// \brief Do the poles without a match fit the map at another pose, all at the same?

#include <cstddef>
#include <vector>

#include "core/localization/MapAssociation.h"

namespace polemcl {

/// \brief Another pose near the estimate that detections without a match have in common.
struct RivalPose {
  Pose2D motion;                   ///< from the estimate, in its frame, m, rad
  std::vector<std::size_t> poles;  ///< of the map, without a match, that are seen from there: two
                                   ///< or more, ascending; none: there is no such pose
};

/// \brief The pose within 1.5 m and 7 degrees, but not within 0.15 m and 1 degree, at which most
/// detections without a match stand on poles of the map without one: as when one of two LiDARs has
/// moved. They are more than half of those that could do so at some pose within these limits; where
/// many poles are new beside those that are gone, some fit by chance.
/// \param matches Of associate(). Other parameters as there.
POLEMCL_EXPORT RivalPose findRival(const std::vector<PoleDetection>& poles_robot,
                                   const std::vector<PoleMatch>& matches, const Pose2D& robot,
                                   const PoleIndex& index, const AssociationOptions& options);

}  // namespace polemcl
