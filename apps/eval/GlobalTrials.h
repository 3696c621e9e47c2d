#pragma once
/// \file GlobalTrials.h
/// \brief `pole-eval global`: is a vehicle found that starts anywhere?

#include <optional>
#include <vector>

#include "eval/RandomStarts.h"

namespace polemcl::apps {

/// \brief One random start.
struct GlobalTrial {
  std::size_t scan = 0;  ///< where it starts
  /// The first pose that the chain commits itself to (health not `lost`, not `ambiguous`) within
  /// `metres`: right within 0.5 m and 2°.
  enum class Outcome { right, wrong, undecided } outcome = Outcome::undecided;
  double metres = 0;                 ///< driven until then
  PlanarError error{};               ///< of that pose
  std::optional<double> okMetres;    ///< driven until the health was `ok`
  bool okWrong = false;              ///< `ok` was said of a wrong pose within `metres`
  std::vector<double> querySeconds;  ///< of each call of the chain in which the map was searched
};

/// \brief Starts are drawn uniformly among the scans after which `metres` are still driven, each
/// trial with a fresh chain that knows no pose. Trials run in parallel; all figures but times are
/// the same on any number of threads.
/// \throws Error when the drive is shorter than `metres`, or options are out of range.
std::vector<GlobalTrial> runGlobalTrials(const TrialDrive& drive,
                                         const RandomStartsOptions& options);

/// \brief The table, and the JSON file if one is wanted (keys `trials right wrong undecided
/// right_share wrong_share metres_median metres_p95 metres_max error_median_m error_max_m ok_wrong
/// map_poles`); beside it `<name>_timings.json` (`query_median_ms query_max_ms`).
std::string evalGlobal(const RandomStartsOptions& options);

}  // namespace polemcl::apps
