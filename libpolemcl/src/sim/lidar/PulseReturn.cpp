#include "sim/lidar/PulseReturn.h"

#include <algorithm>
#include <cmath>

namespace polemcl::sim {
namespace {
constexpr float kWeight[kSubRays] = {0.36f, 0.16f, 0.16f, 0.16f, 0.16f};  // of the pulse's energy
constexpr double kDropsPerMm = 0.002;  ///< share of the pulses with a drop's return, per mm/h
constexpr double kDropReach = 3;       ///< mean range of such returns, m: nearer drops are brighter
constexpr double kSprayBehind = 2.5;   ///< begin of the spray behind the sensor, m
constexpr double kSprayReach = 3;      ///< mean length of it, m
constexpr double kSprayHalfWidth = 0.45, kSprayTop = 0.03;  ///< rad

struct Part {
  float range, signal, power;  ///< signal: at unit range; power: received
  int subRay;
};
struct Group {
  float power = 0, signal = 0, moment = 0, strongest = 0;
  int subRay = 0;
  void add(const Part& part) {
    power += part.power;
    signal += part.signal;
    moment += part.power * part.range;
    if (part.power > strongest) {
      strongest = part.power;
      subRay = part.subRay;
    }
  }
};
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

/// Bias of a beam, and of dim (late) and bright (early) returns, m.
double PulseReturnModel::deviation(const Beam& beam, double ratio) const {
  if (m_realism.scale <= 0) return 0;
  const double own = beam.rangeBias / (kCalibrationError * m_lidar.rangeNoise);
  const double brightness = std::clamp(std::log10(ratio) - 1, -1.0, 1.0);
  return m_realism.scale * (m_realism.rangeBias * own - m_realism.rangeWalk * brightness);
}

const Material& PulseReturnModel::material(const SubHit& hit) const {
  if (hit.solid >= 0) return m_solids[hit.solid].material;
  if (hit.solid == SubHit::kRoad) return materials::kAsphalt;
  return hit.solid == SubHit::kPavement ? materials::kPaving : materials::kGrass;
}

std::optional<PulseReturn> PulseReturnModel::make(const SubHit* hits, const Beam& beam,
                                                  double azimuth, std::uint64_t seed) const {
  const auto surface = strongest(hits, beam, seed);
  if (m_realism.scale <= 0) return surface;
  Random random(hash(seed, 0x4a11ull));
  const auto drop = dropRange(m_realism, azimuth, beam.elevation, random);
  if (!drop || *drop < m_lidar.minRange || *drop > m_lidar.maxRange) return surface;
  if (surface && surface->range < *drop) return surface;
  constexpr float kDropIntensity = 0.02f;
  return PulseReturn{std::round(*drop / m_lidar.rangeStep) * m_lidar.rangeStep, kDropIntensity, 0};
}

std::optional<PulseReturn> PulseReturnModel::strongest(const SubHit* hits, const Beam& beam,
                                                       std::uint64_t seed) const {
  Part parts[kSubRays];
  int count = 0;
  for (int s = 0; s < kSubRays; ++s) {
    if (hits[s].solid == SubHit::kNothing) continue;
    // Towards grazing incidence, rough surfaces get darker more slowly than Lambert's cosine.
    const float signal = kWeight[s] * material(hits[s]).reflectivity * std::sqrt(hits[s].cosine);
    const float near = std::max(hits[s].range, 2.0f);
    int at = count++;  // keeps them sorted by range
    for (; at > 0 && parts[at - 1].range > hits[s].range; --at) parts[at] = parts[at - 1];
    parts[at] = {hits[s].range, signal, signal / (near * near), s};
  }
  if (count == 0) return std::nullopt;
  Group best, group;
  float total = 0;
  for (int i = 0; i < count; ++i) {
    if (i > 0 && parts[i].range - parts[i - 1].range > m_lidar.pulseLength) group = Group();
    group.add(parts[i]);
    total += parts[i].power;
    if (group.power > best.power) best = group;
  }
  Random random(seed);
  double range = best.moment / best.power;
  // Ratio of the received signal to the signal with a detection probability of one half.
  const double ratio = best.signal / 0.1 *
                       std::pow(m_lidar.referenceRange / std::max(range, 2.0), 2) *
                       rainFactor(m_realism, range);
  const double cube = ratio * ratio * ratio;
  // Pulses split between near and far are lost more often.
  // So are pulses on surfaces so dark that little comes back from anywhere.
  constexpr double kDark = 0.05;
  const double dark = m_realism.share(m_realism.darkDropout) * std::exp(-best.signal / kDark);
  const double lost = m_lidar.dropout + 0.5 * (1 - best.power / total) + dark;
  if (random.uniform() > cube / (1 + cube) || random.chance(lost)) return std::nullopt;
  const SubHit& hit = hits[best.subRay];
  const double noise = m_lidar.rangeNoise * std::sqrt(1 + 0.5 / ratio);
  range += beam.rangeBias + std::hypot(noise, material(hit).roughness) * random.normal();
  range += deviation(beam, ratio);
  range = (range - m_lidar.rangeOffset) / m_lidar.rangeScale;
  range = std::round(range / m_lidar.rangeStep) * m_lidar.rangeStep;
  if (range < m_lidar.minRange || range > m_lidar.maxRange) return std::nullopt;
  const double shine = best.signal * (0.85 + 0.3 * random.uniform());
  return PulseReturn{range, static_cast<float>(std::clamp(shine, 0.0, 1.0)),
                     hit.solid >= 0 ? m_solids[hit.solid].object : 0u};
}

}  // namespace polemcl::sim
