#include <gtest/gtest.h>

#include <numeric>

#include <polemcl/core/common/Types.h>
#include "report/batch/BatchResults.h"
#include "support/SampleBatches.h"

namespace polemcl::report::test_batch_results {

TEST(BatchResults, ARunIsLostWithoutAPoseOrFarOff) {
  BatchRun run = runWith(0, 0.1, 0.1);
  EXPECT_STREQ(stateOf(run, 2), "ok");
  run.errors.posEnd = 2.1;  // it ended somewhere else
  EXPECT_STREQ(stateOf(run, 2), "lost");
  run.errors.posEnd = 0.1, run.errors.posMean = 2.1;
  EXPECT_STREQ(stateOf(run, 2), "lost");
  EXPECT_STREQ(stateOf(run, 3), "ok");
  EXPECT_STREQ(stateOf(BatchRun(), 2), "lost");
  EXPECT_STREQ(stateOf(failedRun(0, "no map"), 2), "failed");
}

TEST(BatchResults, HistogramEdgesAreTenToAFactorOfTen) {
  EXPECT_NEAR(ErrorHistogram::edge(0), 1e-3, 1e-15);
  EXPECT_NEAR(ErrorHistogram::edge(10), 1e-2, 1e-14);
  EXPECT_NEAR(ErrorHistogram::edge(23), 0.199526231, 1e-8);
  EXPECT_NEAR(ErrorHistogram::edge(ErrorHistogram::bins), 100, 1e-9);
}

TEST(BatchResults, EachValueFallsBetweenTheEdgesOfItsBin) {
  for (double value = 1.01e-3; value < 99; value *= 1.07) {
    ErrorHistogram histogram;
    histogram.add(value);
    for (std::size_t i = 0; i < ErrorHistogram::bins; ++i) {
      const bool within = ErrorHistogram::edge(i) <= value && value < ErrorHistogram::edge(i + 1);
      EXPECT_EQ(histogram.counts[i], within ? 1u : 0u) << value << " in bin " << i;
    }
  }
}

TEST(BatchResults, ValuesBeyondTheHistogramAreCountedAtItsEnds) {
  ErrorHistogram histogram;
  for (double value : {0.0, 1e-5, 1e4}) histogram.add(value);
  EXPECT_EQ(histogram.counts.front(), 2u);
  EXPECT_EQ(histogram.counts.back(), 1u);
  EXPECT_EQ(std::accumulate(histogram.counts.begin(), histogram.counts.end(), 0u), 3u);
  EXPECT_THROW(histogram.add(-0.1), Error);
  EXPECT_THROW(histogram.add(noFigure), Error);
}

TEST(BatchResults, FindsAPairAndNothingElse) {
  const BatchResults batch = smallBatch();
  EXPECT_EQ(batch.find(1, 1), &batch.results[3]);
  EXPECT_EQ(batch.find(1, 0), nullptr);
}

}  // namespace polemcl::report::test_batch_results
