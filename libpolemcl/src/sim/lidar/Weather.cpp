#include "sim/lidar/Weather.h"

#include <algorithm>
#include <cmath>

namespace polemcl::sim {
namespace {
constexpr double kDropsPerMm = 0.002;  ///< share of the pulses with a drop's return, per mm/h
constexpr double kDropReach = 3;       ///< mean range of such returns, m: nearer drops are brighter
constexpr double kSprayBehind = 2.5;   ///< begin of the spray behind the sensor, m
constexpr double kSprayReach = 3;      ///< mean length of it, m
constexpr double kSprayHalfWidth = 0.45, kSprayTop = 0.03;  ///< rad
}  // namespace

std::optional<double> dropRange(const RealismOptions& realism, double azimuth, double elevation,
                                Random& random) {
  const auto distance = [&](double mean) { return -mean * std::log(1 - random.uniform()); };
  if (random.chance(realism.share(kDropsPerMm * realism.rain))) return distance(kDropReach);
  if (std::abs(std::abs(std::remainder(azimuth, 2 * M_PI)) - M_PI) < kSprayHalfWidth &&
      elevation < kSprayTop && random.chance(realism.share(realism.spray)))
    return kSprayBehind + distance(kSprayReach);
  return std::nullopt;
}

double rainFactor(const RealismOptions& realism, double range) {
  const double rain = realism.scale * realism.rain;
  if (rain <= 0) return 1;
  // Extinction of 1.076 R^0.67 dB/km (Carbonneau and Wisely 1998), there and back.
  const double decibels = 2e-3 * range * 1.076 * std::pow(rain, 0.67);
  return (1 - 0.4 * std::min(1.0, rain / 5)) * std::pow(10.0, -decibels / 10);
}

}  // namespace polemcl::sim
