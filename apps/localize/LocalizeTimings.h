#pragma once
/// \file LocalizeTimings.h
/// \brief How long `pole-localize` took from a scan to its pose, stage by stage.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "localize/LatencyHistogram.h"

namespace polemcl::apps {

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
