#include "core/localization/KldSampleSize.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace polemcl {

namespace {

void requireKld(bool condition, const char* what) {
  if (!condition) throw Error(what);
}

}  // namespace

void KldOptions::validate() const {
  requireKld(epsilon > 0 && epsilon <= 1, "kld_epsilon must be above 0 and at most 1");
  requireKld(delta > 0 && delta <= 0.5, "kld_delta must be above 0 and at most 0.5");
  requireKld(bin >= 1e-3 && bin <= 100, "kld_bin_m must be 0.001 to 100 m");
  requireKld(binYaw >= 1e-5 && binYaw <= M_PI, "kld_bin_deg must be 0.001 to 180 degrees");
  requireKld(minParticles >= 1 && maxParticles <= 1000000 && minParticles <= maxParticles,
             "min_particles and max_particles must be 1 to 1000000, the least not above the most");
}

std::size_t occupiedBins(const std::vector<Pose2D>& particles,
                         const std::vector<std::size_t>& chosen, const KldOptions& options) {
  using Bin = std::array<std::int64_t, 3>;
  std::vector<Bin> bins;
  bins.reserve(chosen.size());
  for (const std::size_t i : chosen) {
    const Bin bin{static_cast<std::int64_t>(std::floor(particles[i].x / options.bin)),
                  static_cast<std::int64_t>(std::floor(particles[i].y / options.bin)),
                  static_cast<std::int64_t>(std::floor(particles[i].yaw / options.binYaw))};
    if (bins.empty() || bins.back() != bin) bins.push_back(bin);  // copies come one after another
  }
  std::sort(bins.begin(), bins.end());
  return static_cast<std::size_t>(std::unique(bins.begin(), bins.end()) - bins.begin());
}

std::size_t kldSampleSize(std::size_t bins, const KldOptions& options) {
  const auto least = static_cast<double>(options.minParticles);
  const auto most = static_cast<double>(options.maxParticles);
  if (bins <= 1) return static_cast<std::size_t>(options.minParticles);
  const double freedom = static_cast<double>(bins - 1), part = 2 / (9 * freedom);
  const double root = 1 - part + std::sqrt(part) * normalQuantile(1 - options.delta);
  const double wanted = freedom / (2 * options.epsilon) * root * root * root;
  return static_cast<std::size_t>(std::clamp(std::ceil(wanted), least, most));
}

double normalQuantile(double p) {
  if (!(p > 0 && p < 1))
    throw Error("a quantile of the normal distribution was asked for at " + std::to_string(p) +
                "; it must lie between 0 and 1");
  double low = -40, high = 40;  // halved until nothing lies between
  for (double z = 0; low < z && z < high; z = 0.5 * (low + high))
    (0.5 * std::erfc(-z * M_SQRT1_2) < p ? low : high) = z;
  return high;
}

}  // namespace polemcl
