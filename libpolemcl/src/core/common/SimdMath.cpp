#include "core/common/SimdMath.h"

#include <algorithm>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/common/SimdMath.cpp"
// foreach_target.h stands before all that it compiles again.
// clang-format off
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <hwy/contrib/algo/transform-inl.h>
#include <hwy/contrib/math/math-inl.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace polemcl {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

struct Exponential {
  template <class D, class V>
  HWY_INLINE V operator()(D d, V value) const {
    return hn::Exp(d, value);
  }
};

struct Sine {
  template <class D, class V>
  HWY_INLINE V operator()(D d, V, V angle) const {
    return hn::Sin(d, angle);
  }
};

struct Cosine {
  template <class D, class V>
  HWY_INLINE V operator()(D d, V, V angle) const {
    return hn::Cos(d, angle);
  }
};

/// The length of a pair of normal deviates, from a number uniform in (0, 1).
struct Radius {
  template <class D, class V>
  HWY_INLINE V operator()(D d, V uniform) const {
    return hn::Sqrt(hn::Mul(hn::Set(d, -2.0), hn::Log(d, uniform)));
  }
};

void exponentials(double* values, std::size_t count) {
  hn::Transform(hn::ScalableTag<double>(), values, count, Exponential());
}

void sinesAndCosines(const double* angles, std::size_t count, double* sines, double* cosines) {
  const hn::ScalableTag<double> d;
  hn::Transform1(d, sines, count, angles, Sine());
  hn::Transform1(d, cosines, count, angles, Cosine());
}

void normalDeviates(const std::uint32_t* uniform, std::size_t pairs, double* out) {
  std::vector<double> radius(pairs), angle(pairs), sine(pairs), cosine(pairs);
  for (std::size_t i = 0; i < pairs; ++i) {  // the middles of 2^32 equal steps
    radius[i] = (uniform[2 * i] + 0.5) * 0x1p-32;
    angle[i] = (uniform[2 * i + 1] + 0.5) * (0x1p-31 * 3.14159265358979323846);
  }
  hn::Transform(hn::ScalableTag<double>(), radius.data(), pairs, Radius());
  sinesAndCosines(angle.data(), pairs, sine.data(), cosine.data());
  for (std::size_t i = 0; i < pairs; ++i) {
    out[2 * i] = radius[i] * cosine[i];
    out[2 * i + 1] = radius[i] * sine[i];
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

void exponentials(double* values, std::size_t count) {
  HWY_DYNAMIC_DISPATCH(exponentials)(values, count);
}

void sinesAndCosines(const double* angles, std::size_t count, double* sines, double* cosines) {
  HWY_DYNAMIC_DISPATCH(sinesAndCosines)(angles, count, sines, cosines);
}

void normalDeviates(const std::uint32_t* uniform, std::size_t pairs, double* out) {
  HWY_DYNAMIC_DISPATCH(normalDeviates)(uniform, pairs, out);
}
}  // namespace polemcl
#endif
