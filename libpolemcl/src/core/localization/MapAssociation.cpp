#include "core/localization/MapAssociation.h"

#include <Eigen/LU>
#include <cmath>
#include <set>
#include <utility>

#include "core/common/DetectionCheck.h"
#include "core/common/GreedyAssignment.h"
#include "core/common/KdTree2D.h"
#include "core/common/PoleIndex.h"
#include "core/common/Transform.h"
#include "core/localization/ScanRegistration.h"

namespace polemcl {
namespace {

constexpr double kNearbyMetres = 1.5, kNearbyRadians = 0.12;  // of findRival()

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

/// Poles of the map that a detection would meet at another pose nearby, in the robot frame.
std::vector<PoleDetection> mapNear(const std::vector<PoleDetection>& poles_robot,
                                   const std::set<std::size_t>& taken, const Pose2D& robot,
                                   const PoleIndex& index) {
  std::set<std::size_t> chosen;
  for (const PoleDetection& pole : poles_robot) {
    const Eigen::Vector2d centre = movedCentre(robot, pole).centre;
    const double reach = kNearbyMetres + kNearbyRadians * std::hypot(pole.x, pole.y);
    for (const auto& near : index.within(centre.x(), centre.y(), reach))
      if (taken.count(near.index) == 0) chosen.insert(near.index);
  }
  std::vector<PoleDetection> poles;
  const Pose2D map = relative(robot, {});
  for (const std::size_t i : chosen) {
    PoleDetection pole;
    pole.x = index.tree().point(i).x();
    pole.y = index.tree().point(i).y();
    pole.covariance = index.variance(i) * Eigen::Matrix2d::Identity();
    poles.push_back(moved(map, pole));
  }
  return poles;
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

RivalPose findRival(const std::vector<PoleDetection>& poles_robot,
                    const std::vector<PoleMatch>& matches, const Pose2D& robot,
                    const PoleIndex& index, const AssociationOptions& options) {
  std::vector<PoleDetection> left;
  std::set<std::size_t> taken;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (matches[i].matched)
      taken.insert(matches[i].pole);
    else if (matches[i].confidence > 0 && faultOf(poles_robot[i]) == nullptr)
      left.push_back(poles_robot[i]);
  }
  if (left.size() < 2) return {};
  RegistrationOptions near;
  near.sigma = options.sigma;
  near.maxMetres = kNearbyMetres;
  near.maxRadians = kNearbyRadians;
  const auto found = searchMotion(mapNear(left, taken, robot, index), left, {}, near);
  return {found.pairs, found.motion};
}

}  // namespace polemcl
