#include "core/common/PoseInterpolation.h"

#include <algorithm>
#include <cmath>

namespace polemcl {

std::optional<Pose2D> poseAt(const std::vector<StampedPose2D>& trajectory, double time,
                             double maxGap) {
  const auto after =
      std::lower_bound(trajectory.begin(), trajectory.end(), time,
                       [](const StampedPose2D& sample, double t) { return sample.time < t; });
  const auto isAt = [&](const StampedPose2D& sample) {
    return std::abs(sample.time - time) <= sampleTolerance;
  };
  if (after != trajectory.end() && isAt(*after)) return after->pose;
  if (after == trajectory.begin()) return std::nullopt;
  const auto before = std::prev(after);
  if (isAt(*before)) return before->pose;
  if (after == trajectory.end()) return std::nullopt;

  const double gap = after->time - before->time;
  if (gap > maxGap) return std::nullopt;
  const double share = (time - before->time) / gap;
  const Pose2D &a = before->pose, &b = after->pose;
  return Pose2D{a.x + share * (b.x - a.x), a.y + share * (b.y - a.y),
                wrapAngle(a.yaw + share * wrapAngle(b.yaw - a.yaw))};
}

Velocity velocityAt(const std::vector<StampedPose2D>& trajectory, double time, double half,
                    double maxGap) {
  const auto here = poseAt(trajectory, time, maxGap);
  const auto before = poseAt(trajectory, time - half, maxGap);
  const auto after = poseAt(trajectory, time + half, maxGap);
  if (before && after) return velocityOf(relative(*before, *after), 2 * half);
  if (after && here) return velocityOf(relative(*here, *after), half);
  if (before && here) return velocityOf(relative(*before, *here), half);
  return {};
}

}  // namespace polemcl
