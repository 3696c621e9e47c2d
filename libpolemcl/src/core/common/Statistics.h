#pragma once
/// \file Statistics.h
/// \brief Quantiles of numbers and of the standard normal distribution.

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

namespace polemcl {

/// \brief The element that would have this index if the values were sorted. Reorders the values.
/// \param rank Below the number of values.
template <class T>
T elementOfRank(std::vector<T>& values, std::size_t rank) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// \brief The q-quantile, linear between ranks. \param q In [0, 1]. \return Nothing for no values.
std::optional<double> quantile(std::vector<double> values, double q);

/// \brief The q-quantile, as the value of the nearest rank. \param q In [0, 1].
/// \param values At least one.
double nearestRank(std::vector<double> values, double q);

/// \brief The number that a standard normal variable stays below with probability p.
///
/// Acklam's rational approximation (2003), relative error 1.2e-9. Not Boost.Math: simulated
/// sessions keep their numbers. \param p Clamped to [1e-9, 1 - 1e-9].
double normalQuantile(double p);

}  // namespace polemcl
