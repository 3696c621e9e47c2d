#pragma once
/// \file PoleScan.h
/// \brief The poles of one scan, in the form that map and filter need.

#include <cstddef>
#include <optional>
#include <vector>

#include <polemcl/core/common/Types.h>

namespace polemcl {

/// \brief One scan in the form that map and filter need.
struct PoleScan {
  double time = 0;  ///< s
  /// Motion since the previous scan, in its robot frame. Ignored for the first scan; nullopt:
  /// unknown.
  std::optional<PoseWithCovariance> motion;
  std::vector<PoleDetection> poles_robot;
  std::size_t points = 0;                   ///< valid points of the scan; 0: none or unknown
  std::vector<float> visibilityRange = {};  ///< as in CObservationPoles; may be empty
  Pose2D pose_robot_sensor = {};            ///< pose of the frame of visibilityRange
  /// Velocity at the time of the scan, where the motions up to it do not tell.
  std::optional<Velocity> velocity = {};
};

}  // namespace polemcl
