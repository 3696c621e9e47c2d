#pragma once
/// \file HealthFeed.h
/// \brief Scans for a HealthMonitor.

#include <gtest/gtest.h>

#include <cmath>

#include "core/localization/LocalizationHealth.h"

namespace polemcl::tests {

/// Feeds a monitor with scans of ten poles, half a metre and a tenth of a second apart.
class Feed {
 public:
  /// \param count, share Of the first scans.
  explicit Feed(int count = 0, double share = 1) {
    monitor.begin();
    scans(count, share);
  }

  /// \param share Share of the poles that match. \param poles Number of poles in the scan.
  Feed& scan(double share, int poles = 10) {
    HealthInput input;
    input.time = time += period;
    input.metres = metres;
    for (int i = 0; i < poles; ++i) {
      PoleMatch match;
      match.confidence = confidence;
      match.matched = i < std::lround(share * poles);
      match.pole = match.matched ? firstPole + static_cast<std::size_t>(i) : 0;
      match.squared = match.matched ? squared : 0;
      input.matches.push_back(match);
    }
    input.estimate.covariance = Eigen::Vector3d(sigma * sigma, 1e-4, yaw * yaw).asDiagonal();
    input.effectiveParticles = particles;
    input.modeShare = modeShare;
    input.odometryContradicted = contradicted;
    input.rival = rival;
    input.near = near;
    last = monitor.update(input);
    return *this;
  }
  Feed& scans(int count, double share, int poles = 10) {
    for (int i = 0; i < count; ++i) scan(share, poles);
    return *this;
  }
  void expect(HealthState state, HealthReason reason) const {
    EXPECT_STREQ(name(last.state), name(state));
    EXPECT_STREQ(name(last.reason), name(reason));
  }

  HealthMonitor monitor;
  Health last;
  double time = 1e9, period = 0.1, metres = 0.5, squared = 2, sigma = 0.02, yaw = 0.001,
         modeShare = 1, confidence = 1, particles = 500;
  std::size_t firstPole = 0;  ///< index in the map of the first one that matches
  bool contradicted = false;
  RivalPose rival;
  NearPoles near;
};

}  // namespace polemcl::tests
