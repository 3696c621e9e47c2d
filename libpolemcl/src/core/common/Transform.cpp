#include "core/common/Transform.h"

namespace polemcl {

MovedCentre movedCentre(const Pose2D& base, const PoleDetection& pole) {
  const Eigen::Matrix2d rotation = rotationOf(base.yaw);
  const Eigen::Vector2d arm = rotation * Eigen::Vector2d(pole.x, pole.y);
  return {arm, arm + Eigen::Vector2d(base.x, base.y),
          rotation * pole.covariance * rotation.transpose()};
}

PoleDetection moved(const Pose2D& base, const PoleDetection& pole) {
  PoleDetection result = pole;
  const Pose2D centre = compose(base, {pole.x, pole.y, 0});
  const Eigen::Matrix2d rotation = rotationOf(base.yaw);
  result.x = centre.x;
  result.y = centre.y;
  result.covariance = symmetrized<2>(rotation * pole.covariance * rotation.transpose());
  return result;
}

}  // namespace polemcl
