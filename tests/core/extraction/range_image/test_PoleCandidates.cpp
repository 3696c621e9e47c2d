#include <gtest/gtest.h>

#include "core/extraction/range_image/PoleCandidates.h"
#include "support/Clouds.h"

namespace polemcl::test_pole_candidates {
namespace {

using namespace polemcl::clouds;

/// A thing of `columns` x 6 pixels at 10 m before a wall at 20 m, its rows 0.4 m apart in height.
struct Scene {
  static constexpr int kTopRow = 2, kRows = 6, kColumn = 8;
  RangeImage image{12, 32};
  PointList points;
  RangeImageOptions options;
  double heightOffset = 0;
  HeightRange heights{-99, -99};

  explicit Scene(double top = 2.5, int columns = 1) {
    options.minTop = 0.7, options.maxBottom = 1.5;
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
  std::optional<RejectionReason> test(int row = kTopRow, int column = kColumn) {
    const Segmentation segmentation(image, options);
    return testCandidate(image, segmentation, segmentation.label(row, column), points.view(),
                         options, heightOffset, heights);
  }
};

TEST(PoleCandidates, ASlimThingBeforeAWallPasses) {
  Scene scene(2.5);
  EXPECT_EQ(scene.test(), std::nullopt);
  EXPECT_FLOAT_EQ(static_cast<float>(scene.heights.high), 2.5f);
  EXPECT_FLOAT_EQ(static_cast<float>(scene.heights.low), 0.5f);
}

/// The scene is refused with the first value of an option, and passes with the second.
template <class T>
void expectBound(Scene scene, T RangeImageOptions::*option, T refuses, T passes,
                 RejectionReason reason) {
  scene.options.*option = refuses;
  EXPECT_EQ(scene.test(), reason);
  scene.options.*option = passes;
  EXPECT_EQ(scene.test(), std::nullopt) << static_cast<int>(reason);
}

TEST(PoleCandidates, BoundsAreStrict) {
  using Options = RangeImageOptions;
  expectBound(Scene(), &Options::minPixels, 6, 5, RejectionReason::tooFewPoints);
  expectBound(Scene(2.5, 4), &Options::maxWidthPx, 3, 4, RejectionReason::tooWide);
  expectBound(Scene(1), &Options::minTop, 1.0, 0.999, RejectionReason::tooLow);
  expectBound(Scene(4), &Options::maxBottom, 1.5, 2.1, RejectionReason::startsTooHigh);
  expectBound(Scene(), &Options::minHeight, 2.001, 1.999, RejectionReason::tooShort);  // 2.0 m tall
}

TEST(PoleCandidates, WiderThanTall) {
  Scene scene(2.5, 7);
  EXPECT_EQ(scene.test(), RejectionReason::tooWide);
  Scene square(2.5, 6);
  EXPECT_EQ(square.test(), std::nullopt);
  square.options.minAspect = 1.01;
  EXPECT_EQ(square.test(), RejectionReason::tooWide);
}

TEST(PoleCandidates, SomethingNearerStandsBesideIt) {
  Scene scene;
  scene.set(Scene::kTopRow, Scene::kColumn - 1, 5, 0);
  EXPECT_EQ(scene.test(), std::nullopt);  // 5 of 6 pixels are in front: 0.83
  scene.set(Scene::kTopRow + 3, Scene::kColumn + 1, 5, 0);
  EXPECT_EQ(scene.test(), RejectionReason::notForeground);  // 4 of 6: 0.67
  scene.options.foreground = 0.6;
  EXPECT_EQ(scene.test(), std::nullopt);
}

TEST(PoleCandidates, APixelWithNearerThingsOnBothSidesCountsOnce) {
  Scene scene;
  scene.set(Scene::kTopRow, Scene::kColumn - 1, 5, 0);
  scene.set(Scene::kTopRow, Scene::kColumn + 1, 5, 0);
  EXPECT_EQ(scene.test(), std::nullopt);
}

// Only the outer two of three columns have neighbours outside: 12 of 18 pixels, 0.67.
TEST(PoleCandidates, InFrontOnlyPixelsAtTheEdgeCount) {
  Scene scene(2.5, 3);
  EXPECT_EQ(scene.test(), std::nullopt);
  scene.options.details = ExtractionDetails::paper;
  EXPECT_EQ(scene.test(), RejectionReason::notForeground);
  scene.options.foreground = 0.66;
  EXPECT_EQ(scene.test(), std::nullopt);
}

TEST(PoleCandidates, InFrontWhatHasNothingBesideItIsNotInTheForeground) {
  Scene scene;
  for (int r = 0; r < Scene::kRows + Scene::kTopRow; ++r)
    for (const int c : {Scene::kColumn - 1, Scene::kColumn + 1}) scene.image.set(r, c, 0, -1);
  EXPECT_EQ(scene.test(), std::nullopt);
  scene.options.details = ExtractionDetails::paper;
  EXPECT_EQ(scene.test(), RejectionReason::notForeground);
}

TEST(PoleCandidates, InFrontANearerNeighbourCountsAgainstAPixel) {
  Scene scene;
  scene.options.details = ExtractionDetails::paper;
  EXPECT_EQ(scene.test(), std::nullopt);
  for (const int row : {0, 3}) scene.set(Scene::kTopRow + row, Scene::kColumn - 1, 5, 0);
  EXPECT_EQ(scene.test(), RejectionReason::notForeground);  // 4 of 6: 0.67
}

TEST(PoleCandidates, WhatIsBesideIsSeenAcrossTheSeam) {
  Scene scene;
  for (int r = Scene::kTopRow; r < Scene::kTopRow + Scene::kRows; ++r) {
    scene.set(r, 0, 10, 2.5 - 0.4 * (r - Scene::kTopRow));
    scene.set(r, 31, r < Scene::kTopRow + 2 ? 5 : 20, 0);
  }
  EXPECT_EQ(scene.test(Scene::kTopRow, 0), RejectionReason::notForeground);
}

TEST(PoleCandidates, TopTooLow) {
  Scene scene(0.6);
  EXPECT_EQ(scene.test(), RejectionReason::tooLow);
  scene.heightOffset = 1.73;  // heights above ground
  EXPECT_EQ(scene.test(), std::nullopt);
  EXPECT_NEAR(scene.heights.high, 2.33, 1e-6);
  EXPECT_NEAR(scene.heights.low, 0.33, 1e-6);
}

TEST(PoleCandidates, TheFirstReasonOfSeveralIsGiven) {
  Scene scene(0.1, 7);  // too wide, too low
  scene.options.minHeight = 9;
  EXPECT_EQ(scene.test(), RejectionReason::tooWide);
  scene.options.minPixels = 100;
  EXPECT_EQ(scene.test(), RejectionReason::tooFewPoints);
}

}  // namespace
}  // namespace polemcl::test_pole_candidates
