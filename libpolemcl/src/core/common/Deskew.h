#pragma once
/// \file Deskew.h
/// \brief Corrects detections for the motion of the vehicle during the scan.

#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>

namespace polemcl {

/// \brief Constant velocity that leads to `motion` in `seconds` (> 0), along a circular arc.
POLEMCL_EXPORT Velocity velocityOf(const Pose2D& motion, double seconds);
/// \brief Pose after moving at constant velocity for `seconds` (may be negative), relative to the
/// start.
POLEMCL_EXPORT Pose2D motionAfter(const Velocity& velocity, double seconds);

/// \brief Corrects the radius of each detection for its motion while the beam crossed it, moves it
/// to where it is seen from at the time stamp of the scan, and sets its `timeOffset` and `turnRate`
/// to 0.
///
/// A pole that moves with the beam is swept for longer and looks wider, one that moves against it
/// narrower. The LiDAR is taken to turn about the origin of the robot.
/// \param poles Robot frame at the moment each was measured.
POLEMCL_EXPORT void deskew(std::vector<PoleDetection>& poles, const Velocity& velocity);

}  // namespace polemcl
