#pragma once
/// \file SimdMath.h
/// \brief Elementary functions of many numbers at once, in vectors chosen at run time. Results may
/// differ between instruction sets in their last digits.

#include <cstddef>
#include <cstdint>

namespace polemcl {

/// \brief Replaces each value by e^value; 0 far below -708. Values at most 709. Relative error
/// below 1e-15.
void exponentials(double* values, std::size_t count);

/// \brief Sines and cosines; absolute error below 1e-15. Angles up to 39000 rad.
void sinesAndCosines(const double* angles, std::size_t count, double* sines, double* cosines);

/// \brief Independent standard normal deviates, of 2·pairs numbers uniform in all 32 bits (Box and
/// Muller 1958). None is beyond 6.7.
void normalDeviates(const std::uint32_t* uniform, std::size_t pairs, double* out);

}  // namespace polemcl
