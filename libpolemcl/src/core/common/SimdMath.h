#pragma once
/// \file SimdMath.h
/// \brief Elementary functions of many numbers at once, in vectors chosen at run time. Every
/// instruction set gives the same bits, which the standard library's functions do not promise.

#include <cstddef>
#include <cstdint>

namespace polemcl {

/// \brief out[i] = e^values[i]; 0 below -708, where results would be denormal. Values at most 709;
/// `out` may be `values`. Relative error below 1e-15.
void exponentials(const double* values, std::size_t count, double* out);

/// \brief Sines and cosines; absolute error below 1e-15. Angles up to 1e6 rad, beyond less exact;
/// not a number for those that are not finite.
void sinesAndCosines(const double* angles, std::size_t count, double* sines, double* cosines);

/// \brief Independent standard normal deviates, of 2·pairs numbers uniform in all 32 bits (Box and
/// Muller 1958). None is beyond 6.7.
void normalDeviates(const std::uint32_t* uniform, std::size_t pairs, double* out);

}  // namespace polemcl
