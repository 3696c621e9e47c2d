#pragma once
/// \file FilterRuns.h
/// \brief The same drive localized several times, side by side, each run with its own seed.

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include <polemcl/localizer/Localizer.h>
#include "localizer/SettingsValues.h"

namespace polemcl::apps {

/// \brief What is kept of a run: figures of all its scans, none of a single one.
struct FilterRun {
  std::uint32_t seed = 0;
  std::size_t scans = 0;
  std::size_t states[3] = {};                   ///< scans in each HealthState
  std::map<HealthReason, std::size_t> reasons;  ///< scans that were not ok, by reason
  std::optional<std::size_t> firstPose;         ///< 0-based scan from which on the pose was known
  std::size_t relocalizations = 0;              ///< scans at which the global search set the pose
  std::size_t resampled = 0;                    ///< scans after which the filter resampled
  double seconds = 0;                           ///< spent in the localization

  /// \brief One scan more.
  void add(const LocalizationUpdate& update);
};

/// \brief One scan of one run.
struct FilterStep {
  LocalizationUpdate update;
  double seconds = 0;  ///< spent on it
};

/// \brief Filters that take each scan of a drive together, on all threads. Run i has the seed
/// `runs.seed + i`, and the same bytes as alone and on any number of threads.
class FilterRuns {
 public:
  static constexpr std::size_t mostParticles = 50000000;  ///< in all runs, some 40 bytes each

  /// \throws Error as LocalizationPipeline does, on its options and on the start, and on more than
  /// `mostParticles`.
  FilterRuns(const LocalizationMap& map, const SettingsValues& settings);

  /// \brief One scan more. \return What each run made of it, until the next call.
  /// \throws Error as LocalizationPipeline::step(); the runs are of no use then.
  const std::vector<FilterStep>& step(const PoleScan& frame);

  std::size_t size() const { return m_filters.size(); }
  const std::vector<FilterRun>& results() const { return m_results; }
  const LocalizationPipeline& localization(std::size_t run) const {
    return m_filters[run]->pipeline();
  }

 private:
  std::vector<std::unique_ptr<Localizer>> m_filters;
  std::vector<FilterRun> m_results;
  std::vector<FilterStep> m_steps;  ///< of the last scan, element i of run i
};

}  // namespace polemcl::apps
