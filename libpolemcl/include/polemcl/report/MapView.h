#pragma once
/// \file MapView.h
/// \brief What a picture of a localized drive shows: map, truth, estimate. All in the map frame.

#include <polemcl/core/Evaluation.h>
#include <polemcl/core/Types.h>

#include <string>
#include <vector>

namespace polemcl::report {

/// \brief Any part may be empty; what is empty is not drawn. Poses in time order, m, rad, s.
struct MapView {
  std::string title;     ///< one line, UTF-8
  std::string subtitle;  ///< one line under it, such as the errors; may be empty
  std::vector<MapPole> poles;
  std::vector<StampedPose2D> truth;
  std::vector<StampedPose2D> estimate;
};

}  // namespace polemcl::report
