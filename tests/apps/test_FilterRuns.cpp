#include <gtest/gtest.h>
#include <polemcl/apps/FilterRuns.h>
#include <tbb/global_control.h>

#include "../mrpt/PoleStreet.h"

using namespace polemcl;
using namespace polemcl::apps;

namespace {

class FilterRuns : public testing::Test {
 protected:
  FilterRuns() {
    tests::StreetOptions wanted;
    wanted.scans = 30;
    street = tests::makeStreet(wanted);
    start.pose = street.truth[0];
    options.filter.particles = 101;  // odd: an odd number of normal deviates a step
    start.particles = 1;
    runs.runs = 5;
    runs.seed = 40;
  }
  std::vector<FilterRun> run(const RunOptions& which) {
    return runFilters({street.map, options.global}, street.frames, options, start, which);
  }
  tests::PoleStreet street;
  LocalizationOptions options;
  StartOptions start;
  RunOptions runs;
};

void expectEqual(const FilterRun& a, const FilterRun& b) {
  EXPECT_EQ(a.seed, b.seed);
  ASSERT_EQ(a.updates.size(), b.updates.size());
  for (std::size_t i = 0; i < a.updates.size(); ++i) {
    EXPECT_EQ(a.updates[i].time, b.updates[i].time);
    EXPECT_EQ(a.updates[i].estimate->mean.x, b.updates[i].estimate->mean.x);
    EXPECT_EQ(a.updates[i].estimate->mean.yaw, b.updates[i].estimate->mean.yaw);
    EXPECT_EQ(a.updates[i].health.innovation, b.updates[i].health.innovation);
  }
}

}  // namespace

TEST_F(FilterRuns, OnePosePerScanAtItsTime) {
  const auto results = run(runs);
  ASSERT_EQ(results.size(), 5u);
  for (const auto& result : results) {
    ASSERT_EQ(result.updates.size(), street.frames.size());
    ASSERT_EQ(result.trajectory().size(), street.frames.size());
    for (std::size_t i = 0; i < street.frames.size(); ++i) {
      EXPECT_EQ(result.trajectory()[i].time, street.frames[i].time);
      EXPECT_EQ(result.updates[i].poles, street.frames[i].poles_robot.size());
    }
  }
}

TEST_F(FilterRuns, RunIHasTheSeedOfItsPlace) {
  const auto all = run(runs);
  RunOptions one;
  for (int i = 0; i < runs.runs; ++i) {
    one.seed = runs.seed + i;
    expectEqual(all[i], run(one)[0]);
  }
  EXPECT_NE(all[0].trajectory()[5].pose.x, all[1].trajectory()[5].pose.x);
}

TEST_F(FilterRuns, SameOnAnyNumberOfThreads) {
  std::vector<FilterRun> alone;
  {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    alone = run(runs);
  }
  const auto together = run(runs);
  for (int i = 0; i < runs.runs; ++i) expectEqual(alone[i], together[i]);
}

TEST_F(FilterRuns, TellsProgressFromOneThreadAtATime) {
  std::size_t last = 0;
  int inside = 0;
  RunWatch watch;
  watch.progress = [&](std::size_t done) {
    EXPECT_EQ(++inside, 1);
    EXPECT_LE(done, 5 * street.frames.size());
    last = std::max(last, done);
    --inside;
  };
  runFilters({street.map, options.global}, street.frames, options, start, runs, watch);
  EXPECT_GT(last, 0u);
}

TEST_F(FilterRuns, ShowsEveryStepOfTheFirstRun) {
  std::vector<double> seen;
  RunWatch watch;
  watch.observer = [&](const PoleLocalization& localization, const PoleFrame& frame,
                       const LocalizationUpdate& update) {
    EXPECT_TRUE(localization.hasPose());
    EXPECT_EQ(frame.time, update.time);
    seen.push_back(update.estimate->mean.x);
  };
  const auto results =
      runFilters({street.map, options.global}, street.frames, options, start, runs, watch);
  ASSERT_EQ(seen.size(), street.frames.size());
  for (std::size_t i = 0; i < seen.size(); ++i)
    EXPECT_EQ(seen[i], results[0].updates[i].estimate->mean.x);
}

TEST_F(FilterRuns, HandsRefusalsOn) {
  street.frames[7].motion.reset();
  EXPECT_THROW(run(runs), Error);
}
