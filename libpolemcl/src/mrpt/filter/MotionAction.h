#pragma once
/// \file MotionAction.h
/// \brief A motion between two scans, as MRPT's particle filter takes it.

#include <mrpt/obs/CActionCollection.h>

#include "io/data/PlanarMotion.h"
#include "mrpt/filter/FilterOptions.h"

namespace polemcl {

/// Largest standard deviations a motion may have, m (x, y) and rad: beyond, odometry says nothing.
constexpr double maxMotionMetres = 10, maxMotionRadians = 1;

/// Longest motion from one scan to the next, m.
constexpr double maxMotionStep = 10000;

/// \brief An action with one `CActionRobotMovement2D`, `emScan2DMatching` (so that it survives
/// serialization), a Gaussian whose variances are those of the motion plus the extra sigmas
/// squared. \throws Error when the motion is not finite or too long, or its covariance not
/// symmetric, not positive
///         semidefinite (both but for rounding: 1e-9 of its largest element), or above the limits.
mrpt::obs::CActionCollection::Ptr makeMotionAction(const io::PlanarMotion& motion,
                                                   const FilterOptions& options);

}  // namespace polemcl
