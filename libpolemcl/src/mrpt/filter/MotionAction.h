#pragma once
/// \file MotionAction.h
/// \brief Motion between two scans in the form that MRPT's particle filter takes.

#include <mrpt/obs/CActionCollection.h>

#include <optional>

#include "io/data/PlanarMotion.h"
#include "mrpt/filter/FilterOptions.h"
#include "mrpt/rawlog/PoleSequence.h"

namespace polemcl {

/// Largest standard deviations of a motion, m (x, y) and rad. Beyond them odometry is useless.
constexpr double kMaxMotionMetres = 10, kMaxMotionRadians = 1;

/// Longest motion between two consecutive scans, m, and the greatest turn, rad: sums of turns need
/// not be wrapped.
constexpr double kMaxMotionStep = 10000, kMaxMotionTurn = 1000;

/// Greatest velocity of a scan, m/s and rad/s: above all that stamps close together give.
constexpr double kMaxVelocity = 1e9;

/// \brief Whether a motion is sound, but longer or more uncertain than these limits.
bool isBeyondLimits(const PoseWithCovariance& motion);

/// \brief An action with one `CActionRobotMovement2D` of kind `emScan2DMatching` (this kind
/// survives serialization). It is a Gaussian whose variances are those of the motion plus the
/// squares of the extra sigmas.
/// \throws Error when the motion is not finite, too long or turns too far. Also when its
///         covariance is not symmetric, not positive semidefinite (tolerance for both: 1e-9 of the
///         largest element), or above the limits.
mrpt::obs::CActionCollection::Ptr makeMotionAction(const PoseWithCovariance& motion,
                                                   const FilterOptions& options);

/// \brief Checks a scan: its time, its poles, velocity and sensor pose, and the motion to it, which
/// the first does not need.
/// \param before Time of the scan before, s; nullopt for the first one.
/// \throws Error with the time of the scan when it is not later than `before`, a pole has a fault
///         (faultOf()), the velocity or the sensor pose is none, or the motion is missing; also as
///         makeMotionAction().
void requireStep(const PoleScan& scan, std::optional<double> before);

}  // namespace polemcl
