#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "core/extraction/range_image/Segmentation.h"
#include "sim/common/Random.h"
#include "support/Clouds.h"

namespace polemcl::test_segmentation {
namespace {

/// One string a row; '.' is no return, a digit a range of as many metres.
RangeImage draw(const std::vector<std::string>& rows) {
  RangeImage image(static_cast<int>(rows.size()), static_cast<int>(rows[0].size()));
  for (int r = 0; r < image.rows(); ++r)
    for (int c = 0; c < image.columns(); ++c)
      if (rows[r][c] != '.')
        image.set(r, c, static_cast<float>(rows[r][c] - '0'),
                  static_cast<std::int32_t>(image.index(r, c)));
  return image;
}

RangeImageOptions growing(double epsilon, bool wrap) {
  RangeImageOptions options;
  options.epsilon = epsilon;
  options.details = wrap ? ExtractionDetails::mended : ExtractionDetails::authors;
  return options;
}

/// Labels as one string a row, segment 0 is 'a', no segment '.'.
std::vector<std::string> labels(const RangeImage& image, const Segmentation& segmentation) {
  std::vector<std::string> out(image.rows());
  for (int r = 0; r < image.rows(); ++r)
    for (int c = 0; c < image.columns(); ++c) {
      const auto label = segmentation.label(r, c);
      out[r] += label < 0 ? '.' : static_cast<char>('a' + label);
    }
  return out;
}

std::vector<std::string> segment(const std::vector<std::string>& rows, bool wrap,
                                 double epsilon = 0.5) {
  const RangeImage image = draw(rows);
  return labels(image, Segmentation(image, growing(epsilon, wrap)));
}

using Rows = std::vector<std::string>;

/// Holes and steps of a quarter metre, so that chains, forks and unreachable pixels all occur.
RangeImage randomImage(std::uint64_t seed, int rows, int columns) {
  sim::Random random(seed);
  RangeImage image(rows, columns);
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
      if (random.chance(0.75))
        image.set(r, c, 2 + 0.25f * static_cast<float>(random.below(5)),
                  static_cast<std::int32_t>(image.index(r, c)));
  return image;
}

bool inside(const RangeImage& image, bool wrap, int row, int column) {
  const int border = wrap ? 0 : 1;
  return row >= border && row < image.rows() - border &&
         (wrap || (column >= 1 && column < image.columns() - 1));
}

/// Algorithm 1 as it is written: an open set, and clusters that take from it whatever lies left of,
/// right of or below any of their members.
std::vector<int> algorithmOne(const RangeImage& image, double epsilon, bool wrap) {
  std::set<std::pair<int, int>> open;
  for (int r = 0; r < image.rows(); ++r)
    for (int c = 0; c < image.columns(); ++c)
      if (inside(image, wrap, r, c) && image.valid(r, c)) open.insert({r, c});
  std::vector<int> number(static_cast<std::size_t>(image.rows()) * image.columns(), -1);
  const int n = image.columns();
  for (int cluster = 0; !open.empty(); ++cluster) {
    std::vector<std::pair<int, int>> members = {*open.begin()};
    open.erase(open.begin());
    for (bool grown = true; grown;) {
      grown = false;
      for (auto o = open.begin(); o != open.end();) {
        bool touches = false;
        for (const auto& [r, c] : members) {
          const int apart = std::abs(o->second - c);
          const bool beside = o->first == r && (apart == 1 || (wrap && apart == n - 1));
          const bool below = o->first == r + 1 && apart == 0;
          touches |= (beside || below) &&
                     std::abs(image.range(r, c) - image.range(o->first, o->second)) < epsilon;
        }
        if (touches) {
          members.push_back(*o);
          o = open.erase(o);
          grown = true;
        } else {
          ++o;
        }
      }
    }
    for (const auto& [r, c] : members) number[image.index(r, c)] = cluster;
  }
  return number;
}

void expectLabels(const RangeImage& image, const Segmentation& segmentation,
                  const std::vector<int>& expected) {
  std::vector<std::size_t> pixels(segmentation.segments().size());
  for (int r = 0; r < image.rows(); ++r)
    for (int c = 0; c < image.columns(); ++c) {
      ASSERT_EQ(segmentation.label(r, c), expected[image.index(r, c)]) << r << ' ' << c;
      if (segmentation.label(r, c) >= 0) ++pixels[segmentation.label(r, c)];
    }
  for (std::size_t s = 0; s < pixels.size(); ++s) {
    const Segment& segment = segmentation.segments()[s];
    ASSERT_EQ(segment.pixels.size(), pixels[s]);
    for (const Pixel& p : segment.pixels) {
      ASSERT_EQ(segmentation.label(p.row, p.column), static_cast<int>(s));
      ASSERT_GE(p.row, segment.minRow);
      ASSERT_LE(p.row, segment.maxRow);
    }
  }
}

TEST(Segmentation, LikeNeighboursMakeOneSegment) {
  EXPECT_EQ(segment({"1122..",  //
                     "1.22.4",  //
                     "333344"},
                    true, true),
            (Rows{"aabb..",  //
                  "a.bb.c",  //
                  "ddddcc"}));
}

TEST(Segmentation, SeedsAreTakenInReadingOrder) {
  EXPECT_EQ(segment({".5.3.",  //
                     "..4..",  //
                     ".1.2."},
                    true, true),
            (Rows{".a.b.", "..c..", ".d.e."}));
}

TEST(Segmentation, GrowsAcrossTheSeamWhenWrapped) {
  const Rows image = {"......", ".7..7.", "77..77", "......"};
  EXPECT_EQ(segment(image, true), (Rows{"......", ".a..b.", "aa..aa", "......"}));
}

TEST(Segmentation, WithoutWrapTheBordersAreLeftOut) {
  EXPECT_EQ(segment({"777777", "777.77", "77..77", "777777"}, false),
            (Rows{"......", ".aa.b.", ".a..b.", "......"}));
}

TEST(Segmentation, APieceThatOnlyConnectsUpwardsIsItsOwn) {
  const Rows hook = {".4...",  //
                     ".4.4.",  // the right arm is above what the left one reaches
                     ".444.",  //
                     "....."};
  EXPECT_EQ(segment(hook, true), (Rows{".a...", ".a.b.", ".aaa.", "....."}));
}

TEST(Segmentation, EpsilonIsStrict) {
  RangeImage image(2, 16);
  image.set(0, 3, 5.f, 0);
  image.set(0, 4, 5.25f, 1);
  const Segmentation strict(image, growing(0.25, true));
  EXPECT_EQ(strict.segments().size(), 2u);
  const Segmentation wider(image, growing(0.2500001, true));
  EXPECT_EQ(wider.segments().size(), 1u);
}

TEST(Segmentation, ASlopeOfSmallStepsIsOneSegment) {
  EXPECT_EQ(segment({".123456789."}, true, 1.5), (Rows{".aaaaaaaaa."}));
}

TEST(Segmentation, BoxIsCountedAcrossTheSeam) {
  const RangeImage image = draw({"......", "7....7", "77...7", "......"});
  const Segmentation segmentation(image, growing(0.5, true));
  ASSERT_EQ(segmentation.segments().size(), 1u);
  const Segment& s = segmentation.segments()[0];
  EXPECT_EQ(s.width, 3);
  EXPECT_EQ(s.minRow, 1);
  EXPECT_EQ(s.maxRow, 2);
  EXPECT_EQ(s.height(), 2);
  EXPECT_EQ(s.pixels.size(), 5u);
  EXPECT_EQ(s.pixels[0].row, 1);
  EXPECT_EQ(s.pixels[0].column, 0);
}

TEST(Segmentation, AClosedRingIsAsWideAsTheImage) {
  for (const int columns : {16, 17}) {
    const RangeImage image = draw({std::string(columns, '3'), std::string(columns, '.')});
    const Segmentation segmentation(image, growing(0.5, true));
    ASSERT_EQ(segmentation.segments().size(), 1u);
    EXPECT_EQ(segmentation.segments()[0].width, columns);
    EXPECT_EQ(segmentation.segments()[0].height(), 1);
  }
}

TEST(Segmentation, AnEmptyImageHasNoSegments) {
  const RangeImage image(4, 16);
  EXPECT_TRUE(Segmentation(image, growing(0.5, true)).segments().empty());
}

TEST(Segmentation, EqualsAlgorithmOneAsWritten) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const RangeImage image = randomImage(seed, 12, 20);
    for (const bool wrap : {true, false})
      expectLabels(image, Segmentation(image, growing(0.3, wrap)), algorithmOne(image, 0.3, wrap));
  }
}

// An open set searched again for every pixel would not get through this.
TEST(Segmentation, TakesALargeImageOfOneSegment) {
  RangeImage image(512, 8192);
  for (int r = 0; r < image.rows(); ++r)
    for (int c = 0; c < image.columns(); ++c) image.set(r, c, 10, 0);
  const Segmentation segmentation(image, growing(0.2, true));
  ASSERT_EQ(segmentation.segments().size(), 1u);
  EXPECT_EQ(segmentation.segments()[0].pixels.size(), 512u * 8192u);
  EXPECT_EQ(segmentation.segments()[0].height(), 512);
}

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

}  // namespace polemcl::test_segmentation
