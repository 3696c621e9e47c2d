#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <thread>

#include <polemcl/core/extraction/PoleExtractor.h>
#include "support/KnownScene.h"

namespace polemcl::test_pole_extractor {
namespace {

using namespace polemcl::clouds;

std::vector<PoleDetection> extract(const PointList& points, const SensorOptions& sensor,
                                   const ExtractionOptions& options = {},
                                   ExtractionReport* report = nullptr) {
  PoleExtractor extractor(sensor, options);
  const auto poles = extractor.extract(points.view());
  if (report) *report = extractor.report();
  return poles;
}

void expectYard(const std::vector<PoleDetection>& poles, const Scene& scene = yard()) {
  EXPECT_EQ(poles.size(), scene.cylinders.size());
  for (const Cylinder& c : scene.cylinders) {
    SCOPED_TRACE(std::to_string(c.x) + ", " + std::to_string(c.y));
    const PoleDetection* pole = nearest(poles, c.x, c.y, 0.04);
    ASSERT_TRUE(pole);
    EXPECT_NEAR(pole->radius, c.radius, 0.03);
    EXPECT_GE(pole->points, 5u);
    EXPECT_GT(pole->confidence, 0.5);
    EXPECT_LE(pole->confidence, 1);
    const Eigen::Vector2d variances =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(pole->covariance).eigenvalues();
    EXPECT_GT(variances[0], 0);
    EXPECT_LT(variances[1], 0.1);
  }
}

TEST(PoleExtractor, FindsThePolesOfAKnownScene) {
  for (const auto& sensor :
       {sensorOptions("hdl64e"), sensorOptions("hdl32e"), sensorOptions("hdl32e", true),
        sensorOptions("os1_64"), sensorOptions("os1_128"), sensorOptions("vlp16")}) {
    SCOPED_TRACE(sensor.model);
    ExtractionReport report;
    const PointList points = castYard(sensor);
    const auto poles = extract(points, sensor, {}, &report);
    expectYard(poles);
    EXPECT_EQ(report.points, points.size());
    EXPECT_EQ(report.invalid, 0u);
    EXPECT_EQ(report.outOfView, 0u);
    EXPECT_EQ(report.candidates, poles.size() + refused(report));
    EXPECT_NEAR(report.ground, -kSensorHeight, 0.1);
  }
}

TEST(PoleExtractor, HeightsAreAboveGround) {
  const SensorOptions sensor = sensorOptions("os1_64");
  for (const PoleDetection& pole : extract(castYard(sensor), sensor)) {
    EXPECT_NEAR(pole.top, 3.2, 0.15);
    EXPECT_NEAR(pole.bottom, 0.15, 0.15);  // the lowest beam that is not taken for the ground
  }
}

TEST(PoleExtractor, OnASlopeHeightsAreAboveTheLocalGround) {
  const SensorOptions sensor = sensorOptions("os1_64");
  Scene scene = yard();
  scene.ground->slopeX = 0.08;
  for (Cylinder& c : scene.cylinders) {
    c.bottom = scene.ground->at(c.x, c.y);
    c.top = c.bottom + 3;
  }
  const auto poles = extract(castYard(sensor, scene), sensor);
  expectYard(poles, scene);
  for (const PoleDetection& pole : poles) {
    EXPECT_NEAR(pole.top, 3, 0.35);
    EXPECT_NEAR(pole.bottom, 0, 0.35);
  }
}

TEST(PoleExtractor, BollardsAreNoPoles) {
  const SensorOptions sensor = sensorOptions("os1_64");
  Scene scene = yard();
  for (Cylinder& c : scene.cylinders) c.top = 1.2 - kSensorHeight;
  ExtractionReport report;
  EXPECT_TRUE(extract(castYard(sensor, scene), sensor, {}, &report).empty());
  EXPECT_EQ(report.refused[static_cast<int>(RejectionReason::tooLow)], 4u);
}

TEST(PoleExtractor, WallsAndPilastersAreNoPoles) {
  const SensorOptions sensor = sensorOptions("os1_64");
  Scene scene = yard();
  scene.cylinders.clear();
  scene.walls.push_back({10, -5, 10, 5, -3, 3});
  for (double y = -4; y < 5; y += 2) scene.cylinders.push_back({10, y, 0.25, -3, 3});
  EXPECT_TRUE(extract(castYard(sensor, scene), sensor).empty());
}

TEST(PoleExtractor, PolesAreSortedByAzimuth) {
  const SensorOptions sensor = sensorOptions("hdl64e");
  const auto poles = extract(castYard(sensor), sensor);
  for (std::size_t i = 1; i < poles.size(); ++i)
    EXPECT_LT(std::atan2(poles[i - 1].y, poles[i - 1].x), std::atan2(poles[i].y, poles[i].x));
}

TEST(PoleExtractor, PolesBeyondTheRangeAreNotLookedFor) {
  const SensorOptions sensor = sensorOptions("os1_64");
  ExtractionOptions options;
  options.scanLine.maxRange = 9.3;  // two of four stand nearer: 8.5 and 9.0 m; the others 9.2, 11.4
  EXPECT_EQ(extract(castYard(sensor), sensor, options).size(), 3u);
}

// Nothing is known beyond the LiDAR's own greatest range.
TEST(PoleExtractor, TheSensorsGreatestRangeEndsWhatIsVisible) {
  SensorOptions sensor = sensorOptions("hdl32e");
  sensor.maxRange = 12;
  for (const auto method : {ExtractionMethod::scanLine, ExtractionMethod::rangeImage}) {
    ExtractionOptions options;
    options.method = method;
    PoleExtractor extractor(sensor, options);
    const PointList points = castYard(sensor);
    for (const PoleDetection& pole : extractor.extract(points.view()))
      EXPECT_LE(std::hypot(pole.x, pole.y), 12.5);
    for (const float range : extractor.visibilityRange()) EXPECT_LE(range, 12);
  }
}

TEST(PoleExtractor, DistancesAreCorrectedAsTheSettingsSay) {
  SensorOptions sensor = sensorOptions("os1_64");
  const PointList points = castYard(sensor);
  const auto before = extract(points, sensor);
  sensor.rangeOffset = 0.07;
  sensor.rangeScale = 0.99;
  const auto after = extract(points, sensor);
  ASSERT_EQ(after.size(), before.size());
  ASSERT_FALSE(before.empty());
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double distance = std::hypot(before[i].x, before[i].y);
    EXPECT_NEAR(std::hypot(after[i].x, after[i].y), 0.99 * distance + 0.07, 1e-9);
    EXPECT_NEAR(std::atan2(after[i].y, after[i].x), std::atan2(before[i].y, before[i].x), 1e-12);
    EXPECT_EQ(after[i].radius, before[i].radius);
  }
}

TEST(PoleExtractor, OrderOfPointsIsOfNoConsequence) {
  const SensorOptions sensor = sensorOptions("hdl64e");
  const PointList points = castYard(sensor);
  const auto poles = extract(points, sensor);
  for (const std::uint64_t seed : {1, 2, 3})
    EXPECT_TRUE(same(poles, extract(shuffled(points.view(), seed), sensor)));
}

TEST(PoleExtractor, OneObjectServesManyScans) {
  const SensorOptions sensor = sensorOptions("hdl32e");
  const PointList points = castYard(sensor), others = turned(points.view(), 1);
  PoleExtractor extractor(sensor, {});
  const auto first = extractor.extract(points.view());
  EXPECT_FALSE(same(first, extractor.extract(others.view())));
  EXPECT_TRUE(extractor.extract(PointsView()).empty());
  EXPECT_EQ(extractor.report().candidates, 0u);
  EXPECT_TRUE(same(first, extractor.extract(points.view())));
  PoleExtractor moved = std::move(extractor);
  EXPECT_TRUE(same(first, moved.extract(points.view())));
}

TEST(PoleExtractor, ObjectsInSeveralThreadsGiveTheSameBytes) {
  const SensorOptions sensor = sensorOptions("hdl64e");
  const PointList points = castYard(sensor);
  std::vector<std::vector<PoleDetection>> results(4);
  std::vector<std::thread> threads;
  for (auto& result : results) threads.emplace_back([&] { result = extract(points, sensor); });
  for (auto& thread : threads) thread.join();
  EXPECT_FALSE(results[0].empty());
  for (const auto& result : results) EXPECT_TRUE(same(result, results[0]));
}

TEST(PoleExtractor, PointsThatAreNoPointsAreDroppedAndCounted) {
  const SensorOptions sensor = sensorOptions("hdl64e");
  const PointList clean = castYard(sensor);
  const auto poles = extract(clean, sensor);
  PointList points;
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 100; ++i) {
    points.add(nan, 1, 1);
    points.add(8, nan, 0);
    points.add(8, 3, nan);
    points.add(inf, -inf, 0);
    points.add(8, 3, inf);
    points.add(0, 0, 0);
    points.add(8, 3, 50);   // out of view
    points.add(0.5, 0, 0);  // out of range
    points.add(900, 0, 0);
  }
  points.append(clean.view());
  ExtractionReport report;
  EXPECT_TRUE(same(poles, extract(shuffled(points.view(), 4), sensor, {}, &report)));
  EXPECT_EQ(report.points, points.size());
  EXPECT_EQ(report.invalid, 600u);
  EXPECT_EQ(report.outOfView, 100u);
  std::size_t far = 0;  // what stands well behind the farthest pole is not looked at
  for (std::size_t i = 0; i < clean.size(); ++i)
    far += std::hypot(clean.x[i], clean.y[i]) > ScanLineOptions().maxRange + 1;
  EXPECT_EQ(report.outOfRange, 200u + far);
}

