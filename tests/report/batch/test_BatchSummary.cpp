#include <gtest/gtest.h>

#include <cmath>

#include "report/batch/BatchSummary.h"
#include "support/SampleBatches.h"

namespace polemcl::report::test_batch_summary {

TEST(BatchSummary, SpreadOfAHandfulOfNumbers) {
  // Mean 5, squares 9 + 1 + 1 + 1 + 0 + 0 + 4 + 16 = 32, over 7.
  const Spread spread = spreadOf({2, 4, 4, 4, 5, noFigure, 5, 7, 9});
  EXPECT_EQ(spread.count, 8u);
  EXPECT_DOUBLE_EQ(spread.mean, 5);
  EXPECT_DOUBLE_EQ(spread.deviation, std::sqrt(32.0 / 7));
  EXPECT_DOUBLE_EQ(spread.largest, 9);
}

TEST(BatchSummary, OneValueHasNoDeviationAndNoneHasNothing) {
  const Spread one = spreadOf({3}), none = spreadOf({noFigure});
  EXPECT_EQ(one.mean, 3);
  EXPECT_TRUE(std::isnan(one.deviation));
  EXPECT_EQ(none.count, 0u);
  EXPECT_TRUE(std::isnan(none.mean) && std::isnan(none.largest));
}

TEST(BatchSummary, ARunIsLostWithoutAPoseOrFarOff) {
  BatchRun run = runWith(0, 0.1, 0.1);
  EXPECT_EQ(stateOf(run, 2), RunState::ok);
  run.errors.posEnd = 2.1;  // it ended somewhere else
  EXPECT_EQ(stateOf(run, 2), RunState::lost);
  run.errors.posEnd = 0.1, run.errors.posMean = 2.1;
  EXPECT_EQ(stateOf(run, 2), RunState::lost);
  EXPECT_EQ(stateOf(run, 3), RunState::ok);
  EXPECT_EQ(stateOf(BatchRun(), 2), RunState::lost);
  EXPECT_EQ(stateOf(failedRun(0, "no map"), 2), RunState::failed);
}

TEST(BatchSummary, SessionsAreMeansOverTheirRuns) {
  const ConfigurationSummary plain = summarize(smallBatch())[0];
  ASSERT_EQ(plain.sessions.size(), 3u);
  const SessionSummary &first = plain.sessions[0], &second = plain.sessions[1];
  EXPECT_NEAR(first.figures.posMean.mean, 0.2, 1e-12);
  EXPECT_NEAR(first.figures.posMean.deviation, std::sqrt(0.02), 1e-12);
  EXPECT_NEAR(first.figures.posRmse.mean, 0.4, 1e-12);
  EXPECT_NEAR(first.figures.angRmseDeg.mean, 0.6, 1e-12);
  EXPECT_NEAR(first.figures.posMax.largest, 0.9, 1e-12);
  // Per axis: sqrt((0.09 + 0.16) / 2) times 0.1 and 0.3.
  EXPECT_NEAR(first.figures.axisRmse.mean, 0.2 * std::sqrt(0.125), 1e-12);
  EXPECT_NEAR(first.figures.ok.mean, 0.9, 1e-12);
  EXPECT_EQ(first.relocalizations, 1);
  EXPECT_EQ(second.counts.failed, 1u);
  EXPECT_EQ(second.counts.lost, 0u);
  EXPECT_NEAR(second.figures.posMean.mean, 0.4, 1e-12);
  EXPECT_EQ(second.figures.posMean.count, 1u);
}

TEST(BatchSummary, ConfigurationsAreMeansOverTheirSessions) {
  const ConfigurationSummary plain = summarize(smallBatch())[0];
  // Each session once, however many runs it has; lost runs with a pose are in: 0.2, 0.4, 4.
  EXPECT_NEAR(plain.figures.posMean.mean, 4.6 / 3, 1e-12);
  EXPECT_NEAR(plain.figures.posMax.largest, 12, 1e-12);
  EXPECT_NEAR(plain.lastOverFirst, 4 / 0.2, 1e-12);
  EXPECT_NEAR(plain.mapShare.mean, 0.625, 1e-12);
  EXPECT_EQ(plain.counts.runs, 6u);
  EXPECT_EQ(plain.counts.lost, 2u);
  EXPECT_EQ(plain.counts.failed, 1u);
  EXPECT_EQ(plain.localized, 3u);
  EXPECT_EQ(plain.lostSessions, 1u);
}

TEST(BatchSummary, ScoresAreMeansOverTheMaps) {
  BatchResults batch = scoredBatch();
  batch.results[0].score = batch.results[3].score;  // P 1, R 0.8, F1 16/18
  const auto summaries = summarize(batch);
  EXPECT_EQ(summaries[0].scores.maps, 2u);
  EXPECT_NEAR(summaries[0].scores.near.precision, (0.75 + 1) / 2, 1e-12);
  EXPECT_NEAR(summaries[0].scores.near.recall, (0.6 + 0.8) / 2, 1e-12);
  // 6 of 8 and of 10: F1 = 12/18. A mean of F1, not the F1 of the means.
  EXPECT_NEAR(summaries[0].scores.near.f1, (12 / 18.0 + 16 / 18.0) / 2, 1e-12);
  EXPECT_NEAR(summaries[0].scores.oneToOne.precision, 5 / 8.0, 1e-12);
  EXPECT_NEAR(summaries[0].scores.oneToOneHalf.recall, 0.4, 1e-12);
  EXPECT_EQ(summaries[1].scores.maps, 1u);
  EXPECT_EQ(summarize(smallBatch())[0].scores.maps, 0u);
  EXPECT_TRUE(std::isnan(summarize(smallBatch())[0].scores.near.f1));
}

TEST(BatchSummary, SharesOfTheMapAreThoseOfTheLocalizedSessions) {
  BatchResults batch = smallBatch();
  batch.results[0].runs.clear();  // mapped only
  EXPECT_EQ(summarize(batch)[0].mapShare.mean, 0.25);
  for (SessionResult& result : batch.results) result.runs.clear();
  EXPECT_EQ(summarize(batch)[0].mapShare.mean, 0.625);
}

TEST(BatchSummary, OneSessionHasNothingToCompareTheLastWith) {
  const ConfigurationSummary upkeep = summarize(smallBatch())[1];
  ASSERT_EQ(upkeep.sessions.size(), 1u);
  EXPECT_EQ(upkeep.sessions[0].session, 1u);
  EXPECT_TRUE(std::isnan(upkeep.lastOverFirst));
}

TEST(BatchSummary, SessionsAreInTheOrderOfTheBatch) {
  BatchResults batch = smallBatch();
  std::swap(batch.results[0], batch.results[2]);
  EXPECT_NEAR(summarize(batch)[0].lastOverFirst, 20, 1e-9);
}

}  // namespace polemcl::report::test_batch_summary
