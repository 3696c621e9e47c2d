#include "core/localization/LocalSubmap.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/common/Covariance.h"
#include "core/common/DetectionCheck.h"
#include "core/common/GreedyAssignment.h"
#include "core/common/Transform.h"

namespace polemcl {
namespace {

constexpr double kSubmapStep = 1;               ///< m
constexpr double kFarthestMatch = 5;            ///< no detection belongs to a pole beyond, m
constexpr double kFarFromOrigin = 10000;        ///< rounding errors of OdometryDrift grow, m
constexpr std::uint32_t kFewChances = 10;       ///< before them nothing is dropped for its misses
constexpr std::size_t kMostSubmapPoles = 2000;  ///< the oldest go first; a real drive has a tenth

/// A detection in the local frame.
struct Placed {
  Eigen::Vector2d centre;
  Eigen::Matrix2d covariance;
};

Placed placePole(const PoleDetection& detection, const Pose2D& pose, double floor) {
  const Eigen::Matrix2d rotation = rotationOf(pose.yaw);
  const Pose2D centre = compose(pose, {detection.x, detection.y, 0});
  return {{centre.x, centre.y},
          rotation * detection.covariance * rotation.transpose() +
              floor * floor * Eigen::Matrix2d::Identity()};
}

}  // namespace

void OdometryDrift::add(const Eigen::Vector2d& end, double yaw, const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix2d rotation = rotationOf(yaw);
  m_position += rotation * covariance.topLeftCorner<2, 2>() * rotation.transpose();
  const double heading = covariance(2, 2);
  m_heading += heading;
  const Eigen::Vector2d p = end - m_origin;
  m_first += heading * p;
  m_second += heading * p * p.transpose();
}

Eigen::Matrix2d OdometryDrift::between(const OdometryDrift& then, const OdometryDrift& now,
                                       const Eigen::Vector2d& place_local) {
  const Eigen::Vector2d place = place_local - now.m_origin;
  const double heading = now.m_heading - then.m_heading;
  const Eigen::Vector2d first = now.m_first - then.m_first;
  // Σ ω² (m - p)(m - p)ᵀ, multiplied out.
  const Eigen::Matrix2d moment = heading * place * place.transpose() - place * first.transpose() -
                                 first * place.transpose() + now.m_second - then.m_second;
  Eigen::Matrix2d covariance = now.m_position - then.m_position;
  covariance(0, 0) += moment(1, 1);  // J·moment·Jᵀ
  covariance(1, 1) += moment(0, 0);
  covariance(0, 1) -= moment(0, 1);
  covariance(1, 0) -= moment(1, 0);
  return covariance;
}

OdometryDrift OdometryDrift::countedFrom(const OdometryDrift& zero,
                                         const Eigen::Vector2d& origin) const {
  const Eigen::Vector2d shift = origin - m_origin;
  OdometryDrift drift;
  drift.m_origin = origin;
  drift.m_position = m_position - zero.m_position;
  drift.m_heading = m_heading - zero.m_heading;
  const Eigen::Vector2d first = m_first - zero.m_first;
  drift.m_first = first - drift.m_heading * shift;
  drift.m_second = m_second - zero.m_second - first * shift.transpose() -
                   shift * first.transpose() + drift.m_heading * shift * shift.transpose();
  return drift;
}

Eigen::Matrix3d walkCovariance(const Pose2D& motion, const SubmapOptions& options) {
  const double metres = std::hypot(motion.x, motion.y);
  const double position = options.positionWalk * options.positionWalk * metres;
  const double heading = options.headingWalk * options.headingWalk * metres +
                         options.turnWalk * options.turnWalk * std::abs(motion.yaw);
  return Eigen::Vector3d(position, position, heading).asDiagonal();
}

LocalSubmap::LocalSubmap(const SubmapOptions& options) : m_options(options) {}

void LocalSubmap::add(const Pose2D& motion, const std::vector<PoleDetection>& poles_robot) {
  add(motion, walkCovariance(motion, m_options), poles_robot);
}

void LocalSubmap::add(const Pose2D& motion, const Eigen::Matrix3d& covariance,
                      const std::vector<PoleDetection>& poles_robot) {
  check(poles_robot);
  if (m_frames > 0) {
    if (!std::isfinite(motion.x) || !std::isfinite(motion.y) || !std::isfinite(motion.yaw))
      throw Error("the motion before frame " + std::to_string(m_frames) +
                  " of the submap is not finite; leave the frame out or start a new submap");
    if (!isCovariance(covariance))
      throw Error("the covariance of the motion before frame " + std::to_string(m_frames) +
                  " of the submap is not symmetric positive semidefinite");
    move(motion, covariance);
  } else {
    m_path = {Eigen::Vector2d::Zero()};
    m_pathDriven = {0};
  }
  ++m_frames;
  associate(poles_robot);
  drop();
}

void LocalSubmap::clear() {
  *this = LocalSubmap(m_options);
}

void LocalSubmap::check(const std::vector<PoleDetection>& poles_robot) const {
  for (std::size_t i = 0; i < poles_robot.size(); ++i)
    if (const char* fault = faultOf(poles_robot[i]))
      throw Error("pole " + std::to_string(i) + " of frame " + std::to_string(m_frames) +
                  " of the submap has " + fault);
}

void LocalSubmap::move(const Pose2D& motion, const Eigen::Matrix3d& covariance) {
  const double yaw = m_pose.yaw;
  m_pose = compose(m_pose, motion);
  m_step = std::hypot(motion.x, motion.y);
  m_driven += m_step;
  const Eigen::Vector2d here(m_pose.x, m_pose.y);
  m_drift.add(here, yaw, covariance);
  if ((here - m_drift.origin()).norm() > kFarFromOrigin) countDriftFrom(here);
  // The last place is always the present one; it stays when the one before is far enough away.
  const std::size_t count = m_path.size();
  if (count < 2 || m_pathDriven[count - 1] - m_pathDriven[count - 2] >= kSubmapStep) {
    m_path.push_back(here);
    m_pathDriven.push_back(m_driven);
  } else {
    m_path.back() = here;
    m_pathDriven.back() = m_driven;
  }
}

void LocalSubmap::countDriftFrom(const Eigen::Vector2d& here) {
  for (SubmapPole& pole : m_poles) pole.drift = pole.drift.countedFrom(m_drift, here);
  m_drift = m_drift.countedFrom(m_drift, here);
}

void LocalSubmap::associate(const std::vector<PoleDetection>& poles_robot) {
  std::vector<Placed> placed;
  placed.reserve(poles_robot.size());
  for (const PoleDetection& d : poles_robot)
    placed.push_back(placePole(d, m_pose, m_options.floor));
  std::vector<AssignedPair> pairs;  // detection, pole, squared Mahalanobis distance
  for (std::size_t p = 0; p < m_poles.size(); ++p) {
    const Eigen::Matrix2d present = presentCovariance(m_poles[p]);
    for (std::size_t d = 0; d < placed.size(); ++d) {
      const Eigen::Vector2d error = placed[d].centre - m_poles[p].centre;
      if (poles_robot[d].confidence <= 0 || error.squaredNorm() > kFarthestMatch * kFarthestMatch)
        continue;
      const Eigen::Matrix2d sum = present + placed[d].covariance;
      const double squared = error.dot(sum.inverse() * error);
      if (squared <= m_options.gate * m_options.gate) pairs.push_back({d, p, squared});
    }
  }
  std::vector<bool> poleTaken(m_poles.size()), detectionTaken(placed.size());
  for (const AssignedPair& pair : chooseClosest(std::move(pairs))) {
    detectionTaken[pair.first] = poleTaken[pair.second] = true;
    update(m_poles[pair.second], poles_robot[pair.first], placed[pair.first].centre,
           placed[pair.first].covariance);
    m_poles[pair.second].detection = pair.first;
  }
  const Eigen::Vector2d here(m_pose.x, m_pose.y);
  for (std::size_t p = 0; p < m_poles.size(); ++p)
    if (!poleTaken[p] && (m_poles[p].centre - here).norm() < m_options.viewRange)
      ++m_poles[p].chances;
  for (std::size_t d = 0; d < placed.size(); ++d) {
    if (detectionTaken[d] || poles_robot[d].confidence <= 0) continue;
    m_poles.emplace_back();
    m_poles.back().bottom = poles_robot[d].bottom;
    m_poles.back().top = poles_robot[d].top;
    m_poles.back().detection = d;
    m_poles.back().number = m_opened++;
    update(m_poles.back(), poles_robot[d], placed[d].centre, placed[d].covariance);
  }
}

void LocalSubmap::update(SubmapPole& pole, const PoleDetection& detection,
                         const Eigen::Vector2d& centre, const Eigen::Matrix2d& covariance) const {
  const Eigen::Matrix2d floor = m_options.floor * m_options.floor * Eigen::Matrix2d::Identity();
  if (pole.hits == 0 || pole.taken) {
    pole.centre = centre;
    pole.covariance = covariance;
  } else {
    // A Kalman update of what the robot now knows of the pole. The floor is common to all
    // detections of it: taken off before and put back after, so that it does not average out.
    const Eigen::Matrix2d before = presentCovariance(pole) - floor, detected = covariance - floor;
    const Eigen::Matrix2d sum = before + detected + 1e-12 * Eigen::Matrix2d::Identity();
    const Eigen::Matrix2d gain = before * sum.inverse();
    pole.centre += gain * (centre - pole.centre);
    const Eigen::Matrix2d after = before - gain * before;
    pole.covariance = symmetrized(after) + floor;
  }
  ++pole.hits;
  ++pole.chances;
  pole.taken = false;
  pole.seenFrame = m_frames;
  pole.radius += (detection.radius - pole.radius) / pole.hits;
  pole.confidence += (detection.confidence - pole.confidence) / pole.hits;
  pole.bottom = std::min(pole.bottom, detection.bottom);
  pole.top = std::max(pole.top, detection.top);
  pole.seenFrom = Eigen::Vector2d(m_pose.x, m_pose.y);
  pole.seenAt = m_driven;
  pole.drift = m_drift;
}

void LocalSubmap::drop() {
  const double oldest = m_driven - m_options.length;
  const auto unwanted = [&](const SubmapPole& pole) {
    if (pole.seenAt < oldest) return true;
    return pole.hits < static_cast<std::uint32_t>(m_options.sureHits) &&
           pole.chances >= kFewChances && pole.hits < m_options.minShare * pole.chances;
  };
  m_poles.erase(std::remove_if(m_poles.begin(), m_poles.end(), unwanted), m_poles.end());
  if (m_poles.size() > kMostSubmapPoles)
    m_poles.erase(m_poles.begin(), m_poles.end() - static_cast<std::ptrdiff_t>(kMostSubmapPoles));
  const auto first = std::lower_bound(m_pathDriven.begin(), m_pathDriven.end() - 1, oldest);
  const auto count = first - m_pathDriven.begin();
  m_pathDriven.erase(m_pathDriven.begin(), first);
  m_path.erase(m_path.begin(), m_path.begin() + count);
}

Eigen::Matrix2d LocalSubmap::presentCovariance(const SubmapPole& pole, bool withScale) const {
  Eigen::Matrix2d covariance =
      pole.covariance + OdometryDrift::between(pole.drift, m_drift, pole.centre);
  if (withScale) {
    const Eigen::Vector2d way = Eigen::Vector2d(m_pose.x, m_pose.y) - pole.seenFrom;
    covariance += m_options.scale * m_options.scale * way * way.transpose();
  }
  return covariance;
}

PoleDetection LocalSubmap::seenNow(const SubmapPole& pole) const {
  const Eigen::Matrix2d rotation = rotationOf(-m_pose.yaw);
  const Eigen::Vector2d centre = rotation * (pole.centre - Eigen::Vector2d(m_pose.x, m_pose.y));
  PoleDetection detection;
  detection.x = centre.x();
  detection.y = centre.y();
  detection.radius = pole.radius;
  detection.bottom = pole.bottom;
  detection.top = pole.top;
  detection.confidence = pole.confidence;
  detection.covariance = rotation * presentCovariance(pole) * rotation.transpose();
  detection.points = pole.hits;
  return detection;
}

std::vector<PoleDetection> LocalSubmap::detections(std::uint32_t minHits) const {
  std::vector<PoleDetection> poles_robot;
  for (const SubmapPole& pole : m_poles)
    if (pole.hits >= minHits) poles_robot.push_back(seenNow(pole));
  return poles_robot;
}

std::vector<PoleDetection> LocalSubmap::take(std::uint32_t minHits, double metres) {
  std::vector<PoleDetection> poles_robot;
  for (SubmapPole& pole : m_poles) {
    const bool now = pole.seenFrame == m_frames && !pole.taken && pole.hits >= minHits;
    const bool waited = pole.hits == minHits || m_driven + m_step / 2 - pole.takenAt >= metres;
    if (!now || !waited) continue;
    poles_robot.push_back(seenNow(pole));
    pole.taken = true;
    pole.takenAt = m_driven;
  }
  return poles_robot;
}

}  // namespace polemcl
