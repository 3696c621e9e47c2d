#pragma once
/// \file LocalizeTimings.h
/// \brief How long `pole-localize` took from a scan to its pose, stage by stage.

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace polemcl::apps {

/// \brief Median, 99 % and worst of any number of durations, in constant memory.
///
/// Counts durations in bins whose width is 1 % of the duration, from 1 µs to 1000 s.
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

/// \brief Latencies of the stages that a scan passes. Scans overlap: while one is filtered, the
/// next ones are read and extracted, so `total` may be longer or shorter than what the stages add
/// up to.
struct LocalizeTimings {
  /// From the rawlog; clouds in files of their own count for `extract`. Sensors: from the arrival
  /// of a scan until it is taken.
  LatencyHistogram read;
  LatencyHistogram extract;  ///< points and poles; empty where the rawlog holds poles
  LatencyHistogram step;     ///< of the filter, each run for itself
  LatencyHistogram write;    ///< results of all runs, and the view
  /// From the moment a scan is there (read; with a rate: due; from a sensor: arrived) until all
  /// runs have its pose and it is streamed.
  LatencyHistogram total;
  std::vector<double> filterSeconds;  ///< of each run, all scans
  double wallSeconds = 0;             ///< from the first read to the last result
  std::optional<double> rate;         ///< times the pace of the recording; none: full speed
};

/// \brief The layout of `timings.json`, see LocalizeApp.h.
nlohmann::ordered_json timingsJson(const LocalizeTimings& timings);

/// \brief One line: median, 99 % and worst of each stage that had any scan, ms.
std::string timingsLine(const LocalizeTimings& timings);

}  // namespace polemcl::apps
