#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "core/common/Binder.h"
#include "core/extraction/range_image/RangeImage.h"
#include "support/Clouds.h"
#include "support/Refusal.h"

namespace polemcl::test_range_image {
namespace {

using namespace polemcl::clouds;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The options of an image without cuts by height.
struct View : RangeImageOptions {
  double minRange = 0.5;
  View() {
    minZ = -kInfinity;
    maxZ = kInfinity;
  }
};

/// Four rows of 10° from +20° to -20°, 16 columns of 22.5°.
View smallImage() {
  View options;
  options.rows = 4;
  options.columns = 16;
  options.fovUp = 20 * kDegree;
  options.fovDown = -20 * kDegree;
  return options;
}

/// Rows meet where asin(z / r) = 0 and ± asin(0.6): points (4, 0, ± 3) lie exactly on the borders.
View exactBorders() {
  View options;
  options.rows = 2;
  options.columns = 16;
  options.fovUp = std::asin(0.6);
  options.fovDown = -std::asin(0.6);
  return options;
}

PointCounts projectInto(RangeImage& image, const PointList& points, const View& options) {
  return project(points.view(), options, options.minRange, 0, image);
}

std::size_t total(const PointCounts& c) {
  return c.used + c.hidden + c.invalid + c.outOfView + c.outOfRange;
}

std::string refusal(const std::function<void(View&)>& spoil) {
  View view;
  spoil(view);
  return tests::messageOf([&] {
    RangeImageOptions options = view;
    options.minZ = -1;
    options.maxZ = 1;
    checkOptions(options);
    RangeImage image(4, 16);
    projectInto(image, PointList(), view);
  });
}

TEST(RangeImage, PixelsAsComputedByHand) {
  struct Expected {
    double azimuthDeg, elevationDeg;
    int row, column;
  };
  // u = ½ (1 - azimuth/180°) · 16, v = (1 - (elevation + 20°) / 40°) · 4
  const std::vector<Expected> table = {
      {11.25, 15, 0, 7},  {-11.25, 5, 1, 8},   {33.75, -5, 2, 6},  {-33.75, -15, 3, 9},
      {101.25, 19, 0, 3}, {-101.25, 1, 1, 12}, {168.75, -1, 2, 0}, {-168.75, -19, 3, 15},
      {179.9, 12, 0, 0},  {-179.9, 12, 0, 15}};
  for (const Expected& e : table) {
    PointList points;
    points.addPolar(e.azimuthDeg * kDegree, e.elevationDeg * kDegree, 10);
    RangeImage image(4, 16);
    EXPECT_EQ(projectInto(image, points, smallImage()).used, 1u);
    EXPECT_TRUE(image.valid(e.row, e.column)) << e.azimuthDeg << ' ' << e.elevationDeg;
    EXPECT_NEAR(image.range(e.row, e.column), 10, 1e-5);
    EXPECT_EQ(image.point(e.row, e.column), 0);
  }
}

TEST(RangeImage, StraightAheadIsTheMiddleColumnAndAzimuthFallsWithTheColumn) {
  PointList points;
  points.add(10, 0, 0);
  RangeImage image(4, 16);
  projectInto(image, points, smallImage());
  EXPECT_TRUE(image.valid(2, 8));

  int before = 16;
  for (double azimuth = -175; azimuth < 180; azimuth += 22.5) {
    PointList one;
    one.addPolar(azimuth * kDegree, 0.01, 10);
    projectInto(image, one, smallImage());
    int column = -1;
    for (int c = 0; c < 16; ++c)
      if (image.valid(1, c)) column = c;
    EXPECT_EQ(column, before - 1);
    before = column;
  }
}

// The angle added in Eq. 1 is the one below the horizon: with the upper one added, the horizon of
// this sensor would lie in row 57.
TEST(RangeImage, RowZeroIsTopmostWhenTheViewIsNotSymmetric) {
  View options;
  options.rows = 64;
  options.columns = 500;
  options.fovUp = 3 * kDegree;
  options.fovDown = -25 * kDegree;
  PointList points;
  points.addPolar(0.3, 0, 10);                // v = (1 - 25/28) · 64 = 6.86
  points.addPolar(0.3, 2.9 * kDegree, 11);    // v = 0.23
  points.addPolar(0.3, -24.9 * kDegree, 12);  // v = 63.8
  RangeImage image(64, 500);
  projectInto(image, points, options);
  const int column = static_cast<int>(0.5 * (1 - 0.3 / M_PI) * 500);
  EXPECT_EQ(image.point(6, column), 0);
  EXPECT_EQ(image.point(0, column), 1);
  EXPECT_EQ(image.point(63, column), 2);
}

TEST(RangeImage, ClosesAtTheSeam) {
  for (const float y : {0.f, -0.f}) {  // azimuth +180° and -180° are one direction
    PointList points;
    points.add(-10, y, 1);
    RangeImage image(4, 16);
    EXPECT_EQ(projectInto(image, points, smallImage()).used, 1u);
    EXPECT_TRUE(image.valid(1, 0));
  }
  const RangeImage image(4, 16);
  EXPECT_EQ(image.wrap(-1), 15);
  EXPECT_EQ(image.wrap(16), 0);
  EXPECT_EQ(image.wrap(0), 0);
  EXPECT_EQ(image.wrap(15), 15);
}

TEST(RangeImage, NearestPointWinsInAnyOrder) {
  const std::array<std::array<double, 3>, 6> orders = {
      {{5, 6, 7}, {5, 7, 6}, {6, 5, 7}, {6, 7, 5}, {7, 5, 6}, {7, 6, 5}}};
  for (const auto& ranges : orders) {
    PointList points;
    for (const double r : ranges) points.addPolar(0.1, 0.01, r);
    RangeImage image(4, 16);
    const PointCounts counts = projectInto(image, points, smallImage());
    EXPECT_EQ(counts.used, 1u);
    EXPECT_EQ(counts.hidden, 2u);
    EXPECT_NEAR(image.range(1, 7), 5, 1e-5);
    EXPECT_EQ(ranges[image.point(1, 7)], 5);
  }
}

TEST(RangeImage, OfEquallyNearPointsTheFirstWins) {
  PointList points;
  points.add(3, -0.25, 0.125);
  points.add(3, -0.25, 0.125);
  RangeImage image(4, 16);
  projectInto(image, points, smallImage());
  EXPECT_EQ(image.point(1, 8), 0);
}

TEST(RangeImage, EqualsABruteForceOnRandomClouds) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    sim::Random random(seed);
    PointList points;
    for (int i = 0; i < 5000; ++i)
      points.addPolar(random.uniform(-M_PI, M_PI), random.uniform(-30, 30) * kDegree,
                      random.uniform(0, 60));
    const View options = smallImage();
    RangeImage image(4, 16);
    const PointCounts counts = projectInto(image, points, options);

