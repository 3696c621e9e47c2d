#include <gtest/gtest.h>

#include <cmath>

#include <polemcl/core/mapping/PoleExistence.h>

namespace polemcl::test_pole_existence {

using namespace polemcl;

namespace {

std::string refusal(const ExistenceOptions& options) {
  try {
    checkOptions(options);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Numbers that make sums easy to do by hand.
ExistenceOptions options() {
  ExistenceOptions o;
  o.detection = 0.8;
  o.falseDetection = 0.1;
  o.decorrelation = 5;
  o.certain = 0.99;
  return o;
}

}  // namespace

TEST(PoleExistence, OneScanCountsAsBayesHasIt) {
  ExistenceLikelihood found, missed;
  found.add(true, 0, options(), 0.8);
  missed.add(false, 0, options(), 0.8);
  // P(found | pole) / P(found | none) = 0.8 / 0.1 = 8; missed: 0.2 / 0.9.
  EXPECT_NEAR(found.logRatio(), std::log(8), 1e-12);
  EXPECT_NEAR(missed.logRatio(), std::log(2.0 / 9), 1e-12);
  EXPECT_NEAR(updated(0.5, found.logRatio(), options()), 8.0 / 9, 1e-12);
  EXPECT_NEAR(updated(0.5, missed.logRatio(), options()), 2.0 / 11, 1e-12);
  EXPECT_EQ(found.found(), 1u);
  EXPECT_EQ(missed.missed(), 1u);
}

TEST(PoleExistence, ScansOfOneSectionCountOnce) {
  ExistenceLikelihood likelihood;
  for (int i = 0; i < 10; ++i) likelihood.add(i < 5, 0.4 * i, options(), 0.8);  // 0 to 3.6 m
  EXPECT_NEAR(likelihood.logRatio(), 0.5 * std::log(8) + 0.5 * std::log(2.0 / 9), 1e-12);
  likelihood.add(true, 5.1, options(), 0.8);  // the next section
  likelihood.add(true, 9.9, options(), 0.8);
  EXPECT_NEAR(likelihood.logRatio(), 1.5 * std::log(8) + 0.5 * std::log(2.0 / 9), 1e-12);
  EXPECT_EQ(likelihood.found(), 7u);
  EXPECT_EQ(likelihood.missed(), 5u);
}

// Behind something, a find says less; where there was one, scans without a find count as well.
TEST(PoleExistence, HiddenPlacesSayLess) {
  ExistenceLikelihood likelihood;
  likelihood.add(false, 0, options(), 0.8, true);
  EXPECT_EQ(likelihood.logRatio(), 0);
  likelihood.add(true, 6, options(), 0.8, true);
  EXPECT_NEAR(likelihood.logRatio(), std::log(0.7 / 0.9) + std::log(3), 1e-12);
  EXPECT_EQ(likelihood.found(), 1u);
  EXPECT_EQ(likelihood.missed(), 0u);
}

TEST(PoleExistence, NothingIsEverCertain) {
  EXPECT_NEAR(updated(0.5, 100, options()), 0.99, 1e-12);
  EXPECT_NEAR(updated(0.5, -100, options()), 0.01, 1e-12);
  EXPECT_NEAR(updated(1, 0, options()), 0.99, 1e-12);
  EXPECT_NEAR(updated(0, 0, options()), 0.01, 1e-12);
  EXPECT_NEAR(updated(0.7, 0, options()), 0.7, 1e-12);
}

TEST(PoleExistence, OwnCountsLowerTheDetectionChance) {
  PoleHistory history;
  EXPECT_NEAR(detectionChance(history, options()), 0.8, 1e-12);
  history.seen = 20;
  history.missed = 60;
  EXPECT_NEAR(detectionChance(history, options()), (20 * 0.8 + 20) / 100, 1e-12);
  history.missed = 100000;
  EXPECT_NEAR(detectionChance(history, options()), 0.2, 1e-12) << "misses always count";
  history = {1000, 0};
  EXPECT_NEAR(detectionChance(history, options()), 0.8, 1e-12) << "never above";
}

TEST(PoleExistence, DecaysWithTime) {
  ExistenceOptions o = options();
  o.lifetimeDays = 100;
  EXPECT_NEAR(survived(0.9, 100 * 86400.0, o), 0.9 / M_E, 1e-12);
  EXPECT_EQ(survived(0.9, 0, o), 0.9);
  EXPECT_EQ(survived(0.9, -5, o), 0.9);
}

TEST(PoleExistence, RefusesWhatMakesNoSense) {
  EXPECT_EQ(refusal({}), "");
  const auto refused = [](double ExistenceOptions::*field, double value) {
    ExistenceOptions o;
    o.*field = value;
    return refusal(o);
  };
  EXPECT_NE(refused(&ExistenceOptions::detection, 1).find("detection"), std::string::npos);
  EXPECT_NE(refused(&ExistenceOptions::falseDetection, 0.5).find("false_detection"),
            std::string::npos);
  EXPECT_NE(refused(&ExistenceOptions::decorrelation, 0).find("decorrelation_m"),
            std::string::npos);
  EXPECT_NE(refused(&ExistenceOptions::prior, 0).find("prior"), std::string::npos);
  EXPECT_NE(refused(&ExistenceOptions::certain, 0.4).find("certain"), std::string::npos);
  EXPECT_NE(refused(&ExistenceOptions::lifetimeDays, NAN).find("lifetime_days"), std::string::npos);
}

}  // namespace polemcl::test_pole_existence
