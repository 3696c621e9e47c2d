#include "core/localization/MapAssociation.h"

#include <Eigen/LU>
#include <cmath>
#include <utility>

#include "core/common/GreedyAssignment.h"

namespace polemcl {
namespace {

/// A detection in the map frame, with the uncertainty of detection and pose.
struct PlacedDetection {
  Eigen::Vector2d centre;
  Eigen::Matrix2d covariance;
};

PlacedDetection placeDetection(const PoleDetection& pole, const PoseWithCovariance& robot,
                               double sigma) {
  const double c = std::cos(robot.mean.yaw), s = std::sin(robot.mean.yaw);
  Eigen::Matrix2d rotation;
  rotation << c, -s, s, c;
  const Eigen::Vector2d arm = rotation * Eigen::Vector2d(pole.x, pole.y);
  Eigen::Matrix<double, 2, 3> jacobian;  // of the place by x, y, yaw
  jacobian << 1, 0, -arm.y(), 0, 1, arm.x();
  return {arm + Eigen::Vector2d(robot.mean.x, robot.mean.y),
          rotation * pole.covariance * rotation.transpose() +
              jacobian * robot.covariance * jacobian.transpose() +
              sigma * sigma * Eigen::Matrix2d::Identity()};
}

}  // namespace

std::vector<PoleMatch> associate(const std::vector<PoleDetection>& poles_robot,
                                 const PoseWithCovariance& robot, const PoleIndex& index,
                                 const AssociationOptions& options) {
  std::vector<PoleMatch> matches(poles_robot.size());
  std::vector<AssignedPair> pairs;  // detection, map pole, squared Mahalanobis distance
  for (std::size_t i = 0; i < poles_robot.size(); ++i) {
    matches[i].confidence = poles_robot[i].confidence;
    const PlacedDetection placed = placeDetection(poles_robot[i], robot, options.sigma);
    // NaN fails every comparison below, so what is not a number matches nothing.
    for (const auto& near : index.within(placed.centre.x(), placed.centre.y(), options.reach)) {
      const Eigen::Vector2d error = placed.centre - index.tree().point(near.index);
      const Eigen::Matrix2d sum =
          placed.covariance + index.variance(near.index) * Eigen::Matrix2d::Identity();
      const double squared = error.dot(sum.inverse() * error);
      if (squared <= options.gate * options.gate) pairs.push_back({i, near.index, squared});
    }
  }
  for (const AssignedPair& pair : chooseClosest(std::move(pairs))) {
    matches[pair.first].matched = true;
    matches[pair.first].pole = pair.second;
    matches[pair.first].squared = pair.distance;
  }
  return matches;
}

}  // namespace polemcl
