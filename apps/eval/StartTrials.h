#pragma once
/// \file StartTrials.h
/// \brief `pole-eval starts`: is the pose found that is known roughly at the start?

#include <optional>
#include <vector>

#include "eval/RandomStarts.h"

namespace polemcl::apps {

/// \brief One start. The pose given to the filter is drawn as `[start]` draws particles: uniformly
/// in the disc and the headings around the true pose.
struct StartTrial {
  std::size_t scan = 0;  ///< where it starts
  /// Driven until the estimate is right (0.5 m, 2°) for the rest of the trial; nothing: never.
  std::optional<double> rightMetres;
  std::optional<double> okMetres;  ///< driven until the health was `ok`
  double meanError = 0;            ///< of the position, over all scans of the trial, m
  double endError = 0;             ///< of the position, at its end, m
  bool okWrong = false;            ///< `ok` was said of a wrong pose
};

/// \brief Each trial has a fresh chain. Trials run in parallel; figures are the same on any number
/// of threads. \throws Error as drawStarts().
std::vector<StartTrial> runStartTrials(const TrialDrive& drive, const RandomStartsOptions& options);

/// \brief The table, and the JSON file if one is wanted (keys `trials right right_share ok_wrong
/// mean_m end_median_m right_metres_median right_metres_p95 right_metres_max ok_metres_median
/// map_poles`).
std::string evalStarts(const RandomStartsOptions& options);

}  // namespace polemcl::apps
