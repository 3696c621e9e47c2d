#include "core/localization/MapAssociation.h"

#include <Eigen/LU>
#include <cmath>
#include <utility>

#include "core/common/GreedyAssignment.h"
#include "core/common/KdTree2D.h"
#include "core/common/PoleIndex.h"
#include "core/common/Transform.h"
#include "core/extraction/VisibilityRange.h"

namespace polemcl {
namespace {

/// A detection in the map frame, with the uncertainty of detection and pose.
MovedCentre placeDetection(const PoleDetection& pole, const PoseWithCovariance& robot,
                           double sigma) {
  MovedCentre placed = movedCentre(robot.mean, pole);
  Eigen::Matrix<double, 2, 3> jacobian;  // of the centre by x, y, yaw
  jacobian << 1, 0, -placed.arm.y(), 0, 1, placed.arm.x();
  placed.covariance += jacobian * robot.covariance * jacobian.transpose();
  placed.covariance += sigma * sigma * Eigen::Matrix2d::Identity();
  return placed;
}

}  // namespace

std::vector<PoleMatch> associate(const std::vector<PoleDetection>& poles_robot,
                                 const PoseWithCovariance& robot, const PoleIndex& index,
                                 const AssociationOptions& options) {
  std::vector<PoleMatch> matches(poles_robot.size());
  std::vector<AssignedPair> pairs;  // detection, map pole, squared Mahalanobis distance
  for (std::size_t i = 0; i < poles_robot.size(); ++i) {
    matches[i].confidence = poles_robot[i].confidence;
    const MovedCentre placed = placeDetection(poles_robot[i], robot, options.sigma);
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

NearPoles nearPoles(const PoleScan& scan, const std::vector<PoleMatch>& matches,
                    const Pose2D& robot, const PoleIndex& index,
                    const std::vector<MapPole>& poles) {
  constexpr double kNear = 20;  // m
  NearPoles near;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (!(std::hypot(scan.poles_robot[i].x, scan.poles_robot[i].y) < kNear)) continue;
    near.seen += matches[i].confidence;
    near.matched += matches[i].matched ? matches[i].confidence : 0;
  }
  const Pose2D sensor = compose(robot, scan.pose_robot_sensor);
  for (const auto& pole : index.within(robot.x, robot.y, kNear))
    near.expected +=
        scan.visibilityRange.empty() || isInView(scan.visibilityRange, sensor, poles[pole.index]);
  return near;
}

}  // namespace polemcl
