#include <gtest/gtest.h>

#include <cmath>

#include "sim/lidar/PulseReturn.h"

namespace polemcl::test_pulse_return {
namespace {

using namespace polemcl::sim;

RealismOptions only(double RealismOptions::*rate, double value) {
  RealismOptions realism;
  realism.scale = 1;
  realism.rangeBias = realism.rangeWalk = realism.darkDropout = realism.rain = realism.spray = 0;
  realism.*rate = value;
  return realism;
}

/// Share of pulses in this direction that meet a drop.
double shareWithDrop(const RealismOptions& realism, double azimuth, double elevation) {
  Random random(1);
  int hits = 0;
  for (int i = 0; i < 20000; ++i)
    hits += dropRange(realism, azimuth, elevation, random).has_value();
  return hits / 20000.0;
}

/// Mean range of 4000 pulses on a surface, and the share that returns.
struct Returned {
  double range = 0, share = 0;
};
Returned onSurface(const RealismOptions& realism, float reflectivity, double beamBias) {
  LidarModel lidar = makeLidar("hdl32e");
  Solid solid;
  solid.material = {reflectivity, 0, 0};
  const std::vector<SolidView> solids{{solid, Eigen::Isometry3d::Identity(), 1}};
  const PulseReturnModel model(lidar, solids, realism);
  Beam beam;
  beam.rangeBias = beamBias;
  SubHit hits[kSubRays];
  for (SubHit& hit : hits) hit = {15, 1, 0};
  Returned result;
  for (std::uint64_t i = 0; i < 4000; ++i)
    if (const auto pulse = model.make(hits, beam, 0, i * 7919 + 3)) {
      result.range += pulse->range;
      result.share += 1 / 4000.0;
    }
  result.range /= 4000 * result.share;
  return result;
}

TEST(Weather, RainFallsEverywhereSprayBehind) {
  EXPECT_NEAR(shareWithDrop(only(&RealismOptions::rain, 10), 1, 0), 0.02, 0.003);
  const RealismOptions spray = only(&RealismOptions::spray, 0.2);
  EXPECT_NEAR(shareWithDrop(spray, M_PI - 0.2, -0.1), 0.2, 0.01);
  EXPECT_NEAR(shareWithDrop(spray, -M_PI + 0.2, -0.1), 0.2, 0.01);
  EXPECT_EQ(shareWithDrop(spray, 0, -0.1), 0);
  EXPECT_EQ(shareWithDrop(spray, M_PI, 0.2), 0);
}

TEST(Weather, RainDimsSurfaces) {
  EXPECT_EQ(rainFactor(only(&RealismOptions::rain, 0), 50), 1);
  const RealismOptions rain = only(&RealismOptions::rain, 10);
  EXPECT_LT(rainFactor(rain, 50), rainFactor(rain, 10));
  EXPECT_LT(rainFactor(rain, 10), 0.62);
}

TEST(Weather, BeamsAndBrightnessShiftTheRange) {
  const RealismOptions none = only(&RealismOptions::rain, 0);
  const double clean = onSurface(none, 0.3f, 0).range;
  const double noise = makeLidar("hdl32e").rangeNoise;
  // A beam whose calibration error is one standard deviation.
  const double bias = kCalibrationError * noise;
  EXPECT_NEAR(onSurface(only(&RealismOptions::rangeBias, 0.05), 0.3f, bias).range - clean,
              0.05 + bias, 0.003);
  const RealismOptions walk = only(&RealismOptions::rangeWalk, 0.05);
  EXPECT_GT(onSurface(walk, 0.02f, 0).range - clean, 0.01);
  EXPECT_NEAR(onSurface(walk, 2.5f, 0).range - clean, -0.05, 0.004);
}

TEST(Weather, BlackSurfacesLosePulses) {
  const RealismOptions none = only(&RealismOptions::rain, 0),
                       dark = only(&RealismOptions::darkDropout, 0.5);
  EXPECT_LT(onSurface(dark, 0.03f, 0).share, 0.8 * onSurface(none, 0.03f, 0).share);
  EXPECT_NEAR(onSurface(dark, 0.6f, 0).share, onSurface(none, 0.6f, 0).share, 0.005);
}

}  // namespace
}  // namespace polemcl::test_pulse_return
