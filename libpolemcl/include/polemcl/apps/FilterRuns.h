#pragma once
/// \file FilterRuns.h
/// \brief The same drive localized several times, in parallel, each run with its own seed.

#include <polemcl/core/Evaluation.h>
#include <polemcl/mrpt/PoleLocalizer.h>

#include <functional>
#include <memory>
#include <vector>

namespace polemcl::apps {

/// \brief One run of the filter over a drive. Element i of each list belongs to scan i.
struct FilterRun {
  std::uint32_t seed = 0;
  std::vector<StampedPose2D> trajectory;
  std::vector<StepReport> steps;
  double seconds = 0;  ///< spent in the filter
};

/// \brief Runs the filter `runs.runs` times over the frames, on all threads. Run i has the seed
/// `runs.seed + i` and the same bytes on any number of threads.
/// \param progress Called with the number of frames done in all runs, from one thread at a time;
///        may be empty.
/// \throws Error as PoleLocalizer does.
std::vector<FilterRun> runFilters(const std::shared_ptr<const CPoleMap>& map,
                                  const std::vector<PoleFrame>& frames, const FilterOptions& filter,
                                  const StartOptions& start, const RunOptions& runs,
                                  const std::function<void(std::size_t)>& progress = {});

}  // namespace polemcl::apps
