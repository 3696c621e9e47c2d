#include <polemcl/apps/FilterRuns.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <chrono>
#include <mutex>

namespace polemcl::apps {

namespace {

FilterRun runFilter(PoleLocalization localization, const std::vector<PoleFrame>& frames,
                    const StartOptions& start, const RunObserver& observer,
                    const std::function<void()>& stepDone) {
  const auto begin = std::chrono::steady_clock::now();
  FilterRun run;
  run.updates.reserve(frames.size());
  if (start.anywhere)
    localization.startAnywhere();
  else
    localization.start(start);
  for (const PoleFrame& frame : frames) {
    run.updates.push_back(localization.step(frame));
    if (observer) observer(localization, frame, run.updates.back());
    stepDone();
  }
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return run;
}

}  // namespace

std::vector<StampedPose2D> FilterRun::trajectory() const {
  std::vector<StampedPose2D> poses;
  for (const LocalizationUpdate& update : updates)
    if (update.estimate) poses.push_back({update.time, update.estimate->mean});
  return poses;
}

std::vector<FilterRun> runFilters(const LocalizationMap& map, const std::vector<PoleFrame>& frames,
                                  const LocalizationOptions& options, const StartOptions& start,
                                  const RunOptions& runs, const RunWatch& watch) {
  runs.validate();
  std::vector<FilterRun> results(runs.runs);
  std::atomic<std::size_t> done{0};
  std::mutex busy;
  const auto stepDone = [&] {
    const std::size_t count = ++done;
    const std::unique_lock<std::mutex> lock(busy, std::try_to_lock);
    if (watch.progress && lock) watch.progress(count);
  };
  tbb::parallel_for(0, runs.runs, [&](int i) {
    const std::uint32_t seed = runs.seed + static_cast<std::uint32_t>(i);
    results[i] = runFilter(PoleLocalization(map, options, seed), frames, start,
                           i == 0 ? watch.observer : RunObserver(), stepDone);
    results[i].seed = seed;
  });
  return results;
}

}  // namespace polemcl::apps