TEST(PoleExtractor, PointsThatComeTwiceAddNoPoles) {
  const SensorOptions sensor = sensorOptions("hdl64e");
  PointList points = castYard(sensor);
  points.append(castYard(sensor).view());
  expectYard(extract(points, sensor));
}

// A LiDAR that sends two returns a firing: those behind neither cut nor double a pole.
TEST(PoleExtractor, OfTwoReturnsOfAFiringTheNearerCounts) {
  for (const auto& sensor : {sensorOptions("hdl32e"), sensorOptions("vlp16")}) {
    const PointList once = castYard(sensor);
    const auto expected = extract(once, sensor);
    expectYard(expected);
    PointList twice = once;
    for (std::size_t i = 0; i < once.size(); ++i) {
      const double range = std::hypot(std::hypot(once.x[i], once.y[i]), once.z[i]);
      const double farther = i % 4 == 0 && once.z[i] > 0 ? 1 + 3 / range : 1;
      twice.add(farther * once.x[i], farther * once.y[i], farther * once.z[i]);
    }
    const auto poles = extract(twice, sensor);
    ASSERT_EQ(poles.size(), expected.size()) << sensor.model;
    for (std::size_t i = 0; i < poles.size(); ++i) {
      EXPECT_NEAR(poles[i].x, expected[i].x, 1e-6) << sensor.model;
      EXPECT_NEAR(poles[i].y, expected[i].y, 1e-6) << sensor.model;
      EXPECT_EQ(poles[i].points, expected[i].points) << sensor.model;
    }
  }
}

