#include <polemcl/apps/FilterRuns.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <chrono>
#include <mutex>

namespace polemcl::apps {

namespace {

FilterRun runFilter(PoleLocalizer localizer, const std::vector<PoleFrame>& frames,
                    const StartOptions& start, const std::function<void()>& stepDone) {
  const auto begin = std::chrono::steady_clock::now();
  FilterRun run;
  run.trajectory.reserve(frames.size());
  run.steps.reserve(frames.size());
  localizer.start(start);
  for (const PoleFrame& frame : frames) {
    run.trajectory.push_back({frame.time, localizer.step(frame).mean});
    run.steps.push_back(localizer.report());
    stepDone();
  }
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return run;
}

}  // namespace

std::vector<FilterRun> runFilters(const std::shared_ptr<const CPoleMap>& map,
                                  const std::vector<PoleFrame>& frames, const FilterOptions& filter,
                                  const StartOptions& start, const RunOptions& runs,
                                  const std::function<void(std::size_t)>& progress) {
  runs.validate();
  std::vector<FilterRun> results(runs.runs);
  std::atomic<std::size_t> done{0};
  std::mutex busy;
  const auto stepDone = [&] {
    const std::size_t count = ++done;
    const std::unique_lock<std::mutex> lock(busy, std::try_to_lock);
    if (progress && lock) progress(count);
  };
  tbb::parallel_for(0, runs.runs, [&](int i) {
    const std::uint32_t seed = runs.seed + static_cast<std::uint32_t>(i);
    results[i] = runFilter(PoleLocalizer(map, filter, seed), frames, start, stepDone);
    results[i].seed = seed;
  });
  return results;
}

}  // namespace polemcl::apps
