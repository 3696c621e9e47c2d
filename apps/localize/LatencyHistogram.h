#pragma once
/// \file LatencyHistogram.h
/// \brief Median, 99 % and worst of any number of durations, in constant memory.

#include <array>
#include <cstddef>
#include <cstdint>

namespace polemcl::apps {

/// \brief Counts durations in bins whose width is 1 % of the duration, from 1 µs to 1000 s.
/// A percentile is the middle of its bin, so it is at most 0.5 % off; shorter durations count as
/// 1 µs, longer ones as 1000 s. Mean and worst are exact. 17 kB.
class LatencyHistogram {
 public:
  static constexpr double shortest = 1e-6, longest = 1e3;  ///< s
  static constexpr double binRatio = 1.01;  ///< of the upper bound of a bin to the lower

  void add(double seconds);
  std::size_t count() const { return m_count; }
  double worst() const { return m_worst; }  ///< s; 0 without durations
  double sum() const { return m_sum; }      ///< s
  /// \brief The least duration that `share` of all do not exceed, s; 0 without durations.
  /// \param share 0 to 1; 0.5 is the median.
  double percentile(double share) const;

 private:
  static constexpr std::size_t bins =
      2083;  ///< log(longest / shortest) / log(binRatio), rounded up
  std::array<std::uint64_t, bins> m_counts{};
  std::size_t m_count = 0;
  double m_sum = 0, m_worst = 0;
};

}  // namespace polemcl::apps
