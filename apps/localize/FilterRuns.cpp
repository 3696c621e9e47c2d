#include "localize/FilterRuns.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <string>

#include "cli/Progress.h"
#include "core/common/Binder.h"

namespace polemcl::apps {

namespace {

/// Calls work(i) for each run. The thread that calls helps with the runs and with nothing else, so
/// that a scan does not wait for the extraction of a later one.
template <class Work>
void forEachRun(std::size_t runs, const Work& work) {
  if (runs == 1) return work(0);
  tbb::this_task_arena::isolate([&] { tbb::parallel_for(std::size_t{0}, runs, work); });
}

}  // namespace

void FilterRun::add(const LocalizationUpdate& update) {
  ++states[static_cast<int>(update.health.state)];
  if (update.health.state != HealthState::ok) ++reasons[update.health.reason];
  if (update.estimate && !firstPose) firstPose = scans;
  relocalizations += update.relocalized ? 1 : 0;
  resampled += update.step.resampled ? 1 : 0;
  ++scans;
}

FilterRuns::FilterRuns(const LocalizationMap& map, const SettingsValues& settings) {
  const RunOptions& runs = settings.runs;
  const StartOptions& start = settings.start;
  checkOptions(runs);
  const auto count = static_cast<std::size_t>(runs.runs);
  const auto particles =
      static_cast<std::size_t>(std::max(start.particles, settings.localization.filter.particles));
  if (count * particles > mostParticles)
    throw Error(std::to_string(count) + " runs of " + std::to_string(particles) +
                " particles side by side: at most " + std::to_string(mostParticles) +
                " particles are allowed; localize in several calls, each with its own seed");
  m_filters.resize(count);
  m_results.resize(count);
  m_steps.resize(count);
  forEachRun(count, [&](std::size_t i) {
    const auto begin = ScanClock::now();
    const std::uint32_t seed = runs.seed + static_cast<std::uint32_t>(i);
    m_filters[i] = std::make_unique<Localizer>(Settings(settings), map, seed);
    m_results[i].seed = seed;
    m_results[i].seconds = secondsSince(begin);
  });
}

const std::vector<FilterStep>& FilterRuns::step(const PoleScan& frame) {
  forEachRun(m_filters.size(), [&](std::size_t i) {
    const auto begin = ScanClock::now();
    m_steps[i].update = m_filters[i]->step(frame);
    m_steps[i].seconds = secondsSince(begin);
    m_results[i].seconds += m_steps[i].seconds;
    m_results[i].add(m_steps[i].update);
  });
  return m_steps;
}

}  // namespace polemcl::apps
