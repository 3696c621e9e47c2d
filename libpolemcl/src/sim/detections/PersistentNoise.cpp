#include "sim/detections/PersistentNoise.h"

#include <algorithm>
#include <cmath>

#include "sim/common/Random.h"

namespace polemcl::sim {
namespace {

/// Interpolation in a grid: independent numbers at the four nodes around, bilinear weights, scaled
/// to variance 1.
struct Corners {
  std::int64_t column, row;
  std::array<double, 4> weight;
  Corners(double x, double y) {
    const double left = std::floor(x), below = std::floor(y), u = x - left, v = y - below;
    column = static_cast<std::int64_t>(left);
    row = static_cast<std::int64_t>(below);
    weight = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
    double square = 0;
    for (const double w : weight) square += w * w;
    for (double& w : weight) w /= std::sqrt(square);
  }
};

double field(std::uint64_t seed, double x, double y) {
  const Corners corners(x, y);
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    const auto node = static_cast<std::uint64_t>(corners.column + (i & 1)) << 32 ^
                      static_cast<std::uint64_t>(corners.row + (i >> 1));
    sum += corners.weight[i] * normalFromHash(hash(seed ^ hash(node)));
  }
  return sum;
}

double part(std::uint64_t seed, std::size_t k, double x, double y) {
  const double reach = kNoiseReach[k];
  return reach > 0 ? field(seed + k, x / reach, y / reach) : normalFromHash(hash(seed + k));
}

}  // namespace

double NoiseSpectrum::white() const {
  double rest = 1;
  for (const double share : always) rest -= share;
  for (const double share : today) rest -= share;
  return std::max(0.0, rest);
}

double persistentNoise(const NoiseSpectrum& spectrum, const NoiseSeeds& seeds, double x, double y) {
  double sum = 0;
  for (std::size_t k = 0; k < kNoiseReach.size(); ++k) {
    if (spectrum.always[k] > 0) sum += std::sqrt(spectrum.always[k]) * part(seeds.always, k, x, y);
    if (spectrum.today[k] > 0) sum += std::sqrt(spectrum.today[k]) * part(seeds.today, k, x, y);
  }
  return sum + std::sqrt(spectrum.white()) * normalFromHash(hash(seeds.scan));
}

}  // namespace polemcl::sim