    std::vector<int> nearest(64, -1);
    PointCounts expected;
    const auto range = [&](int i) {
      return std::hypot(std::hypot(points.x[i], points.y[i]), points.z[i]);
    };
    for (int i = 0; i < 5000; ++i) {
      const double elevation = std::atan2(points.z[i], std::hypot(points.x[i], points.y[i]));
      const double azimuth = std::atan2(points.y[i], points.x[i]);
      if (range(i) < 0.5 || range(i) > 50) {
        ++expected.outOfRange;
      } else if (std::abs(elevation) > 20 * kDegree) {
        ++expected.outOfView;
      } else {
        const int row = static_cast<int>((20 * kDegree - elevation) / (10 * kDegree));
        const int column = static_cast<int>((M_PI - azimuth) / (22.5 * kDegree));
        int& best = nearest[row * 16 + column];
        ++(best < 0 ? expected.used : expected.hidden);
        if (best < 0 || range(i) < range(best)) best = i;
      }
    }
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 16; ++column)
        ASSERT_EQ(image.point(row, column), nearest[row * 16 + column]) << row << ' ' << column;
    EXPECT_EQ(counts.used, expected.used);
    EXPECT_EQ(counts.hidden, expected.hidden);
    EXPECT_EQ(counts.outOfView, expected.outOfView);
    EXPECT_EQ(counts.outOfRange, expected.outOfRange);
    EXPECT_EQ(total(counts), points.size());
  }
}

TEST(RangeImage, PointsThatAreNoPointsAreCountedAndDropped) {
  const float nan = std::nanf(""), inf = std::numeric_limits<float>::infinity();
  PointList points;
  for (const float bad : {nan, inf, -inf}) {
    points.add(bad, 1, 0);
    points.add(1, bad, 0);
    points.add(1, 1, bad);
  }
  points.add(0, 0, 0);
  points.add(-0.f, 0, -0.f);
  points.add(10, 0, 0);
  RangeImage image(4, 16);
  const PointCounts counts = projectInto(image, points, smallImage());
  EXPECT_EQ(counts.invalid, 11u);
  EXPECT_EQ(counts.used, 1u);
  EXPECT_EQ(total(counts), 12u);
}

