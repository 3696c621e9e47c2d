#include <gtest/gtest.h>
#include <polemcl/core/PoleExtractor.h>

#include <cmath>
#include <functional>

#include "core/KnownScene.h"

using namespace polemcl;
using namespace polemcl::clouds;

namespace {

/// Algorithm 1 with an image that fits the OS1-64, the sensor of these scans.
ExtractionOptions paperOptions() {
  ExtractionOptions options;
  options.method = ExtractionMethod::paper;
  options.paper.fovUp = 17 * kDegree;
  options.paper.fovDown = -17 * kDegree;
  return options;
}

struct Result {
  std::vector<PoleDetection> poles;
  ExtractionReport report;
  std::size_t of(Refusal reason) const { return report.refused[static_cast<int>(reason)]; }
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

}  // namespace

TEST(PaperExtractor, findsThePolesOfAKnownScene) {
  expectYard(extract(yardPoints(), paperOptions()), 0.06);
}

TEST(PaperExtractor, everyCircleFitFindsThem) {
  for (const std::string fit : {"kasa", "taubin", "silhouette"}) {
    SCOPED_TRACE(fit);
    ExtractionOptions options = paperOptions();
    options.paper.circleFit = fit;
    expectYard(extract(yardPoints(), options), 0.08);
  }
}

TEST(PaperExtractor, heightsInResultsAreAboveGround) {
  for (const PoleDetection& pole : extract(yardPoints(), paperOptions()).poles) {
    EXPECT_NEAR(pole.top, 3.2, 0.2);
    EXPECT_GT(pole.bottom, 0.1);  // ground is cut off at -1.3 m
    EXPECT_LT(pole.bottom, 0.5);
  }
}

// `top > 0.7` is meant above ground but compared in the sensor frame: beams of an HDL-64E, that
// rise by 2°, are not so high before 20 m.
TEST(PaperExtractor, heightsAboveGroundBringsBackTheNearPoles) {
  const PointList points = castYard(sensorOptions("hdl64e"));
  ExtractionOptions options;
  options.method = ExtractionMethod::paper;
  const Result asStated = extract(points, options, "hdl64e");
  EXPECT_TRUE(asStated.poles.empty());
  EXPECT_GE(asStated.of(Refusal::tooLow), 4u);
  options.paper.heightsAboveGround = true;
  options.paper.minZ = 0.3;
  expectYard(extract(points, options, "hdl64e"), 0.08);
}

TEST(PaperExtractor, withoutWrapThePoleOnTheSeamIsLost) {
  ExtractionOptions options = paperOptions();
  options.paper.wrapAround = false;
  const Result result = extract(yardPoints(), options);
  EXPECT_FALSE(nearest(result.poles, -9, 0, 0.06));
  EXPECT_TRUE(nearest(result.poles, 8, 3, 0.06));
}

TEST(PaperExtractor, whatCrowdsThePoleRefusesIt) {
  Scene scene = yard();
  for (int i = 0; i < 8; ++i) {  // slim sticks in a ring of 0.45 m around the first pole
    const double angle = (i + 0.5) * M_PI / 4;
    scene.cylinders.push_back(
        {8 + 0.45 * std::cos(angle), 3 + 0.45 * std::sin(angle), 0.03, -3, 1.7});
  }
  const PointList points = castYard(sensorOptions("os1_64"), scene);
  ExtractionOptions options = paperOptions();
  options.paper.freeSpace = "ring";
  const Result crowded = extract(points, options);
  EXPECT_GE(crowded.of(Refusal::notFree), 1u);
  EXPECT_FALSE(nearest(crowded.poles, 8, 3, 0.1));
  EXPECT_TRUE(nearest(crowded.poles, -9, 0, 0.1));
  options.paper.freeShare = 1e9;
  EXPECT_EQ(extract(points, options).of(Refusal::notFree), 0u);
}

TEST(PaperExtractor, cornersLookBesideTheBoxOnly) {
  Scene scene = yard();
  scene.cylinders.push_back(
      {8, 3.6, 0.06, -3, 1.7});  // 0.6 m to the left: in the ring, in no corner
  const PointList points = castYard(sensorOptions("os1_64"), scene);
  ExtractionOptions options = paperOptions();
  EXPECT_TRUE(nearest(extract(points, options).poles, 8, 3, 0.1));
  options.paper.freeSpace = "ring";
  EXPECT_FALSE(nearest(extract(points, options).poles, 8, 3, 0.1));
}

TEST(PaperExtractor, growingUpwardsFindsNoFewer) {
  ExtractionOptions options = paperOptions();
  options.paper.growUpwards = true;
  expectYard(extract(yardPoints(), options), 0.06);
}

TEST(PaperExtractor, pointsAreCounted) {
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

TEST(PaperExtractor, fromNothingComesNothing) {
  EXPECT_TRUE(extract(PointList(), paperOptions()).poles.empty());
  PointList points;
  for (int i = 0; i < 1000; ++i) points.add(8, 3, 0);
  points.add(1e30, 1e30, 1e29);
  EXPECT_TRUE(extract(points, paperOptions()).poles.empty());
}

namespace {

struct Spoiled {
  Refusal reason;
  std::function<void(PaperOptions&)> spoil;
};
class PaperExtractorRefusal : public ::testing::TestWithParam<Spoiled> {};
const std::vector<Spoiled> kSpoiled = {
    {Refusal::tooFewPoints, [](PaperOptions& o) { o.minPixels = 100000; }},
    {Refusal::tooWide, [](PaperOptions& o) { o.minAspect = 1000; }},
    {Refusal::tooLow, [](PaperOptions& o) { o.minTop = 5; }},
    {Refusal::startsTooHigh, [](PaperOptions& o) { o.maxBottom = -1.3; }},
    {Refusal::tooShort, [](PaperOptions& o) { o.minHeight = 6; }},
    {Refusal::badFit, [](PaperOptions& o) { o.maxRadius = 0.03; }},
    {Refusal::notFree, [](PaperOptions& o) { o.freeShare = 0; }}};

}  // namespace

TEST_P(PaperExtractorRefusal, isCounted) {
  ExtractionOptions options = paperOptions();
  GetParam().spoil(options.paper);
  const Result result = extract(yardPoints(), options);
  EXPECT_TRUE(result.poles.empty());
  EXPECT_GE(result.of(GetParam().reason), 4u);
}
INSTANTIATE_TEST_SUITE_P(Each, PaperExtractorRefusal, ::testing::ValuesIn(kSpoiled),
                         [](const auto& i) { return std::string(name(i.param.reason)); });

TEST(PaperExtractorRefusal, whatStandsBehindOthersIsNotInTheForeground) {
  Scene scene = yard();
  for (const double side : {-1.0, 1.0})  // seen through the gap between two boards
    scene.walls.push_back({4 + 0.06 * 3 * side, 1.5 - 0.06 * 8 * side, 4 + 0.6 * 3 * side,
                           1.5 - 0.6 * 8 * side, -3, 4});
  const Result result = extract(castYard(sensorOptions("os1_64"), scene), paperOptions());
  EXPECT_GE(result.of(Refusal::notForeground), 1u);
}
