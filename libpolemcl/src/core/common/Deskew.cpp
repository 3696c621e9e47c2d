#include "core/common/Deskew.h"

#include <algorithm>
#include <cmath>

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

/// Mean depth of a cylinder's front before its centre, in radii: what the returns fix is the front.
constexpr double kFront = M_PI / 4;
/// Greatest share of a radius that is taken for motion.
constexpr double kMostSweep = 0.5;

/// The detection with the radius that the beam would have measured had the pole stood still in the
/// robot frame. The beam meets edges at azimuth a -+ w, which move at rate s, at turning rate t
/// with the half width w / (1 - s / t).
PoleDetection withoutSweep(PoleDetection pole, const Velocity& velocity) {
  const double square = pole.x * pole.x + pole.y * pole.y;
  if (pole.turnRate == 0 || square == 0) return pole;
  // A standing point moves at (-velocity.x + yaw * y, -velocity.y - yaw * x) in the robot frame.
  const double rate = (pole.y * velocity.x - pole.x * velocity.y) / square - velocity.yaw;
  const double sweep = std::clamp(rate / pole.turnRate, -kMostSweep, kMostSweep);
  const double farther = -kFront * sweep * pole.radius / std::sqrt(square);
  pole.radius *= 1 - sweep;
  pole.x += farther * pole.x;
  pole.y += farther * pole.y;
  return pole;
}

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
    pole = withoutSweep(pole, velocity);
    if (pole.timeOffset != 0) pole = moved(motionAfter(velocity, pole.timeOffset), pole);
    pole.timeOffset = pole.turnRate = 0;
  }
}

}  // namespace polemcl
