#include <gtest/gtest.h>

#include <cmath>

#include "sim/common/Random.h"
#include "sim/detections/PersistentNoise.h"

namespace polemcl::test_persistent_noise {

using namespace polemcl::sim;

namespace {
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
/// Correlation between two positions of the sensor, on the same day or on two days.
double correlation(const NoiseSpectrum& spectrum, double distance, bool sameDay) {
  double sum = 0;
  for (std::size_t k = 0; k < kNoiseReach.size(); ++k)
    sum += (spectrum.always[k] + (sameDay ? spectrum.today[k] : 0)) *
           noiseCorrelation(kNoiseReach[k], distance);
  return sum;
}
}  // namespace

TEST(PersistentNoise, WhiteIsWhatIsLeft) {
  EXPECT_NEAR(mixed().white(), 0.2, 1e-12);
  EXPECT_EQ(NoiseSpectrum().white(), 1);
}

TEST(PersistentNoise, CorrelatesAsItsSpectrumSays) {
  for (const double distance : {0.0, 0.7, 3.0, 12.0})
    for (const bool sameDay : {true, false})
      EXPECT_NEAR(counted(mixed(), distance, sameDay), correlation(mixed(), distance, sameDay),
                  0.02)
          << distance << " m, same day " << sameDay;
  EXPECT_NEAR(correlation(mixed(), 0, true), 0.8, 1e-9);
  EXPECT_NEAR(correlation(mixed(), 0, false), 0.4, 1e-9);
  EXPECT_NEAR(correlation(mixed(), 1000, true), 0.2, 1e-9);
}

TEST(PersistentNoise, DependsOnNothingButItsSeedsAndThePlace) {
  const NoiseSeeds seeds{1, 2, 3};
  const double first = persistentNoise(mixed(), seeds, 4.5, -8);
  persistentNoise(mixed(), {9, 9, 9}, 0, 0);
  EXPECT_EQ(persistentNoise(mixed(), seeds, 4.5, -8), first);
  EXPECT_NE(persistentNoise(mixed(), {1, 2, 4}, 4.5, -8), first);
}

TEST(PersistentNoise, FadesOverItsReach) {
  EXPECT_EQ(noiseCorrelation(0, 500), 1);
  for (const double reach : {1.5, 25.0}) {
    EXPECT_NEAR(noiseCorrelation(reach, 0), 1, 1e-9);
    EXPECT_GT(noiseCorrelation(reach, 0.1 * reach), 0.9);
    EXPECT_NEAR(noiseCorrelation(reach, 3 * reach), 0, 1e-9);
  }
}

}  // namespace polemcl::test_persistent_noise
