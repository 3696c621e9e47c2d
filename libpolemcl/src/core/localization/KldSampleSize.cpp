#include "core/localization/KldSampleSize.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/common/Binder.h"
#include "core/common/Statistics.h"

namespace polemcl {

void bind(Binder& b, KldOptions& o) {
  const Range particles = Range::between(1, 1000000);
  b.section("filter", "The particle filter that localizes", Tier::expert);
  b.integer("min_particles", o.minParticles, particles, "", "adaptive: least number of particles");
  b.integer("max_particles", o.maxParticles, particles, "",
            "adaptive: greatest number of particles");
  b.require(o.minParticles <= o.maxParticles, "min_particles", o.minParticles,
            "max_particles or less");
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

}  // namespace polemcl
