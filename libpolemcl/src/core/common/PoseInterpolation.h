#pragma once
/// \file PoseInterpolation.h
/// \brief Where a trajectory was at a time between its samples.

#include <optional>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "core/common/Deskew.h"

namespace polemcl {

/// \brief Times closer to a sample than this are taken as its own, s: clocks of files are rounded
/// (rawlogs to 1e-7 s, TUM files often to 1e-6 s).
constexpr double sampleTolerance = 2e-6;

/// \brief The pose at a time: x and y linearly, yaw along the shorter turn.
/// \param trajectory Times strictly increasing, s.
/// \param maxGap Samples further apart than this are not interpolated across, s.
/// \return None outside the span of the trajectory and inside gaps, and for an empty trajectory.
std::optional<Pose2D> poseAt(const std::vector<StampedPose2D>& trajectory, double time,
                             double maxGap);

/// \brief Velocity in the frame of the robot, from the poses `half` a span before and after; at the
/// ends of the trajectory and of gaps from one of them. Zero where neither is known.
/// \param half s. Other parameters as those of poseAt().
Velocity velocityAt(const std::vector<StampedPose2D>& trajectory, double time, double half,
                    double maxGap);

}  // namespace polemcl
