#include "core/mapping/DetectionToMap.h"

#include <cmath>

#include "core/common/PrincipalAxes.h"

namespace polemcl {

LandmarkObservation landmarkObservation(const PoleDetection& pole, const Pose2D& pose,
                                        std::uint32_t view, const PoseTrust& trust) {
  const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
  Eigen::Matrix2d rotation;
  rotation << c, -s, s, c;
  const Eigen::Vector2d offset = rotation * Eigen::Vector2d(pole.x, pole.y);
  const Eigen::Vector2d swing = trust.headingSigma * Eigen::Vector2d(-offset.y(), offset.x());
  LandmarkObservation sighting{pole, view};
  sighting.pole.x = pose.x + offset.x();
  sighting.pole.y = pose.y + offset.y();
  sighting.pole.covariance = rotation * pole.covariance * rotation.transpose() +
                             swing * swing.transpose() +
                             trust.sigma * trust.sigma * Eigen::Matrix2d::Identity();
  return sighting;
}

void checkScan(const Pose2D& pose, const std::vector<PoleDetection>& poles,
               const std::string& where) {
  if (!std::isfinite(pose.x + pose.y + pose.yaw)) {
    throw Error("the pose of " + where + " is not finite; leave the scan out or correct its pose");
  }
  for (std::size_t i = 0; i < poles.size(); ++i) {
    const PoleDetection& pole = poles[i];
    const std::string which = "pole " + std::to_string(i) + " of " + where;
    if (!std::isfinite(pole.x + pole.y + pole.radius + pole.bottom + pole.top)) {
      throw Error(which + " holds a number that is not finite; extract the scan again");
    }
    if (!(pole.confidence >= 0 && pole.confidence <= 1)) {
      throw Error(which + " has a confidence outside [0, 1]; extract the scan again");
    }
    if (!principalAxes(pole.covariance)) {
      throw Error(
          which +
          " has a covariance that is not symmetric positive semidefinite; extract the scan again");
    }
  }
}

}  // namespace polemcl
