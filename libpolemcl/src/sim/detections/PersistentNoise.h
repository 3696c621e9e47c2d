#pragma once
/// \file PersistentNoise.h
/// \brief Noise of variance 1 that lasts: in part for good, in part while passing by.

#include <array>
#include <cstdint>

namespace polemcl::sim {

/// Reach of the parts of lasting noise, m: it changes over about this way of the sensor. The last
/// part, 0, does not change with it.
inline constexpr std::array<double, 5> kNoiseReach{1.5, 4, 10, 25, 0};

/// \brief What noise is made of, as shares of its variance. What is left of 1 is white: new in
/// every scan.
struct NoiseSpectrum {
  std::array<double, 5> always{};  ///< by reach; the same whenever the sensor is at that place
  std::array<double, 5> today{};   ///< by reach; the same on one day
  double white() const;
  /// \brief Correlation between two places of the sensor, on one day or on two.
  double correlation(double distance, bool sameDay) const;
};

/// \brief Where independent streams of noise begin. Equal seeds give equal noise.
struct NoiseSeeds {
  std::uint64_t always = 0, today = 0, scan = 0;
};

/// \brief The noise where the sensor is at x, y (map frame, m): a standard normal number. It is
/// computed from hashes alone, so it can be asked for in any order.
double persistentNoise(const NoiseSpectrum& spectrum, const NoiseSeeds& seeds, double x, double y);

/// \brief Correlation of the part of one reach between places so far apart, averaged over
/// directions; 1 where the reach is 0.
double noiseCorrelation(double reach, double distance);

}  // namespace polemcl::sim
