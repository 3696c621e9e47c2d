#pragma once
/// \file Random.h
/// \brief Small seeded generator with its own distributions: equal bytes on every platform.

#include <cmath>
#include <cstdint>

namespace polemcl::sim {

/// \brief One 64-bit hash of `value` (finalizer of SplitMix64, Steele et al. 2014).
inline std::uint64_t hash(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15ull;
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ull;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebull;
  return value ^ (value >> 31);
}
/// \brief Hash of an ordered list of numbers: gives independent streams from one seed.
template <class... Rest>
std::uint64_t hash(std::uint64_t first, Rest... rest) {
  return hash(hash(first) ^ (hash(static_cast<std::uint64_t>(rest)...) * 0x2545f4914f6cdd1dull));
}
/// \brief Uniform in [0, 1) from the upper bits of a hash.
inline float unitFloat(std::uint64_t bits) {
  return static_cast<float>(bits >> 40) * 0x1p-24f;
}

/// \brief SplitMix64 sequence. It is cheap to create, so that each scan, object and pixel has its
/// own.
class Random {
 public:
  explicit Random(std::uint64_t seed) : m_state(seed) {}
  std::uint64_t next() {
    const std::uint64_t value = hash(m_state);
    m_state += 0x9e3779b97f4a7c15ull;
    return value;
  }
  /// \brief Uniform in [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// \brief Standard normal (Box-Muller, one number of the pair).
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * M_PI * uniform());
  }
  double normal(double mean, double sigma) { return mean + sigma * normal(); }
  bool chance(double probability) { return uniform() < probability; }
  /// \brief Uniform integer in [0, count).
  int below(int count) { return static_cast<int>(uniform() * count); }

 private:
  std::uint64_t m_state;
};

/// \brief A standard normal number from the bits of a hash, by table lookup. Its error is below
/// 0.01 within 3.5 standard deviations; it never lies beyond them. Intended for noise that is
/// summed over many terms.
double normalFromHash(std::uint64_t bits);

}  // namespace polemcl::sim
