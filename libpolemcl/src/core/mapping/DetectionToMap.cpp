#include "core/mapping/DetectionToMap.h"

#include <algorithm>
#include <cmath>

#include "core/common/DetectionCheck.h"
#include "core/common/PoleIndex.h"
#include "core/common/Transform.h"

namespace polemcl {

LandmarkObservation landmarkObservation(const PoleDetection& pole, const Pose2D& pose,
                                        std::uint32_t scan, const PoseTrust& trust) {
  const auto [arm, centre, covariance] = movedCentre(pose, pole);
  const Eigen::Vector2d byHeading = trust.headingSigma * Eigen::Vector2d(-arm.y(), arm.x());
  LandmarkObservation observation{pole, scan};
  observation.pole.x = centre.x();
  observation.pole.y = centre.y();
  observation.pole.covariance = covariance + byHeading * byHeading.transpose() +
                                trust.sigma * trust.sigma * Eigen::Matrix2d::Identity();
  if (!trust.covariance.isZero(0)) {
    Eigen::Matrix<double, 2, 3> jacobian;
    jacobian << 1, 0, -arm.y(), 0, 1, arm.x();
    observation.pole.covariance +=
        symmetrized<2>(jacobian * trust.covariance * jacobian.transpose());
  }
  return observation;
}

void checkScan(const Pose2D& pose, const std::vector<PoleDetection>& poles,
               const std::string& where) {
  if (!std::isfinite(pose.x + pose.y + pose.yaw)) {
    throw Error("the pose of " + where + " is not finite; leave the scan out or correct its pose");
  }
  if (std::max(std::abs(pose.x), std::abs(pose.y)) > PoleIndex::farthest)
    throw Error("the pose of " + where +
                " is more than 1e9 m from the origin; leave the scan out or correct its pose");
  for (std::size_t i = 0; i < poles.size(); ++i)
    if (const char* fault = faultOf(poles[i]))
      throw Error("pole " + std::to_string(i) + " of " + where + " has " + fault +
                  "; extract the scan again");
}

}  // namespace polemcl
