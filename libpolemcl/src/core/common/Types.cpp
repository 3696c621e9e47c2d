#include <cmath>

#include <polemcl/core/common/Types.h>

namespace polemcl {

double wrapAngle(double angle) {
  if (angle > -M_PI && angle <= M_PI) return angle;
  const double wrapped = std::remainder(angle, 2 * M_PI);
  return wrapped <= -M_PI ? wrapped + 2 * M_PI : wrapped;
}

Pose2D compose(const Pose2D& base, const Pose2D& other) {
  const double c = std::cos(base.yaw), s = std::sin(base.yaw);
  return {base.x + c * other.x - s * other.y, base.y + s * other.x + c * other.y,
          wrapAngle(base.yaw + other.yaw)};
}

Pose2D relative(const Pose2D& from, const Pose2D& to) {
  const double c = std::cos(from.yaw), s = std::sin(from.yaw);
  const double dx = to.x - from.x, dy = to.y - from.y;
  return {c * dx + s * dy, -s * dx + c * dy, wrapAngle(to.yaw - from.yaw)};
}

}  // namespace polemcl
