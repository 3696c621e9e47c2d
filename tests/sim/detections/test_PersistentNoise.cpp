#include <gtest/gtest.h>

#include <cmath>

#include "sim/common/Random.h"
#include "sim/detections/PersistentNoise.h"

namespace polemcl::test_persistent_noise {
namespace {

using namespace polemcl::sim;

NoiseSpectrum mixed() {
  NoiseSpectrum spectrum;
  spectrum.always = {0.1, 0.0, 0.2, 0.0, 0.1};
  spectrum.today = {0.0, 0.2, 0.0, 0.1, 0.1};
  return spectrum;
}

/// Correlation of noise at two places at this distance in a random direction, over many poles.
double counted(const NoiseSpectrum& spectrum, double distance, bool sameDay) {
  Random random(7);
  double ab = 0, aa = 0, bb = 0;
  for (std::uint64_t pole = 0; pole < 40000; ++pole) {
    const double x = random.uniform(-50, 50), y = random.uniform(-50, 50);
    const double angle = random.uniform(-M_PI, M_PI);
    const NoiseSeeds here{hash(pole, 1), hash(pole, 2), hash(pole, 3)};
    const NoiseSeeds there{here.always, sameDay ? here.today : hash(pole, 4), hash(pole, 5)};
    const double a = persistentNoise(spectrum, here, x, y);
    const double b = persistentNoise(spectrum, there, x + distance * std::cos(angle),
                                     y + distance * std::sin(angle));
    ab += a * b;
    aa += a * a;
    bb += b * b;
  }
  EXPECT_NEAR(aa / 40000, 1, 0.03);
  return ab / std::sqrt(aa * bb);
}
TEST(PersistentNoise, WhiteIsWhatIsLeft) {
  EXPECT_NEAR(mixed().white(), 0.2, 1e-12);
  EXPECT_EQ(NoiseSpectrum().white(), 1);
}

// By noise_correlation() of share/experiments/fit_detections.py.
TEST(PersistentNoise, CorrelatesAsItsSpectrumSays) {
  struct Expected {
    double distance, sameDay, otherDay;
  };
  for (const auto& [distance, sameDay, otherDay] : {Expected{0, 0.8, 0.4},
                                                    {0.7, 0.76751, 0.375181},
                                                    {3, 0.577639, 0.278822},
                                                    {12, 0.307175, 0.131912},
                                                    {1000, 0.2, 0.1}}) {
    EXPECT_NEAR(counted(mixed(), distance, true), sameDay, 0.02) << distance << " m";
    EXPECT_NEAR(counted(mixed(), distance, false), otherDay, 0.02) << distance << " m";
  }
}

TEST(PersistentNoise, DependsOnNothingButItsSeedsAndThePlace) {
  const NoiseSeeds seeds{1, 2, 3};
  const double first = persistentNoise(mixed(), seeds, 4.5, -8);
  persistentNoise(mixed(), {9, 9, 9}, 0, 0);
  EXPECT_EQ(persistentNoise(mixed(), seeds, 4.5, -8), first);
  EXPECT_NE(persistentNoise(mixed(), {1, 2, 4}, 4.5, -8), first);
}

}  // namespace
}  // namespace polemcl::test_persistent_noise
