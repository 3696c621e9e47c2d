#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include <polemcl/core/extraction/PoleExtractor.h>
#include "core/extraction/range_image/RangeImageExtractor.h"
#include "support/KnownScene.h"

namespace polemcl::test_range_image_extractor {
namespace {

using namespace polemcl::clouds;

/// Algorithm 1 with heights as the authors compare them. The view fits the OS1-64, the sensor of
/// these scans.
ExtractionOptions paperOptions(double fovUp = 17 * kDegree, double fovDown = -17 * kDegree) {
  ExtractionOptions options;
  options.method = ExtractionMethod::rangeImage;
  RangeImageOptions& o = options.rangeImage;
  o.rows = 64, o.columns = 500;
  o.fovUp = fovUp, o.fovDown = fovDown;
  o.heightsAboveGround = false;
  o.minZ = -1.3, o.maxZ = 6, o.minTop = 0.7, o.maxBottom = 1.5, o.fitMaxZ = 3;
  return options;
}

struct Result {
  std::vector<PoleDetection> poles;
  ExtractionReport report;
  std::size_t of(RejectionReason reason) const { return report.refused[static_cast<int>(reason)]; }
};

Result extract(const PointList& points, const ExtractionOptions& options,
               const std::string& model = "os1_64") {
  PoleExtractor extractor(sensorOptions(model), options);
  Result result;
  result.poles = extractor.extract(points.view());
  result.report = extractor.report();
  EXPECT_EQ(result.report.candidates, result.poles.size() + refused(result.report));
  EXPECT_EQ(result.report.points, points.size());
  return result;
}

const PointList& yardPoints() {
  static const PointList points = castYard(sensorOptions("os1_64"));
  return points;
}

void expectYard(const Result& result, double tolerance) {
  EXPECT_EQ(result.poles.size(), 4u);
  for (const Cylinder& c : yard().cylinders) {
    const PoleDetection* pole = nearest(result.poles, c.x, c.y, tolerance);
    ASSERT_TRUE(pole) << c.x << ' ' << c.y;
    EXPECT_NEAR(pole->radius, c.radius, tolerance);
    EXPECT_GE(pole->points, 6u);
  }
}

// Nothing is said but the method: size, field of view and heights are those of the sensor.
TEST(RangeImageExtractor, FitsEachSensorByItself) {
  ExtractionOptions options;
  options.method = ExtractionMethod::rangeImage;
  for (const std::string model : {"hdl64e", "hdl32e", "os1_64", "vlp16"}) {
    const auto result = extract(castYard(sensorOptions(model)), options, model);
    EXPECT_EQ(result.poles.size(), 4u) << model;
    // The blocks of an HDL-64E stand above its origin: near points lie higher than its rings.
    if (model != "hdl64e") {
      EXPECT_EQ(result.report.outOfView, 0u) << model;
    }
  }
}

TEST(RangeImageExtractor, TakesSizeAndViewFromTheBeams) {
  const SensorModel vlp16(sensorOptions("vlp16"));
  RangeImageOptions stated;
  const auto all = adaptedTo(vlp16, stated);
  EXPECT_EQ(all.rows, 16);
  EXPECT_EQ(all.columns, 500);
  EXPECT_NEAR(all.fovUp, 16 * kDegree, 1e-6);
  EXPECT_NEAR(all.fovDown, -16 * kDegree, 1e-6);
  stated.rows = 8, stated.columns = 100, stated.fovUp = 0.1, stated.fovDown = -0.2;
  const auto none = adaptedTo(vlp16, stated);
  EXPECT_EQ(none.rows, 8);
  EXPECT_EQ(none.columns, 100);
  EXPECT_EQ(none.fovUp, 0.1);
  EXPECT_EQ(none.fovDown, -0.2);
}

TEST(RangeImageExtractor, FindsThePolesOfAKnownScene) {
  expectYard(extract(yardPoints(), paperOptions()), 0.06);
}

TEST(RangeImageExtractor, HeightsInResultsAreAboveGround) {
  for (const PoleDetection& pole : extract(yardPoints(), paperOptions()).poles) {
    EXPECT_NEAR(pole.top, 3.2, 0.2);
    EXPECT_GT(pole.bottom, 0.1);  // ground is cut off at -1.3 m
    EXPECT_LT(pole.bottom, 0.5);
  }
}

// `top > 0.7` is meant above ground but compared in the sensor frame: beams of an HDL-64E, that
// rise by 2°, are not so high before 20 m.
TEST(RangeImageExtractor, HeightsAboveGroundBringsBackTheNearPoles) {
  const PointList points = castYard(sensorOptions("hdl64e"));
  ExtractionOptions options = paperOptions(3 * kDegree, -25 * kDegree);
  const Result asStated = extract(points, options, "hdl64e");
  EXPECT_TRUE(asStated.poles.empty());
  EXPECT_GE(asStated.of(RejectionReason::tooLow), 4u);
  options.rangeImage.heightsAboveGround = true;
  options.rangeImage.minZ = 0.3;
  expectYard(extract(points, options, "hdl64e"), 0.08);
}

TEST(RangeImageExtractor, WithoutWrapThePoleOnTheSeamIsLost) {
  ExtractionOptions options = paperOptions();
  options.rangeImage.details = ExtractionDetails::authors;
  const Result result = extract(yardPoints(), options);
  EXPECT_FALSE(nearest(result.poles, -9, 0, 0.06));
  EXPECT_TRUE(nearest(result.poles, 8, 3, 0.06));
}

TEST(RangeImageExtractor, WhatCrowdsThePoleRefusesIt) {
  Scene scene = yard();
  for (int i = 0; i < 8; ++i) {  // slim sticks in a ring of 0.45 m around the first pole
    const double angle = (i + 0.5) * M_PI / 4;
    scene.cylinders.push_back(
        {8 + 0.45 * std::cos(angle), 3 + 0.45 * std::sin(angle), 0.03, -3, 1.7});
  }
  const PointList points = castYard(sensorOptions("os1_64"), scene);
  ExtractionOptions options = paperOptions();
  options.rangeImage.details = ExtractionDetails::paper;
  const Result crowded = extract(points, options);
  EXPECT_GE(crowded.of(RejectionReason::notFree), 1u);
  EXPECT_FALSE(nearest(crowded.poles, 8, 3, 0.1));
  options.rangeImage.freeRing = 0;
  EXPECT_EQ(extract(points, options).of(RejectionReason::notFree), 0u);
}

TEST(RangeImageExtractor, CornersLookBesideTheBoxOnly) {
  Scene scene = yard();
  scene.cylinders.push_back(
      {8, 3.6, 0.06, -3, 1.7});  // 0.6 m to the left: in the ring, in no corner
  const PointList points = castYard(sensorOptions("os1_64"), scene);
  ExtractionOptions options = paperOptions();
  EXPECT_TRUE(nearest(extract(points, options).poles, 8, 3, 0.1));
  options.rangeImage.details = ExtractionDetails::paper;
  EXPECT_FALSE(nearest(extract(points, options).poles, 8, 3, 0.1));
}

// Sticks 0.45 m farther and 0.5 m aside: in a corner, but at lower y beyond the cut one, which is
// 0.1 m high for this pole.
TEST(RangeImageExtractor, CutCornersMissHalfOfWhatStandsInCorners) {
  const auto finds = [](double aside, ExtractionDetails details, bool mirrored) {
    Scene scene = yard();
    scene.cylinders.push_back({8 + (aside < 0 ? 0.45 : -0.45), 3 + aside, 0.06, -3, 1.7});
    ExtractionOptions options = paperOptions();
    options.rangeImage.details = details;
    options.rangeImage.mirrored = mirrored;
    const Result result = extract(castYard(sensorOptions("os1_64"), scene), options);
    return nearest(result.poles, 8, 3, 0.1) != nullptr;
  };
  for (const double aside : {-0.5, 0.5})
    for (const bool mirrored : {false, true}) {
      SCOPED_TRACE(aside);
      EXPECT_FALSE(finds(aside, ExtractionDetails::mended, mirrored));
      EXPECT_EQ(finds(aside, ExtractionDetails::authors, mirrored), mirrored == (aside > 0));
    }
}

TEST(RangeImageExtractor, AMirroredImageFindsTheSamePoles) {
  ExtractionOptions options = paperOptions();
  options.rangeImage.mirrored = true;
  expectYard(extract(yardPoints(), options), 0.06);
}

constexpr int kRingRows = 21, kRingPoints = 18;

/// A pole of 0.05 m at 10 m in one column of the image: 21 rows from -0.6 to 1.2 m, in each 17
/// points of its near half. The foremost of a row lie on a circle of 3 m instead, and those are the
/// points of the image.
PointList flatFront() {
  PointList points;
  const double y0 = -10 * M_PI / 500;  // middle of the column
  for (int row = 0; row < kRingRows; ++row) {
    const double z = -0.6 + 0.09 * row;
    for (int i = -8; i <= 8; ++i)
      points.add(10 - 0.05 * std::cos(0.18 * i), y0 + 0.05 * std::sin(0.18 * i), z);
    const double across = 0.002 * (row - 10);
    points.add(9.94 + across * across / 6, y0 + across, z);
  }
  return points;
}

TEST(RangeImageExtractor, TheFirstCircleMayBeOfAnySize) {
  ExtractionOptions options = paperOptions();
  options.rangeImage.details = ExtractionDetails::authors;
  const Result result = extract(flatFront(), options);
  ASSERT_EQ(result.poles.size(), 1u);
  EXPECT_NEAR(result.poles[0].radius, 0.05, 0.01);
  EXPECT_EQ(result.poles[0].points, (kRingRows - 2u) * kRingPoints);  // strictly between z's
  options.rangeImage.fitMargin = 0;  // the coarse circle's box holds them without a margin, too
  EXPECT_EQ(extract(flatFront(), options).poles.size(), 1u);
}

TEST(RangeImageExtractor, TheFitTakesPointsBeyondTheRange) {
  PointList points = flatFront();
  ExtractionOptions options = paperOptions();
  options.rangeImage.details = ExtractionDetails::authors;
  options.rangeImage.maxRange = 10.2;
  for (int i = 0; i < 2000; ++i) points.add(12.6, 0.1 * (i % 20) - 1, 0.3);  // a wall behind
  const Result result = extract(points, options);
  EXPECT_TRUE(result.poles.empty());
  EXPECT_EQ(result.of(RejectionReason::badFit), 1u);
}

// Floats of -0.6 and 1.2 lie beyond these: as exact multiples of the step they are between.
TEST(RangeImageExtractor, ExactCoordinatesPutTheOutermostRowsIntoTheFit) {
  ExtractionOptions options = paperOptions();
  options.rangeImage.details = ExtractionDetails::authors;
  options.rangeImage.coordinateStep = 0.0001;
  const Result result = extract(flatFront(), options);
  ASSERT_EQ(result.poles.size(), 1u);
  EXPECT_EQ(result.poles[0].points, kRingRows * kRingPoints);
}

TEST(RangeImageExtractor, HeightsCountFromTheOriginOfTheProjection) {
  SensorOptions sensor = sensorOptions("os1_64");
  sensor.originZ = 0.4;  // above the origin of the clouds
  for (const bool fromCloud : {false, true}) {
    ExtractionOptions options = paperOptions();
    options.rangeImage.projectFrom = fromCloud ? "cloud" : "sensor";
    PoleExtractor extractor(sensor, options);
    for (const PoleDetection& pole : extractor.extract(yardPoints().view()))
      EXPECT_NEAR(pole.top, fromCloud ? 2.8 : 3.2, 0.2);
    EXPECT_NEAR(extractor.report().ground, fromCloud ? -1.1 : -1.5, 1e-12);
  }
}

TEST(RangeImageExtractor, PointsAreCounted) {
  PointList points = yardPoints();
  points.add(std::nan(""), 0, 0);
  points.add(0, 0, 0);
  points.add(3, 0, 5);    // above the view
  points.add(200, 0, 0);  // beyond the range
  const ExtractionReport clean = extract(yardPoints(), paperOptions()).report;
  const ExtractionReport report = extract(points, paperOptions()).report;
  EXPECT_EQ(report.invalid, clean.invalid + 2);
  EXPECT_EQ(report.outOfView, clean.outOfView + 1);
  EXPECT_EQ(report.outOfRange, clean.outOfRange + 1);
}

TEST(RangeImageExtractor, FromNothingComesNothing) {
  EXPECT_TRUE(extract(PointList(), paperOptions()).poles.empty());
  PointList points;
  for (int i = 0; i < 1000; ++i) points.add(8, 3, 0);
  points.add(1e30, 1e30, 1e29);
  EXPECT_TRUE(extract(points, paperOptions()).poles.empty());
}

struct Spoiled {
  RejectionReason reason;
  std::function<void(RangeImageOptions&)> spoil;
};
class PaperExtractorRefusal : public ::testing::TestWithParam<Spoiled> {};
const std::vector<Spoiled> kSpoiled = {
    {RejectionReason::tooFewPoints, [](RangeImageOptions& o) { o.minPixels = 100000; }},
    {RejectionReason::tooWide, [](RangeImageOptions& o) { o.minAspect = 1000; }},
    {RejectionReason::tooLow, [](RangeImageOptions& o) { o.minTop = 5; }},
    {RejectionReason::startsTooHigh, [](RangeImageOptions& o) { o.maxBottom = -1.3; }},
    {RejectionReason::tooShort, [](RangeImageOptions& o) { o.minHeight = 6; }},
    {RejectionReason::badFit, [](RangeImageOptions& o) { o.maxRadius = 0.03; }},
    {RejectionReason::notFree, [](RangeImageOptions& o) { o.freeShare = 0; }}};

TEST_P(PaperExtractorRefusal, IsCounted) {
  ExtractionOptions options = paperOptions();
  GetParam().spoil(options.rangeImage);
  const Result result = extract(yardPoints(), options);
  EXPECT_TRUE(result.poles.empty());
  EXPECT_GE(result.of(GetParam().reason), 4u);
}
INSTANTIATE_TEST_SUITE_P(Each, PaperExtractorRefusal, ::testing::ValuesIn(kSpoiled),
                         [](const auto& i) { return std::string(name(i.param.reason)); });

TEST(PaperExtractorRefusal, WhatStandsBehindOthersIsNotInTheForeground) {
  Scene scene = yard();
  for (const double side : {-1.0, 1.0})  // seen through the gap between two boards
    scene.walls.push_back({4 + 0.06 * 3 * side, 1.5 - 0.06 * 8 * side, 4 + 0.6 * 3 * side,
                           1.5 - 0.6 * 8 * side, -3, 4});
  const Result result = extract(castYard(sensorOptions("os1_64"), scene), paperOptions());
  EXPECT_GE(result.of(RejectionReason::notForeground), 1u);
}

}  // namespace
}  // namespace polemcl::test_range_image_extractor