TEST(PoleExtractor, FromNothingComesNothing) {
  const SensorOptions sensor = sensorOptions("hdl32e");
  EXPECT_TRUE(extract(PointList(), sensor).empty());
  PointList points;
  points.add(8, 3, 0);
  EXPECT_TRUE(extract(points, sensor).empty());
  for (int i = 0; i < 5000; ++i) points.add(8, 3, 0);
  EXPECT_TRUE(extract(points, sensor).empty());
  PointList onOneRay;
  for (int i = 1; i < 5000; ++i) onOneRay.add(0.01 * i, 0.003 * i, -0.001 * i);
  EXPECT_TRUE(extract(onOneRay, sensor).empty());
}

TEST(PoleExtractor, HugeAndTinyCoordinatesAreNoPoles) {
  const SensorOptions sensor = sensorOptions("hdl32e");
  PointList points;
  for (const double size : {3.4e38, 1e30, 1e19, 1e10, 1e-10, 1e-30, 1e-44})
    for (int i = 0; i < 64; ++i) {
      const double angle = 0.1 * i;
      points.add(size * std::cos(angle), size * std::sin(angle), 0.1 * size * std::cos(7 * angle));
    }
  ExtractionReport report;
  EXPECT_TRUE(extract(points, sensor, {}, &report).empty());
  EXPECT_EQ(report.invalid + report.outOfRange + report.outOfView, points.size());
}

// Where no range is too near: they have no direction, and the cube of their range is 0.
TEST(PoleExtractor, PointsAtTheSensorAreNoPoles) {
  SensorOptions sensor = sensorOptions("hdl32e");
  sensor.minRange = 0;
  const PointList yard = castYard(sensor);
  PointList points;
  for (const double range : {1e-12, 1e-15, 1e-25, 1e-40, 9e-4}) points.addPolar(1, 0, range);
  points.add(0, 0, 0.5);
  ExtractionReport before, report;
  const auto expected = extract(yard, sensor, {}, &before);
  const std::size_t near = points.size();
  points.append(yard.view());
  EXPECT_TRUE(same(expected, extract(points, sensor, {}, &report)));
  EXPECT_EQ(report.outOfRange + report.invalid, before.outOfRange + before.invalid + near);
}

