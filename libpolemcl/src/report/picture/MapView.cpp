#include "report/picture/MapView.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace polemcl::report {
namespace {

void include(Bounds& bounds, double x, double y, const char* what, std::size_t index) {
  if (!std::isfinite(x) || !std::isfinite(y))
    throw Error("picture: " + std::string(what) + " " + std::to_string(index) +
                " has a coordinate that is not finite; check where it comes from");
  bounds.xMin = std::min(bounds.xMin, x);
  bounds.xMax = std::max(bounds.xMax, x);
  bounds.yMin = std::min(bounds.yMin, y);
  bounds.yMax = std::max(bounds.yMax, y);
}

}  // namespace

std::vector<std::vector<StampedPose2D>> drivesOf(const std::vector<StampedPose2D>& path) {
  constexpr double longestGap = 120;  // s
  std::vector<std::vector<StampedPose2D>> drives;
  for (const StampedPose2D& pose : path) {
    const bool goesOn = !drives.empty() && pose.time >= drives.back().back().time &&
                        pose.time <= drives.back().back().time + longestGap;
    if (!goesOn) drives.emplace_back();
    drives.back().push_back(pose);
  }
  return drives;
}

Bounds boundsOf(const MapView& view) {
  if (view.poles.empty() && view.truth.empty() && view.estimate.empty())
    throw Error("picture: nothing to show: no poles, no truth, no estimate");
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Bounds bounds{infinity, -infinity, infinity, -infinity};
  for (std::size_t i = 0; i < view.poles.size(); ++i)
    include(bounds, view.poles[i].x, view.poles[i].y, "pole", i);
  for (std::size_t i = 0; i < view.truth.size(); ++i)
    include(bounds, view.truth[i].pose.x, view.truth[i].pose.y, "truth pose", i);
  for (std::size_t i = 0; i < view.estimate.size(); ++i)
    include(bounds, view.estimate[i].pose.x, view.estimate[i].pose.y, "estimated pose", i);
  return bounds;
}

}  // namespace polemcl::report
