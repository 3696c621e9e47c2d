#pragma once
// Moments of a run made of plain numbers, for tests.

#include <cmath>
#include <vector>

#include "report/scene/LiveMoment.h"

namespace polemcl::report {

inline MapPole mapPole(double x, double y) {
  MapPole pole;
  pole.x = x, pole.y = y, pole.radius = 0.1, pole.top = 4;
  return pole;
}

inline std::vector<MapPole> smallMap() {
  return {mapPole(0, 5), mapPole(20, -5), mapPole(40, 5), mapPole(60, -5)};
}

/// At (10, 0) looking along +y: detects pole 1 of smallMap(), and one that does not exist.
inline LiveMoment knownMoment() {
  LiveMoment moment;
  moment.scan = 12;
  moment.elapsed = 1.2;
  moment.estimate = PoseWithCovariance{{10, 0, M_PI / 2}, Eigen::Matrix3d::Identity() * 0.01};
  moment.particles = {{10, 0, 1.5}, {10.1, 0, 1.6}, {9.9, 0.1, 1.6}};
  moment.weights = {1, 0.5, 0};
  PoleDetection seen, false_;
  seen.x = -5, seen.y = -10, seen.radius = 0.1, seen.bottom = 0.5, seen.top = 3;
  false_.x = 3, false_.y = 0, false_.radius = 0.1, false_.top = 2;
  moment.poles_robot = {seen, false_};
  moment.matches.resize(2);
  moment.matches[0].matched = true;
  moment.matches[0].pole = 1;
  moment.health.state = HealthState::ok;
  moment.health.reason = HealthReason::none;
  moment.health.matchedShare = 0.75;
  moment.health.effectiveParticles = 2;
  moment.health.spread = 0.1;
  moment.step.particles = 3;
  moment.way = {{8, 0, false}, {9, 0, true}, {10, 0, true}};
  return moment;
}

inline LiveMoment searchingMoment() {
  LiveMoment moment;
  GlobalHypothesis first, second;
  first.pose_map_robot = {20, 0, 0}, first.weight = 0.9;
  second.pose_map_robot = {40, 0, 0}, second.weight = 0.1;
  moment.hypotheses = {first, second};
  moment.poles_robot.resize(3);
  return moment;  // its health is `lost`, `searching`
}

}  // namespace polemcl::report
