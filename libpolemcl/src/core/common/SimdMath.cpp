#include "core/common/SimdMath.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/common/SimdMath.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/common/VectorMath.inc"

HWY_BEFORE_NAMESPACE();
namespace polemcl {
namespace HWY_NAMESPACE {

constexpr std::size_t kMostLanes = HWY_MAX_BYTES / sizeof(double);

/// Calls body(in, out) for whole vectors; the rest goes through buffers, filled up with zeros.
template <class D, class Body>
void forVectors(D d, std::size_t count, const double* in, const Body& body) {
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) body(in + i, i, lanes);
  if (i == count) return;
  double rest[kMostLanes] = {};
  std::copy(in + i, in + count, rest);
  body(rest, i, count - i);
}

/// The first `count` lanes.
template <class D, class V>
HWY_INLINE void store(D d, V v, double* out, std::size_t count) {
  if (count == hn::Lanes(d)) return hn::StoreU(v, d, out);
  double all[kMostLanes];
  hn::StoreU(v, d, all);
  std::copy(all, all + count, out);
}

void exponentials(const double* values, std::size_t count, double* out) {
  const hn::ScalableTag<double> d;
  forVectors(d, count, values, [&](const double* in, std::size_t i, std::size_t n) {
    store(d, exponential(d, hn::LoadU(d, in)), out + i, n);
  });
}

void sinesAndCosines(const double* angles, std::size_t count, double* sines, double* cosines) {
  const hn::ScalableTag<double> d;
  forVectors(d, count, angles, [&](const double* in, std::size_t i, std::size_t n) {
    hn::Vec<decltype(d)> s, c;
    sineAndCosine(d, hn::LoadU(d, in), s, c);
    store(d, s, sines + i, n);
    store(d, c, cosines + i, n);
  });
}

void normalDeviates(const std::uint32_t* uniform, std::size_t pairs, double* out) {
  const hn::ScalableTag<double> d;
  constexpr std::size_t block = 64;
  double first[block], second[block];
  for (std::size_t begin = 0; begin < pairs; begin += block) {
    const std::size_t n = std::min(block, pairs - begin);
    for (std::size_t i = 0; i < block; ++i) {  // the middles of 2^32 equal steps
      const std::size_t from = 2 * (begin + std::min(i, n - 1));
      first[i] = (uniform[from] + 0.5) * 0x1p-32;
      second[i] = (uniform[from + 1] + 0.5) * (0x1p-31 * 3.14159265358979323846);
    }
    for (std::size_t i = 0; i < block; i += hn::Lanes(d)) {
      const auto radius =
          hn::Sqrt(hn::Mul(hn::Set(d, -2.0), logarithm(d, hn::LoadU(d, first + i))));
      hn::Vec<decltype(d)> s, c;
      sineAndCosine(d, hn::LoadU(d, second + i), s, c);
      hn::StoreU(hn::Mul(radius, c), d, first + i);
      hn::StoreU(hn::Mul(radius, s), d, second + i);
    }
    for (std::size_t i = 0; i < n; ++i) {
      out[2 * (begin + i)] = first[i];
      out[2 * (begin + i) + 1] = second[i];
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace polemcl
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace polemcl {
HWY_EXPORT(exponentials);
HWY_EXPORT(sinesAndCosines);
HWY_EXPORT(normalDeviates);

void exponentials(const double* values, std::size_t count, double* out) {
  HWY_DYNAMIC_DISPATCH(exponentials)(values, count, out);
}

void sinesAndCosines(const double* angles, std::size_t count, double* sines, double* cosines) {
  HWY_DYNAMIC_DISPATCH(sinesAndCosines)(angles, count, sines, cosines);
}

void normalDeviates(const std::uint32_t* uniform, std::size_t pairs, double* out) {
  HWY_DYNAMIC_DISPATCH(normalDeviates)(uniform, pairs, out);
}
}  // namespace polemcl
#endif
