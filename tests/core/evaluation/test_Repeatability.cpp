#include <gtest/gtest.h>

#include "core/evaluation/Repeatability.h"
#include "support/Clouds.h"
#include "support/KnownScene.h"

namespace polemcl::test_repeatability {

using namespace polemcl::clouds;
using Scans = std::vector<std::vector<Eigen::Vector2d>>;

TEST(Repeatability, CountsDetectionsFoundAgainInEnoughOfTheNextScans) {
  // The first scan's poles: seen in all, in scans 1, 3 and 5, in scans 1 and 2, never.
  Scans scans(7);
  for (auto& scan : scans) scan.emplace_back(0, 0);
  scans[0].insert(scans[0].end(), {{10, 0}, {20, 0}, {30, 0}});
  for (const std::size_t i : {1, 3, 5}) scans[i].emplace_back(10.2, 0);
  for (const std::size_t i : {1, 2}) scans[i].emplace_back(20, 0.1);
  const auto score = evaluateRepeatability(scans);
  // Judged: scan 0 (4 poles, 2 found again) and scan 1 (3 poles: of these only (0, 0) has three).
  EXPECT_EQ(score.scans, 7u);
  EXPECT_EQ(score.detections, 7u + 3 + 3 + 2);
  EXPECT_EQ(score.judged, 7u);
  EXPECT_EQ(score.repeated, 3u);
  EXPECT_DOUBLE_EQ(score.share, 3.0 / 7);
  EXPECT_DOUBLE_EQ(score.perScan, 15.0 / 7);
}

TEST(Repeatability, TheRadiusIsALimit) {
  Scans scans(6, {{0.26, 0}});
  scans[0] = {{0, 0}};
  EXPECT_EQ(evaluateRepeatability(scans).repeated, 0u);
  RepeatabilityOptions wider;
  wider.radius = 0.27;
  EXPECT_EQ(evaluateRepeatability(scans, wider).repeated, 1u);
}

TEST(Repeatability, ScansWithoutPolesAreScans) {
  Scans scans(8);
  const auto score = evaluateRepeatability(scans);
  EXPECT_EQ(score.judged, 0u);
  EXPECT_EQ(score.share, 0);
  EXPECT_EQ(score.perScan, 0);
}

TEST(Repeatability, RefusesWhatMakesNoSense) {
  EXPECT_THROW(evaluateRepeatability(Scans(5)), Error);
  RepeatabilityOptions options;
  options.radius = 0;
  EXPECT_THROW(evaluateRepeatability(Scans(9), options), Error);
  options = {};
  options.atLeast = 6;
  EXPECT_THROW(evaluateRepeatability(Scans(9), options), Error);
  options.atLeast = 0;
  EXPECT_THROW(evaluateRepeatability(Scans(9), options), Error);
}

TEST(Repeatability, ATurnedYardHasTheSamePoles) {
  const SensorOptions sensor = sensorOptions("hdl32e");
  PoleExtractor extractor(sensor, {});
  RotationScore score;
  addRotations(extractor, castYard(sensor).view(), 0.01, score);
  EXPECT_EQ(score.scans, 1u);
  EXPECT_EQ(score.turns, 11u);
  EXPECT_EQ(score.poles, 44u);
  EXPECT_EQ(score.turnedPoles, 44u);
  EXPECT_EQ(score.matched, 44u);
  EXPECT_EQ(score.share, 1);
  EXPECT_EQ(score.backShare, 1);
}

TEST(Repeatability, ARangeImageThatDoesNotTurnWithTheScanIsFoundOut) {
  const SensorOptions sensor = sensorOptions("hdl32e");
  ExtractionOptions options;
  options.method = ExtractionMethod::rangeImage;
  options.rangeImage.rows = 32;
  options.rangeImage.columns = 250;
  options.rangeImage.fovUp = 10.67 * kDegree;
  options.rangeImage.fovDown = -30.67 * kDegree;
  options.rangeImage.minZ = -1.3;
  options.rangeImage.minTop = 0.3;
  PoleExtractor extractor(sensor, options);
  const PointList yardScan = castYard(sensor);
  const std::size_t poles = extractor.extract(yardScan.view()).size();
  ASSERT_GT(poles, 0u);
  RotationScore score;
  addRotations(extractor, yardScan.view(), 1e-5, score);
  EXPECT_EQ(score.poles, 11 * poles);
  EXPECT_LT(score.share, 0.9);
  // A second scan adds up.
  addRotations(extractor, yardScan.view(), 1e-5, score);
  EXPECT_EQ(score.poles, 22 * poles);
  EXPECT_EQ(score.scans, 2u);
}

}  // namespace polemcl::test_repeatability
