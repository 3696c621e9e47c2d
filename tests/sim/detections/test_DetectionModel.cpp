#include <gtest/gtest.h>

#include <functional>

#include <polemcl/core/common/Types.h>
#include "core/common/Statistics.h"
#include "support/DetectionModels.h"
#include "support/Refusal.h"

namespace polemcl::test_detection_model {

using namespace polemcl::sim;
using testing_sim::plainModel;

TEST(DetectionModel, QuantilesAreReadAtTheirLevelsAndLinearBetween) {
  Quantiles quantiles;
  for (std::size_t i = 0; i < quantiles.size(); ++i) quantiles[i] = static_cast<double>(i * i);
  for (std::size_t i = 0; i < quantiles.size(); ++i)
    EXPECT_NEAR(valueAt(quantiles, normalQuantile(kQuantileLevels[i])), static_cast<double>(i * i),
                1e-9);
  EXPECT_NEAR(valueAt(quantiles, 0.5 * normalQuantile(0.7)), 0.5 * (25 + 36), 1e-9);
  EXPECT_EQ(valueAt(quantiles, -9), 0);
  EXPECT_EQ(valueAt(quantiles, 9), 100);
}

TEST(DetectionModel, IsLinearBetweenRangesAndEndsAtTheLastOne) {
  DetectionModel model = plainModel();
  model.classes[0].detected = {0.84134475, 0.15865525};  // one sigma; at 5 and 35 m
  const auto score = [&](double range) {
    return model.detectionScore(DetectionClass::lampPost, range);
  };
  EXPECT_NEAR(score(2), 1, 1e-6);
  EXPECT_NEAR(score(20), 0, 1e-6);
  EXPECT_NEAR(score(39), -1, 1e-6);
  EXPECT_LT(score(40.1), -5);
}

TEST(DetectionModel, ErrorsGrowWithSigmaAsTheExponentSays) {
  DetectionModel model = plainModel();  // the usual sigma is 0.05
  const auto scale = [&](double exponent) {
    model.errorExponent = exponent;
    return model.errorScale(DetectionClass::tree, Reported::sigmaAcross, 10, 0.2);
  };
  EXPECT_NEAR(scale(1), 0.2, 1e-12);
  EXPECT_NEAR(scale(0.5), 0.1, 1e-12);
  EXPECT_NEAR(scale(0), 0.05, 1e-12);
}

TEST(DetectionModel, PolesAreOfTheirKind) {
  EXPECT_EQ(classOf(Kind::lampPost), DetectionClass::lampPost);
  EXPECT_EQ(classOf(Kind::sign), DetectionClass::sign);
  EXPECT_EQ(classOf(Kind::trafficLight), DetectionClass::trafficLight);
  EXPECT_EQ(classOf(Kind::tree), DetectionClass::tree);
}

TEST(DetectionModel, RefusesWhatMakesNoSense) {
  EXPECT_NO_THROW(plainModel().validate());
  const std::pair<const char*, std::function<void(DetectionModel&)>> spoilt[] = {
      {"sensor", [](auto& m) { m.sensor = ""; }},
      {"max_range_m", [](auto& m) { m.maxRange = 0; }},
      {"behind_houses", [](auto& m) { m.behindHouses = 2; }},
      {"error_exponent", [](auto& m) { m.errorExponent = -1; }},
      {"clutter_per_m.today", [](auto& m) { m.clutterToday = -1; }},
      {"passing_per_scan", [](auto& m) { m.passing = -1; }},
      {"reported_range_m", [](auto& m) { m.reportedRange = {}; }},
      {"clutter_lateral_m", [](auto& m) { m.clutterLateral.fill(-1); }},
      {"passing_range_m", [](auto& m) { m.passingRange.fill(50); }},
      {"persistence.clutter", [](auto& m) { m.clutterVisibility.today[1] = 1.5; }},
      {"persistence.top_m",
       [](auto& m) {
         m.noise[7].always = {0.3, 0.3, 0.3, 0.3, 0.3};
       }},
      {"classes.tree.detected", [](auto& m) { m.classes[3].detected.pop_back(); }},
      {"classes.passing.detected",
       [](auto& m) {
         m.classes[5].detected = {1, 1};
       }},
      {"classes.sign.sigma_across_m", [](auto& m) { m.classes[1].reported[1][0].fill(0); }},
      {"classes.sign.confidence", [](auto& m) { m.classes[1].reported[4][0].fill(2); }},
      {"classes.clutter.points", [](auto& m) { m.classes[4].reported[8].clear(); }}};
  for (const auto& [key, spoil] : spoilt) {
    DetectionModel model = plainModel();
    spoil(model);
    EXPECT_REFUSED(model.validate(), std::string(key) + ":");
  }
}

}  // namespace polemcl::test_detection_model
