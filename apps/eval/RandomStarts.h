#pragma once
/// \file RandomStarts.h
/// \brief Trials that start at random scans of a drive, in parallel.

#include <tbb/parallel_for.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "localize/TrialDrive.h"

namespace polemcl::apps {

struct RandomStartsOptions {
  TrialDriveFiles files;
  int trials = 200;
  std::uint32_t seed = 1;  ///< of the starts; trial i filters with seed + i
  double metres = 60;      ///< driven in each trial, at most
  std::optional<std::filesystem::path> json;
  /// Called after each trial, from any thread; may be empty.
  std::function<void()> progress = {};
};

/// \brief Scans that trials start from: drawn uniformly among those after which `metres` are still
/// driven. \param driven From distancesDriven().
/// \throws Error when the drive is not longer than `metres`, or options are out of range.
std::vector<std::size_t> drawStarts(const std::vector<double>& driven, int trials, double metres,
                                    std::uint32_t seed);

/// \brief One trial per start, each with a fresh chain. The same on any number of threads.
/// \param run Gets the drive, the distances driven, the first scan, `metres` and the seed.
/// \throws Error as drawStarts().
template <class Trial>
std::vector<Trial> runTrials(const TrialDrive& drive, const RandomStartsOptions& options,
                             Trial (*run)(const TrialDrive&, const std::vector<double>&,
                                          std::size_t, double, std::uint32_t)) {
  const std::vector<double> driven = distancesDriven(drive.truth);
  const auto first = drawStarts(driven, options.trials, options.metres, options.seed);
  std::vector<Trial> trials(options.trials);
  tbb::parallel_for(0, options.trials, [&](int i) {
    trials[i] =
        run(drive, driven, first[i], options.metres, options.seed + static_cast<std::uint32_t>(i));
    if (options.progress) options.progress();
  });
  return trials;
}

}  // namespace polemcl::apps
