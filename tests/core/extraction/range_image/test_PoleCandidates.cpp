#include <gtest/gtest.h>

#include <cmath>

#include "core/extraction/range_image/PoleCandidates.h"
#include "support/Clouds.h"

namespace polemcl::test_pole_candidates {

using namespace polemcl;
using namespace polemcl::clouds;

namespace {

/// A thing of `columns` x 6 pixels at 10 m before a wall at 20 m, its rows 0.4 m apart in height.
struct Scene {
  static constexpr int kTopRow = 2, kRows = 6, kColumn = 8;
  RangeImage image{12, 32};
  PointList points;
  PaperOptions options;
  double heightOffset = 0;
  HeightRange heights{-99, -99};

  explicit Scene(double top = 2.5, int columns = 1) {
    for (int r = 0; r < image.rows(); ++r)
      for (int c = 0; c < image.columns(); ++c) {
        const bool thing = c >= kColumn && c < kColumn + columns && r >= kTopRow && r < kTopRow + 6;
        set(r, c, thing ? 10 : 20, top - 0.4 * (r - kTopRow));
      }
  }
  void set(int row, int column, float range, double z) {
    image.set(row, column, range, static_cast<std::int32_t>(points.size()));
    points.add(0, 0, z);
  }
  Refusal test(int row = kTopRow, int column = kColumn) {
    SegmentationOptions growing;
    growing.epsilon = options.epsilon;
    const Segmentation segmentation(image, growing);
    return testCandidate(image, segmentation, segmentation.label(row, column), points.view(),
                         options, heightOffset, heights);
  }
};

}  // namespace

TEST(PoleCandidates, aSlimThingBeforeAWallPasses) {
  Scene scene(2.5);
  EXPECT_EQ(scene.test(), Refusal::count_);
  EXPECT_FLOAT_EQ(static_cast<float>(scene.heights.high), 2.5f);
  EXPECT_FLOAT_EQ(static_cast<float>(scene.heights.low), 0.5f);
}

TEST(PoleCandidates, tooFewPixels) {
  Scene scene;
  scene.options.minPixels = 6;  // strictly more are asked for
  EXPECT_EQ(scene.test(), Refusal::tooFewPoints);
  scene.options.minPixels = 5;
  EXPECT_EQ(scene.test(), Refusal::count_);
}

TEST(PoleCandidates, widerThanTall) {
  Scene scene(2.5, 7);
  EXPECT_EQ(scene.test(), Refusal::tooWide);
  Scene square(2.5, 6);
  EXPECT_EQ(square.test(), Refusal::count_);
  square.options.minAspect = 1.01;
  EXPECT_EQ(square.test(), Refusal::tooWide);
}

TEST(PoleCandidates, widerThanAllowed) {
  Scene scene(2.5, 4);
  scene.options.maxWidthPx = 3;
  EXPECT_EQ(scene.test(), Refusal::tooWide);
  scene.options.maxWidthPx = 4;
  EXPECT_EQ(scene.test(), Refusal::count_);
}

TEST(PoleCandidates, somethingNearerStandsBesideIt) {
  Scene scene;
  scene.set(Scene::kTopRow, Scene::kColumn - 1, 5, 0);
  EXPECT_EQ(scene.test(), Refusal::count_);  // 5 of 6 pixels are in front: 0.83
  scene.set(Scene::kTopRow + 3, Scene::kColumn + 1, 5, 0);
  EXPECT_EQ(scene.test(), Refusal::notForeground);  // 4 of 6: 0.67
  scene.options.foreground = 0.6;
  EXPECT_EQ(scene.test(), Refusal::count_);
}

TEST(PoleCandidates, aPixelWithNearerThingsOnBothSidesCountsOnce) {
  Scene scene;
  scene.set(Scene::kTopRow, Scene::kColumn - 1, 5, 0);
  scene.set(Scene::kTopRow, Scene::kColumn + 1, 5, 0);
  EXPECT_EQ(scene.test(), Refusal::count_);
}

// Of three columns only the outer two have neighbours outside: 12 of 18 pixels, 0.67.
TEST(PoleCandidates, inFrontOnlyPixelsAtTheEdgeCount) {
  Scene scene(2.5, 3);
  EXPECT_EQ(scene.test(), Refusal::count_);
  scene.options.foregroundTest = "in_front";
  EXPECT_EQ(scene.test(), Refusal::notForeground);
  scene.options.foreground = 0.66;
  EXPECT_EQ(scene.test(), Refusal::count_);
}

TEST(PoleCandidates, inFrontWhatHasNothingBesideItIsNotInTheForeground) {
  Scene scene;
  for (int r = 0; r < Scene::kRows + Scene::kTopRow; ++r)
    for (const int c : {Scene::kColumn - 1, Scene::kColumn + 1}) scene.image.set(r, c, 0, -1);
  EXPECT_EQ(scene.test(), Refusal::count_);
  scene.options.foregroundTest = "in_front";
  EXPECT_EQ(scene.test(), Refusal::notForeground);
}

TEST(PoleCandidates, inFrontANearerNeighbourCountsAgainstAPixel) {
  Scene scene;
  scene.options.foregroundTest = "in_front";
  EXPECT_EQ(scene.test(), Refusal::count_);
  for (const int row : {0, 3}) scene.set(Scene::kTopRow + row, Scene::kColumn - 1, 5, 0);
  EXPECT_EQ(scene.test(), Refusal::notForeground);  // 4 of 6: 0.67
}

TEST(PoleCandidates, whatIsBesideIsSeenAcrossTheSeam) {
  Scene scene;
  for (int r = Scene::kTopRow; r < Scene::kTopRow + Scene::kRows; ++r) {
    scene.set(r, 0, 10, 2.5 - 0.4 * (r - Scene::kTopRow));
    scene.set(r, 31, r < Scene::kTopRow + 2 ? 5 : 20, 0);
  }
  EXPECT_EQ(scene.test(Scene::kTopRow, 0), Refusal::notForeground);
}

TEST(PoleCandidates, topTooLow) {
  Scene scene(0.6);
  EXPECT_EQ(scene.test(), Refusal::tooLow);
  scene.heightOffset = 1.73;  // heights above ground
  EXPECT_EQ(scene.test(), Refusal::count_);
  EXPECT_NEAR(scene.heights.high, 2.33, 1e-6);
  EXPECT_NEAR(scene.heights.low, 0.33, 1e-6);
}

TEST(PoleCandidates, topMustLieStrictlyAboveTheBound) {
  Scene scene(1.0);
  scene.options.minTop = 1.0;
  EXPECT_EQ(scene.test(), Refusal::tooLow);
  scene.options.minTop = 0.999;
  EXPECT_EQ(scene.test(), Refusal::count_);
}

TEST(PoleCandidates, startsTooHigh) {
  Scene scene(4.0);
  EXPECT_EQ(scene.test(), Refusal::startsTooHigh);  // from 2.0 m
  scene.options.maxBottom = 2.1;
  EXPECT_EQ(scene.test(), Refusal::count_);
}

TEST(PoleCandidates, tooShort) {
  Scene scene;
  scene.options.minHeight = 2.001;
  EXPECT_EQ(scene.test(), Refusal::tooShort);  // 2.0 m tall
  scene.options.minHeight = 1.999;
  EXPECT_EQ(scene.test(), Refusal::count_);
}

TEST(PoleCandidates, theFirstReasonOfSeveralIsGiven) {
  Scene scene(0.1, 7);  // too wide, too low
  scene.options.minHeight = 9;
  EXPECT_EQ(scene.test(), Refusal::tooWide);
  scene.options.minPixels = 100;
  EXPECT_EQ(scene.test(), Refusal::tooFewPoints);
}

}  // namespace polemcl::test_pole_candidates
