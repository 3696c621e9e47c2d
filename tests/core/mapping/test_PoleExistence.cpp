#include <gtest/gtest.h>

#include <cmath>

#include "core/mapping/PoleExistence.h"

namespace polemcl::test_pole_existence {

TEST(PoleExistence, OneScanCountsAsBayesHasIt) {
  ExistenceLikelihood found, missed;
  found.add(true, 0, 0.8);
  missed.add(false, 0, 0.8);
  // P(found | pole) / P(found | none) = 0.8 / 0.08 = 10; missed: 0.2 / 0.92.
  EXPECT_NEAR(found.logRatio(), std::log(10), 1e-12);
  EXPECT_NEAR(missed.logRatio(), std::log(0.2 / 0.92), 1e-12);
  EXPECT_NEAR(updated(0.5, found.logRatio()), 10.0 / 11, 1e-12);
  EXPECT_NEAR(updated(0.5, missed.logRatio()), 0.2 / 1.12, 1e-12);
  EXPECT_EQ(found.found(), 1u);
  EXPECT_EQ(missed.missed(), 1u);
}

TEST(PoleExistence, ScansOfOneSectionCountOnce) {
  ExistenceLikelihood likelihood;
  for (int i = 0; i < 10; ++i) likelihood.add(i < 5, 0.4 * i, 0.8);  // 0 to 3.6 m
  EXPECT_NEAR(likelihood.logRatio(), 0.5 * std::log(10) + 0.5 * std::log(0.2 / 0.92), 1e-12);
  likelihood.add(true, 5.1, 0.8);  // the next section
  likelihood.add(true, 9.9, 0.8);
  EXPECT_NEAR(likelihood.logRatio(), 1.5 * std::log(10) + 0.5 * std::log(0.2 / 0.92), 1e-12);
  EXPECT_EQ(likelihood.found(), 7u);
  EXPECT_EQ(likelihood.missed(), 5u);
}

// Behind something, a find says less; where there was one, scans without a find count as well.
TEST(PoleExistence, HiddenPlacesSayLess) {
  ExistenceLikelihood likelihood;
  likelihood.add(false, 0, 0.8, true);
  EXPECT_EQ(likelihood.logRatio(), 0);
  likelihood.add(true, 6, 0.8, true);
  EXPECT_NEAR(likelihood.logRatio(), std::log(0.7 / 0.92) + std::log(0.3 / 0.08), 1e-12);
  EXPECT_EQ(likelihood.found(), 1u);
  EXPECT_EQ(likelihood.missed(), 0u);
}

TEST(PoleExistence, NothingIsEverCertain) {
  EXPECT_NEAR(updated(0.5, 100), 0.99, 1e-12);
  EXPECT_NEAR(updated(0.5, -100), 0.01, 1e-12);
  EXPECT_NEAR(updated(1, 0), 0.99, 1e-12);
  EXPECT_NEAR(updated(0, 0), 0.01, 1e-12);
  EXPECT_NEAR(updated(0.7, 0), 0.7, 1e-12);
}

TEST(PoleExistence, OwnCountsLowerTheDetectionChance) {
  PoleHistory history;
  EXPECT_NEAR(detectionChance(history), 0.75, 1e-12);
  history.seen = 20;
  history.missed = 60;
  EXPECT_NEAR(detectionChance(history), (20 * 0.75 + 20) / 100, 1e-12);
  history.missed = 100000;
  EXPECT_NEAR(detectionChance(history), 0.16, 1e-12) << "misses always count";
  history = {1000, 0};
  EXPECT_NEAR(detectionChance(history), 0.75, 1e-12) << "never above";
}

TEST(PoleExistence, DecaysWithTime) {
  EXPECT_NEAR(survived(0.9, 100 * 86400.0, 100), 0.9 / M_E, 1e-12);
  EXPECT_EQ(survived(0.9, 0, 100), 0.9);
  EXPECT_EQ(survived(0.9, -5, 100), 0.9);
}

}  // namespace polemcl::test_pole_existence
