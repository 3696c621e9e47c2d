#pragma once
/// \file MapView.h
/// \brief What a picture of a localized drive shows: map, truth, estimate. All in the map frame.

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "core/evaluation/TrajectoryEvaluation.h"

namespace polemcl::report {

/// \brief Any part may be empty; what is empty is not drawn. Poses in time order, m, rad, s; drives
/// one behind the other.
struct MapView {
  std::string title;  ///< one line, UTF-8
  std::vector<MapPole> poles;
  std::vector<StampedPose2D> truth;
  std::vector<StampedPose2D> estimate;
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> loops = {};  ///< places passed twice
};

/// \brief The drives of a path: another one begins where the time goes back, or on by minutes.
std::vector<std::vector<StampedPose2D>> drivesOf(const std::vector<StampedPose2D>& path);

/// \brief What the view covers, m.
struct Bounds {
  double xMin = 0, xMax = 0, yMin = 0, yMax = 0;
};
/// \brief The smallest rectangle round all poles and poses.
/// \throws Error when there is nothing to show, or naming the first value that is not finite.
Bounds boundsOf(const MapView& view);

}  // namespace polemcl::report