TEST(RangeImage, UpperBorderBelongsToTheViewLowerDoesNot) {
  PointList points;
  points.add(4, 0, 3);   // v = 0
  points.add(4, 0, -3);  // v = rows
  RangeImage image(2, 16);
  const PointCounts counts = projectInto(image, points, exactBorders());
  EXPECT_EQ(counts.used, 1u);
  EXPECT_EQ(counts.outOfView, 1u);
  EXPECT_EQ(image.point(0, 8), 0);
}

TEST(RangeImage, APointBetweenTwoRowsOrColumnsGoesToTheLaterOne) {
  PointList points;
  points.add(4, 0, 0);   // v = 1, u = 8
  points.add(0, 4, 0);   // u = 4
  points.add(0, -4, 0);  // u = 12
  RangeImage image(2, 16);
  projectInto(image, points, exactBorders());
  EXPECT_EQ(image.point(1, 8), 0);
  EXPECT_EQ(image.point(1, 4), 1);
  EXPECT_EQ(image.point(1, 12), 2);
}

TEST(RangeImage, PointsLieStrictlyWithinTheBoundsOfRangeAndHeight) {
  View options = exactBorders();
  options.minRange = 5;
  options.maxRange = 10;
  PointList points;
  points.add(4, 0, 3 - 1e-6);  // nearer than 5 m
  points.add(3, 4, 0);         // 5 m: no nearer than that
  points.add(-6, -8, 0);       // 10 m
  points.add(0, -9.99999, 0);  // nearer
  points.add(-8, 0, 1);        // upper bound of height
  points.add(0, 8, -1);        // lower bound
  points.add(-7, 2, 0.9999);   // below the upper one
  points.add(-7, -2, -0.9999);
  RangeImage image(2, 16);
  options.minZ = -1;
  options.maxZ = 1;
  const PointCounts counts = projectInto(image, points, options);
  EXPECT_EQ(counts.used, 4u);
  EXPECT_EQ(counts.outOfRange, 4u);
}

TEST(RangeImage, ClampedPointsOutsideTheViewGoToTheBorderRows) {
  PointList points;
  points.addPolar(0.1, 40 * kDegree, 10);
  points.addPolar(-0.1, -60 * kDegree, 11);
  View options = smallImage();
  RangeImage image(4, 16);
  EXPECT_EQ(projectInto(image, points, options).outOfView, 2u);
  options.details = ExtractionDetails::authors;
  const PointCounts counts = projectInto(image, points, options);
  EXPECT_EQ(counts.used, 2u);
  EXPECT_EQ(counts.outOfView, 0u);
  EXPECT_EQ(image.point(0, 7), 0);
  EXPECT_EQ(image.point(3, 8), 1);
}

// The square of z is a denormal number, whose root is less than z: there is no angle.
TEST(RangeImage, APointWithoutAnAngleIsOutOfView) {
  PointList points;
  points.add(0, 0, 4e-23);
  View options = smallImage();
  options.singlePrecision = true;
  options.minRange = 0;
  for (const auto details : {ExtractionDetails::paper, ExtractionDetails::authors}) {
    options.details = details;
    RangeImage image(4, 16);
    const PointCounts counts = projectInto(image, points, options);
    EXPECT_EQ(counts.outOfView, 1u);
    EXPECT_EQ(counts.used, 0u);
  }
}

// In single precision, the view from the horizon down to it has no width.
TEST(RangeImage, AViewWithoutWidthHoldsNoPoint) {
  PointList points;
  points.add(10, 0, 0);
  points.add(10, 0, 1);
  View options = smallImage();
  options.singlePrecision = true;
  options.fovUp = 1e-300;
  options.fovDown = 0;
  RangeImage image(4, 16);
  EXPECT_EQ(projectInto(image, points, options).outOfView, 2u);
}

TEST(RangeImage, ClampedTheSeamBelongsToTheLastColumn) {
  PointList points;
  points.add(-10, -0.f, 1);  // azimuth -180°: u = columns
  View options = smallImage();
  RangeImage image(4, 16);
  projectInto(image, points, options);
  EXPECT_TRUE(image.valid(1, 0));
  options.details = ExtractionDetails::authors;
  projectInto(image, points, options);
  EXPECT_TRUE(image.valid(1, 15));
  EXPECT_FALSE(image.valid(1, 0));
}

TEST(RangeImage, MirroredColumnsCountTheOtherWay) {
  View options = smallImage();
  options.mirrored = true;
  PointList points;
  points.addPolar(30 * kDegree, 0.01, 10);
  RangeImage image(4, 16), mirror(4, 16);
  projectInto(image, points, smallImage());
  projectInto(mirror, points, options);
  for (int c = 0; c < 16; ++c) EXPECT_EQ(mirror.point(1, c), image.point(1, 15 - c)) << c;
  EXPECT_TRUE(mirror.valid(1, 9));
}

