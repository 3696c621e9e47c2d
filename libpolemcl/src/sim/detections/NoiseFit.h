#pragma once
/// \file NoiseFit.h
/// \brief Estimates the persistence of noise from correlations of pairs.

#include <cstddef>
#include <map>
#include <vector>

#include "sim/detections/PersistentNoise.h"

namespace polemcl::sim {

/// \brief Measured correlation between places at this distance.
struct LagCorrelation {
  double distance = 0;  ///< m
  bool sameDay = true;
  double correlation = 0;
};

/// \brief Least-squares fit of a spectrum to the measured correlations. Shares are not negative,
/// and their sum is at most 1.
NoiseSpectrum fitSpectrum(const std::vector<LagCorrelation>& counted);

/// \brief Correlation of zero-mean numbers, from pairs.
class PairedNumbers {
 public:
  void add(double a, double b);
  std::size_t count() const { return m_count; }
  double correlation() const;

 private:
  std::size_t m_count = 0;
  double m_ab = 0, m_aa = 0, m_bb = 0;
};

/// \brief Correlation of normal numbers if only "below or above a threshold" is known (tetrachoric
/// correlation, Pearson 1900).
class PairedHits {
 public:
  /// \param h, k Thresholds. \param both Both numbers lie below their thresholds.
  void add(double h, double k, bool both);
  std::size_t count() const { return m_count; }
  /// \brief The correlation for which the expected number of pairs below both thresholds equals the
  /// count.
  double correlation() const;

 private:
  std::map<std::pair<int, int>, std::size_t> m_cells;  ///< number of pairs by thresholds, in steps
  std::size_t m_count = 0, m_both = 0;
};

}  // namespace polemcl::sim
