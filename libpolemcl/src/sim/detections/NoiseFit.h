#pragma once
/// \file NoiseFit.h
/// \brief Finds what lasts in noise from the correlation of pairs.

#include <cstddef>
#include <map>
#include <vector>

#include "sim/detections/PersistentNoise.h"

namespace polemcl::sim {

/// \brief Correlation between places so far apart, as counted.
struct LagCorrelation {
  double distance = 0;  ///< m
  bool sameDay = true;
  double correlation = 0;
};

/// \brief The spectrum whose correlations are nearest to those counted, in the sense of least
/// squares: shares are never negative, and sum up to 1 at most.
NoiseSpectrum fitSpectrum(const std::vector<LagCorrelation>& counted);

/// \brief Correlation of numbers of mean 0 from pairs of them.
class PairedNumbers {
 public:
  void add(double a, double b);
  std::size_t count() const { return m_count; }
  double correlation() const;

 private:
  std::size_t m_count = 0;
  double m_ab = 0, m_aa = 0, m_bb = 0;
};

/// \brief Correlation of normal numbers of which is known only whether they lie below thresholds
/// (tetrachoric correlation, Pearson 1900).
class PairedHits {
 public:
  /// \param h, k Thresholds. \param both Both lie below theirs.
  void add(double h, double k, bool both);
  std::size_t count() const { return m_count; }
  /// \brief The correlation for which as many pairs lie below on both sides as were counted.
  double correlation() const;

 private:
  std::map<std::pair<int, int>, std::size_t> m_cells;  ///< pairs by thresholds, in steps
  std::size_t m_count = 0, m_both = 0;
};

}  // namespace polemcl::sim
