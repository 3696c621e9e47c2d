#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "localize/FilterRuns.h"
#include "support/PoleStreet.h"
#include "support/Refusal.h"

namespace polemcl::test_filter_runs {
namespace {

using namespace polemcl::apps;

using Updates = std::vector<LocalizationUpdate>;

class FilterRunsTest : public testing::Test {
 protected:
  FilterRunsTest() {
    tests::StreetOptions wanted;
    wanted.scans = 30;
    street = tests::makeStreet(wanted);
    start.pose = street.truth[0];
    options.filter.particles = 101;  // odd: an odd number of normal deviates a step
    start.particles = 1;
    runs.runs = 5;
    runs.seed = 40;
  }
  SettingsValues settings(const RunOptions& which) const {
    SettingsValues values;
    values.localization = options;
    values.start = start;
    values.runs = which;
    return values;
  }
  /// Element [i][k]: what run i made of scan k.
  std::vector<Updates> run(const RunOptions& which) {
    FilterRuns filters({street.map}, settings(which));
    std::vector<Updates> results(filters.size());
    for (const PoleScan& frame : street.frames) {
      const auto& steps = filters.step(frame);
      for (std::size_t i = 0; i < steps.size(); ++i) results[i].push_back(steps[i].update);
    }
    figures = filters.results();
    return results;
  }
  tests::PoleStreet street;
  LocalizationOptions options;
  StartOptions start;
  RunOptions runs;
  std::vector<FilterRun> figures;  ///< of the last run()
};

void expectEqual(const Updates& a, const Updates& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].time, b[i].time);
    EXPECT_EQ(a[i].estimate->mean.x, b[i].estimate->mean.x);
    EXPECT_EQ(a[i].estimate->mean.yaw, b[i].estimate->mean.yaw);
    EXPECT_EQ(a[i].health.innovation, b[i].health.innovation);
  }
}

TEST_F(FilterRunsTest, OneUpdatePerScanAtItsTime) {
  const auto results = run(runs);
  ASSERT_EQ(results.size(), 5u);
  for (const auto& result : results) {
    ASSERT_EQ(result.size(), street.frames.size());
    for (std::size_t i = 0; i < street.frames.size(); ++i) {
      EXPECT_EQ(result[i].time, street.frames[i].time);
      EXPECT_EQ(result[i].poles, street.frames[i].poles_robot.size());
    }
  }
}

TEST_F(FilterRunsTest, RunIHasTheSeedOfItsPlace) {
  const auto all = run(runs);
  const auto seeds = figures;
  RunOptions one;
  for (int i = 0; i < runs.runs; ++i) {
    one.seed = runs.seed + i;
    expectEqual(all[i], run(one)[0]);
    EXPECT_EQ(seeds[i].seed, one.seed);
  }
  EXPECT_NE(all[0][5].estimate->mean.x, all[1][5].estimate->mean.x);
}

TEST_F(FilterRunsTest, SameOnAnyNumberOfThreads) {
  std::vector<Updates> alone;
  {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    alone = run(runs);
  }
  const auto together = run(runs);
  for (int i = 0; i < runs.runs; ++i) expectEqual(alone[i], together[i]);
}

TEST_F(FilterRunsTest, CountsWhatTheUpdatesSay) {
  start.anywhere = true;
  const auto results = run(runs);
  for (std::size_t i = 0; i < results.size(); ++i) {
    FilterRun counted;
    std::size_t scan = 0;
    for (const auto& update : results[i]) {
      if (update.estimate && !counted.firstPose) counted.firstPose = scan;
      counted.resampled += update.step.resampled;
      counted.relocalizations += update.relocalized;
      ++counted.states[static_cast<int>(update.health.state)];
      if (update.health.state != HealthState::ok) ++counted.reasons[update.health.reason];
      ++scan;
    }
    EXPECT_EQ(figures[i].scans, results[i].size());
    EXPECT_EQ(figures[i].firstPose, counted.firstPose);
    EXPECT_EQ(figures[i].resampled, counted.resampled);
    EXPECT_EQ(figures[i].relocalizations, counted.relocalizations);
    EXPECT_EQ(figures[i].reasons, counted.reasons);
    for (int state = 0; state < 3; ++state)
      EXPECT_EQ(figures[i].states[state], counted.states[state]) << state;
  }
}

TEST_F(FilterRunsTest, HandsRefusalsOn) {
  street.frames[7].motion.reset();
  EXPECT_THROW(run(runs), Error);
  runs.runs = 0;
  EXPECT_THROW(run(runs), Error);
}

TEST_F(FilterRunsTest, RefusesMoreParticlesThanFitSideBySide) {
  runs.runs = 51;
  start.particles = 1000000;
  EXPECT_REFUSED(FilterRuns({street.map}, settings(runs)), "51 runs of 1000000 particles");
}

}  // namespace
}  // namespace polemcl::test_filter_runs
