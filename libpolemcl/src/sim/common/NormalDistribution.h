#pragma once
/// \file NormalDistribution.h
/// \brief The standard normal distribution: of one number, of two that go together, from a hash.

#include <cstdint>

namespace polemcl::sim {

/// \brief P(z < x).
double normalCdf(double x);
/// \brief The inverse of normalCdf(); p is clamped to [1e-9, 1 - 1e-9].
/// Acklam's rational approximation (2003), relative error 1.2e-9.
double normalQuantile(double p);
/// \brief P(a < h and b < k) of two standard normal numbers with the given correlation in (-1, 1):
/// the integral over the correlation of Drezner and Wesolowsky (1990), 16 Gauss-Legendre points.
double bivariateNormalCdf(double h, double k, double correlation);

/// \brief A standard normal number from the bits of a hash, off by less than 0.01 within 3.5
/// deviations and never beyond: from a table, for noise that is summed up of many.
double normalFromHash(std::uint64_t bits);

}  // namespace polemcl::sim
