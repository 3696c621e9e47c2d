#pragma once
/// \file RawlogActions.h
/// \brief Motions the way rawlogs keep them.

#include <mrpt/core/Clock.h>
#include <mrpt/obs/CActionCollection.h>

#include <optional>

#include "io/data/PlanarMotion.h"

namespace polemcl::apps {

/// \brief The motion up to a scan as the action before it: one `CActionRobotMovement2D` with
/// `emScan2DMatching` (the default, `emOdometry`, does not store `poseChange`) and a
/// `CPosePDFGaussian`. No motion: an empty collection.
mrpt::obs::CActionCollection makeActions(const std::optional<PoseWithCovariance>& motion,
                                         const mrpt::Clock::time_point& stamp);

/// \brief Identity, the motion before the first scan: with the least deviations that a motion has
/// in rawlogs, since filters want a positive definite covariance.
PoseWithCovariance standstill();

}  // namespace polemcl::apps
