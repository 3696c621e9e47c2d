#pragma once
/// \file PersistentNoise.h
/// \brief Noise of variance 1 that is partly persistent: permanent, or constant while passing by.

#include <array>
#include <cstdint>

namespace polemcl::sim {

/// Correlation lengths of the parts of persistent noise, m of sensor movement. The last part, 0, is
/// independent of the position.
inline constexpr std::array<double, 5> kNoiseReach{1.5, 4, 10, 25, 0};

/// \brief Composition of noise, as shares of its variance. The rest up to 1 is white: new in every
/// scan.
struct NoiseSpectrum {
  std::array<double, 5> always{};  ///< by reach; equal for every visit of the sensor to a place
  std::array<double, 5> today{};   ///< by reach; equal during one day
  double white() const;
};

/// \brief Seeds of independent noise streams. Equal seeds give equal noise.
struct NoiseSeeds {
  std::uint64_t always = 0, today = 0, scan = 0;
};

/// \brief The noise for a sensor at x, y (map frame, m): a standard normal number. It depends only
/// on hashes, so it can be evaluated in any order.
double persistentNoise(const NoiseSpectrum& spectrum, const NoiseSeeds& seeds, double x, double y);

}  // namespace polemcl::sim
