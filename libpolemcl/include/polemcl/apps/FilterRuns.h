#pragma once
/// \file FilterRuns.h
/// \brief The same drive localized several times, in parallel, each run with its own seed.

#include <polemcl/core/Evaluation.h>
#include <polemcl/mrpt/PoleLocalization.h>

#include <functional>
#include <memory>
#include <vector>

namespace polemcl::apps {

/// \brief One run over a drive. Element i of `updates` belongs to scan i.
struct FilterRun {
  std::uint32_t seed = 0;
  std::vector<LocalizationUpdate> updates;
  double seconds = 0;  ///< spent in the localization

  /// \brief The estimates, one for each scan from the first with a known pose on.
  std::vector<StampedPose2D> trajectory() const;
};

/// \brief Sees every step of the first run, from the thread that runs it; may be empty.
using RunObserver = std::function<void(const PoleLocalization& localization, const PoleFrame& frame,
                                       const LocalizationUpdate& update)>;

/// \brief How runs are watched. Both may be empty.
struct RunWatch {
  /// Called with the number of frames done in all runs, from one thread at a time.
  std::function<void(std::size_t)> progress;
  RunObserver observer;
};

/// \brief Localizes the frames `runs.runs` times, on all threads. Run i has the seed
/// `runs.seed + i` and the same bytes on any number of threads.
/// \throws Error as PoleLocalization does.
std::vector<FilterRun> runFilters(const LocalizationMap& map, const std::vector<PoleFrame>& frames,
                                  const LocalizationOptions& options, const StartOptions& start,
                                  const RunOptions& runs, const RunWatch& watch = {});

}  // namespace polemcl::apps
