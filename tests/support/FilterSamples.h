// Options, starts and frames shared by tests of the particle filter.
#pragma once

#include <cmath>
#include <memory>

#include "mrpt/filter/PoleParticleFilter.h"
#include "support/PoleStreet.h"

namespace polemcl::tests {

inline constexpr double degree = M_PI / 180;

/// Particles stay in place: no noise, no resampling.
inline FilterOptions still() {
  FilterOptions options;
  options.resampleBelow = 0;
  options.tempering = options.regularization = options.extraSigma = options.extraSigmaYaw = 0;
  return options;
}

inline StartOptions at(const Pose2D& pose, double radius = 2.5, double heading = 5 * degree) {
  StartOptions start;
  start.pose = pose;
  start.radius = radius;
  start.heading = heading;
  return start;
}

/// The map of a small street, for tests that do not need to drive.
inline std::shared_ptr<CPoleMap> smallMap() {
  return makeStreet({}).map;
}

inline PoleScan emptyFrame(double time, const PoseWithCovariance& motion = {}) {
  PoleScan frame;
  frame.time = time;
  frame.motion = motion;
  return frame;
}

}  // namespace polemcl::tests