// 10 m and 10.0000002 m: one float, two doubles.
TEST(RangeImage, InSinglePrecisionRangesAreFloats) {
  PointList points;
  points.add(10, -0.002, 0);
  points.add(10, 0, 0);
  View options = exactBorders();
  RangeImage image(2, 16);
  projectInto(image, points, options);
  EXPECT_EQ(image.point(1, 8), 1);
  options.singlePrecision = true;
  projectInto(image, points, options);
  EXPECT_EQ(image.point(1, 8), 0);  // of equals the first
}

// Points on the borders of columns: u of a float is off by up to 3e-5 px.
TEST(RangeImage, SinglePrecisionMovesPointsOnBordersByOneColumn) {
  View options = smallImage();
  options.rows = 2;
  options.columns = 500;
  View single = options;
  single.singlePrecision = true;
  RangeImage image(2, 500), singleImage(2, 500);
  int moved = 0;
  for (int border = 1; border < 500; ++border) {
    PointList point;
    point.addPolar(M_PI * (1 - 2 * border / 500.0), 0.1, 10);
    projectInto(image, point, options);
    projectInto(singleImage, point, single);
    const auto at = [&](const RangeImage& of, int c) { return of.valid(0, c); };
    const bool left = at(image, border - 1), singleLeft = at(singleImage, border - 1);
    EXPECT_TRUE(left || at(image, border)) << border;
    EXPECT_TRUE(singleLeft || at(singleImage, border)) << border;
    moved += left != singleLeft;
  }
  EXPECT_GT(moved, 20);
  EXPECT_LT(moved, 480);
}

TEST(RangeImage, CoordinatesOfAGridAreTakenExactly) {
  for (const int steps : {1, 247, -247, 9999}) {
    const double exact = steps * 0.005;
    EXPECT_EQ(exactCoordinate(static_cast<float>(exact), 0.005), exact);
    EXPECT_EQ(exactCoordinate(static_cast<float>(exact), 0), static_cast<float>(exact));
  }
  PointList points;
  points.add(10, 0, 0.1);  // the float is more than 0.1
  View options = smallImage();
  RangeImage image(4, 16);
  options.minZ = 0.1;
  options.maxZ = 1;
  EXPECT_EQ(projectInto(image, points, options).used, 1u);
  options.coordinateStep = 0.005;
  EXPECT_EQ(projectInto(image, points, options).outOfRange, 1u);
}

TEST(RangeImage, IsEmptiedBeforeEachProjection) {
  PointList points;
  points.add(10, 0, 0);
  RangeImage image(4, 16);
  EXPECT_FALSE(image.valid(2, 8));
  EXPECT_EQ(image.range(2, 8), 0);
  EXPECT_EQ(image.point(2, 8), -1);
  projectInto(image, points, smallImage());
  EXPECT_TRUE(image.valid(2, 8));
  EXPECT_EQ(total(projectInto(image, PointList(), smallImage())), 0u);
  EXPECT_FALSE(image.valid(2, 8));
  EXPECT_EQ(image.range(2, 8), 0);
}

TEST(RangeImageView, RefusesSizesAnglesAndRangesOutOfBounds) {
  EXPECT_EQ(refusal([](auto&) {}), "no error");
  EXPECT_HAS(refusal([](auto& o) { o.rows = 1; }), "0, or at least 2");
  EXPECT_HAS(refusal([](auto& o) { o.rows = 1025; }), "1025");
  EXPECT_HAS(refusal([](auto& o) { o.columns = 15; }), "0, or at least 16");
  EXPECT_HAS(refusal([](auto& o) { o.columns = 65537; }), "65537");
  EXPECT_HAS(refusal([](auto& o) { o.fovUp = o.fovDown = -0.1; }), "fov_up_deg");
  EXPECT_HAS(refusal([](auto& o) { o.fovDown = std::nan(""); }), "fov_down_deg");
  EXPECT_HAS(refusal([](auto& o) { o.minRange = -1; }), "min_range_m");
  for (const double bad : {0.5, std::nan("")})
    EXPECT_HAS(refusal([=](auto& o) { o.maxRange = bad; }), "max_range_m");
}

TEST(RangeImage, ProjectRefusesBadOptions) {
  View options = smallImage();
  options.maxRange = 0;
  RangeImage image(4, 16);
  EXPECT_THROW(projectInto(image, PointList(), options), Error);
}

}  // namespace
}  // namespace polemcl::test_range_image
