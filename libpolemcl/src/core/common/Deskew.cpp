#include <cmath>

#include <polemcl/core/common/Deskew.h>
#include "core/common/Transform.h"

namespace polemcl {
namespace {

/// sin(angle) / angle and (1 - cos(angle)) / angle.
struct Arc {
  explicit Arc(double angle)
      : along(std::abs(angle) < 1e-9 ? 1 : std::sin(angle) / angle),
        aside(std::abs(angle) < 1e-9 ? angle / 2 : (1 - std::cos(angle)) / angle) {}
  double along, aside;
};

}  // namespace

Velocity velocityOf(const Pose2D& motion, double seconds) {
  const Arc arc(motion.yaw);
  const double scale = seconds * (arc.along * arc.along + arc.aside * arc.aside);
  return {(arc.along * motion.x + arc.aside * motion.y) / scale,
          (arc.along * motion.y - arc.aside * motion.x) / scale, motion.yaw / seconds};
}

Pose2D motionAfter(const Velocity& velocity, double seconds) {
  const double x = velocity.x * seconds, y = velocity.y * seconds, yaw = velocity.yaw * seconds;
  const Arc arc(yaw);
  return {arc.along * x - arc.aside * y, arc.aside * x + arc.along * y, yaw};
}

void deskew(std::vector<PoleDetection>& poles, const Velocity& velocity) {
  for (PoleDetection& pole : poles) {
    if (pole.timeOffset == 0) continue;
    pole = moved(motionAfter(velocity, pole.timeOffset), pole);
    pole.timeOffset = 0;
  }
}

}  // namespace polemcl