TEST(PoleExtractor, ScatteredPointsMakeAPoleInAThousandAtMost) {
  const SensorOptions sensor = sensorOptions("hdl64e");
  sim::Random random(6);
  PointList points;
  for (int i = 0; i < 100000; ++i)
    points.add(random.uniform(-40, 40), random.uniform(-40, 40), random.uniform(-2, 2));
  ExtractionReport report;
  const auto poles = extract(points, sensor, {}, &report);
  EXPECT_GT(report.candidates, 10000u);
  EXPECT_LT(poles.size(), report.candidates / 1000);
}

TEST(PoleExtractor, EveryReasonHasItsName) {
  std::set<std::string> names;
  for (int i = 0; i < static_cast<int>(RejectionReason::count_); ++i)
    names.insert(name(static_cast<RejectionReason>(i)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(RejectionReason::count_));
  EXPECT_EQ(names.count(name(RejectionReason::count_)), 0u);
}

TEST(PoleExtractor, RefusesBadOptions) {
  ExtractionOptions options;
  options.scanLine.maxRange = 0;
  EXPECT_THROW(PoleExtractor(SensorOptions(), options), Error);
  EXPECT_THROW(PoleExtractor(sensorOptions("no such sensor"), {}), Error);
}

/// What makes the yard's poles be refused, and with which reason.
struct Spoiled {
  RejectionReason reason;
  std::function<void(ScanLineOptions&)> spoil;
};
class PoleExtractorRefusal : public ::testing::TestWithParam<Spoiled> {};
const std::vector<Spoiled> kSpoiled = {
    {RejectionReason::tooFewPoints, [](ScanLineOptions& o) { o.minPoints = 10000; }},
    {RejectionReason::tooShort, [](ScanLineOptions& o) { o.minHeight = 10; }},
    {RejectionReason::startsTooHigh, [](ScanLineOptions& o) { o.maxBottom = 1e-6; }},
    {RejectionReason::tilted, [](ScanLineOptions& o) { o.maxTilt = 1e-7; }},
    {RejectionReason::notStraight, [](ScanLineOptions& o) { o.maxScatter = 1e-7; }},
    {RejectionReason::tooLow, [](ScanLineOptions& o) { o.minTop = 4; }},
    {RejectionReason::lowConfidence, [](ScanLineOptions& o) { o.minConfidence = 1; }},
    {RejectionReason::badFit, [](ScanLineOptions& o) { o.maxRadius = 0.03; }}};

TEST_P(PoleExtractorRefusal, IsCounted) {
  const SensorOptions sensor = sensorOptions("os1_64");
  ExtractionOptions options;
  GetParam().spoil(options.scanLine);
  ExtractionReport report;
  EXPECT_TRUE(extract(castYard(sensor), sensor, options, &report).empty());
  EXPECT_GE(report.refused[static_cast<int>(GetParam().reason)], 4u);
  EXPECT_EQ(report.candidates, refused(report));
}
INSTANTIATE_TEST_SUITE_P(Each, PoleExtractorRefusal, ::testing::ValuesIn(kSpoiled),
                         [](const auto& i) { return std::string(name(i.param.reason)); });

TEST(PoleExtractorRefusal, IsForThinPolesToo) {
  const SensorOptions sensor = sensorOptions("os1_64");
  ExtractionOptions options;
  options.scanLine.minRadius = 0.4;
  ExtractionReport report;
  EXPECT_TRUE(extract(castYard(sensor), sensor, options, &report).empty());
  EXPECT_GE(report.refused[static_cast<int>(RejectionReason::badFit)], 4u);
}

TEST(PoleExtractorRefusal, OfPolesTooNearToEachOtherTheMostConfidentStays) {
  const SensorOptions sensor = sensorOptions("os1_64");
  const PointList points = castYard(sensor);
  const auto all = extract(points, sensor);
  ExtractionOptions options;
  options.scanLine.minSpacing = 100;
  ExtractionReport report;
  const auto kept = extract(points, sensor, options, &report);
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(report.refused[static_cast<int>(RejectionReason::duplicate)], 3u);
  for (const PoleDetection& pole : all) EXPECT_LE(pole.confidence, kept[0].confidence);
}

}  // namespace
}  // namespace polemcl::test_pole_extractor
