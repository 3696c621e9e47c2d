#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/sensor/ElevationHistogram.h"

namespace polemcl::test_elevation_histogram {
namespace {

/// Returns all around at one slope.
void addCone(std::vector<BeamPoint>& points, double slope, int returns, double rho) {
  for (int i = 0; i < returns; ++i) {
    const double azimuth = 2 * M_PI * i / returns;
    points.push_back({static_cast<float>(rho * std::cos(azimuth)),
                      static_cast<float>(rho * std::sin(azimuth)),
                      static_cast<float>(rho * slope)});
  }
}

// Slopes count up to 2.2. Half a metre lower, those of 2 at 1 m are 2.5.
TEST(ElevationHistogram, WhatIsTooSteepFromEitherPlaceCountsForNothing) {
  std::vector<BeamPoint> points;
  addCone(points, 0.1002, 1000, 10);
  ElevationHistogram level(points);
  addCone(points, 2.0002, 100, 1);
  ElevationHistogram both(points);
  const BeamOrigin own, low{0, 0, -0.5, 0};
  EXPECT_EQ(both.cumulative(own, low), level.cumulative(own, low));
  EXPECT_EQ(both.cumulative(low, own), level.cumulative(low, own));
  EXPECT_GT(both.cumulative(own, own).back(), level.cumulative(own, own).back() + 50);
}

}  // namespace
}  // namespace polemcl::test_elevation_histogram
