#include "sim/lidar/PulseReturn.h"

#include <algorithm>
#include <cmath>

#include "sim/common/Random.h"

namespace polemcl::sim {
namespace {
constexpr float kWeight[kSubRays] = {0.36f, 0.16f, 0.16f, 0.16f, 0.16f};  // of the pulse's energy

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

const Material& PulseReturnModel::material(const SubHit& hit) const {
  if (hit.solid >= 0) return m_solids[hit.solid].material;
  if (hit.solid == SubHit::kRoad) return materials::asphalt;
  return hit.solid == SubHit::kPavement ? materials::paving : materials::grass;
}

std::optional<PulseReturn> PulseReturnModel::make(const SubHit* hits, const Beam& beam,
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
  const double ratio =
      best.signal / 0.1 * std::pow(m_lidar.referenceRange / std::max(range, 2.0), 2);
  const double cube = ratio * ratio * ratio;
  // Pulses split between near and far are lost more often.
  const double lost = m_lidar.dropout + 0.5 * (1 - best.power / total);
  if (random.uniform() > cube / (1 + cube) || random.chance(lost)) return std::nullopt;
  const SubHit& hit = hits[best.subRay];
  const double noise = m_lidar.rangeNoise * std::sqrt(1 + 0.5 / ratio);
  range += beam.rangeBias + std::hypot(noise, material(hit).roughness) * random.normal();
  range = std::round(range / m_lidar.rangeStep) * m_lidar.rangeStep;
  if (range < m_lidar.minRange || range > m_lidar.maxRange) return std::nullopt;
  const double shine = best.signal * (0.85 + 0.3 * random.uniform());
  return PulseReturn{range, static_cast<float>(std::clamp(shine, 0.0, 1.0)),
                     hit.solid >= 0 ? m_solids[hit.solid].object : 0u};
}

}  // namespace polemcl::sim
