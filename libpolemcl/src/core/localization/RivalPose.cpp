#include "core/localization/RivalPose.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "core/common/DetectionCheck.h"
#include "core/common/KdTree2D.h"
#include "core/common/PoleIndex.h"
#include "core/common/Transform.h"
#include "core/localization/ScanRegistration.h"

namespace polemcl {
namespace {

constexpr double kRivalDistance = 1.5, kRivalTurn = 0.12;   // of a rival from the estimate, m, rad
constexpr double kSamePose = 0.15, kSamePoseTurn = 0.0175;  // nearer is no other pose
/// Greatest Mahalanobis distance of a pair. Wider ones let more poles fit by chance.
constexpr double kGate = 2;
constexpr std::size_t kMostMapPoles = 48;  // compared with the detections

/// What has no match, though some pose within the limits would give it one.
struct Unmatched {
  std::vector<PoleDetection> poles_robot;
  std::map<std::size_t, double> map;  ///< poles of the map, distance of the nearest detection, m
};

Unmatched unmatched(const std::vector<PoleDetection>& poles_robot,
                    const std::vector<PoleMatch>& matches, const std::set<std::size_t>& taken,
                    const Pose2D& robot, const PoleIndex& index) {
  Unmatched result;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const PoleDetection& pole = poles_robot[i];
    if (matches[i].matched || !(pole.confidence > 0) || faultOf(pole) != nullptr) continue;
    const Eigen::Vector2d centre = movedCentre(robot, pole).centre;
    const double reach = kRivalDistance + kRivalTurn * std::hypot(pole.x, pole.y);
    bool meets = false;
    for (const auto& near : index.within(centre.x(), centre.y(), reach)) {
      if (taken.count(near.index) > 0) continue;
      meets = true;
      double& least = result.map.emplace(near.index, near.distance).first->second;
      least = std::min(least, near.distance);
    }
    if (meets) result.poles_robot.push_back(pole);
  }
  return result;
}

/// Those poles of the map, in the robot frame, the nearest to a detection first.
std::vector<PoleDetection> mapNear(const Unmatched& what, const Pose2D& robot,
                                   const PoleIndex& index) {
  std::vector<std::pair<double, std::size_t>> nearest;
  for (const auto& [i, distance] : what.map) nearest.emplace_back(distance, i);
  std::sort(nearest.begin(), nearest.end());
  nearest.resize(std::min(nearest.size(), kMostMapPoles));
  std::vector<PoleDetection> poles;
  const Pose2D map = relative(robot, {});
  for (const auto& [distance, i] : nearest) {
    PoleDetection pole;
    pole.x = index.tree().point(i).x();
    pole.y = index.tree().point(i).y();
    pole.covariance = index.variance(i) * Eigen::Matrix2d::Identity();
    poles.push_back(moved(map, pole));
  }
  return poles;
}

bool isWithin(const Pose2D& motion, double metres, double radians) {
  return std::hypot(motion.x, motion.y) <= metres && std::abs(motion.yaw) <= radians;
}

}  // namespace

RivalPose findRival(const std::vector<PoleDetection>& poles_robot,
                    const std::vector<PoleMatch>& matches, const Pose2D& robot,
                    const PoleIndex& index, const AssociationOptions& options) {
  std::set<std::size_t> taken;
  for (const PoleMatch& match : matches)
    if (match.matched) taken.insert(match.pole);
  const Unmatched left = unmatched(poles_robot, matches, taken, robot, index);
  if (left.poles_robot.size() < 2) return {};
  RegistrationOptions near;
  near.sigma = options.sigma;
  near.maxMetres = kRivalDistance;
  near.maxRadians = kRivalTurn;
  near.gate = kGate;
  RivalPose rival;
  rival.motion = searchMotion(mapNear(left, robot, index), left.poles_robot, {}, near).motion;
  if (isWithin(rival.motion, kSamePose, kSamePoseTurn) ||
      !isWithin(rival.motion, kRivalDistance, kRivalTurn))
    return {};
  PoseWithCovariance there;
  there.mean = compose(robot, rival.motion);
  AssociationOptions closely = options;
  closely.gate = kGate;
  for (const PoleMatch& match : associate(left.poles_robot, there, index, closely))
    if (match.matched && taken.count(match.pole) == 0) rival.poles.push_back(match.pole);
  if (rival.poles.size() < 2 || 2 * rival.poles.size() <= left.poles_robot.size()) return {};
  std::sort(rival.poles.begin(), rival.poles.end());
  return rival;
}

}  // namespace polemcl
