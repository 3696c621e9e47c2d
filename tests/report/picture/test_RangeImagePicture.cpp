#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include <polemcl/core/extraction/PoleExtractor.h>
#include "report/picture/RangeImagePicture.h"
#include "support/KnownScene.h"
#include "support/Pixels.h"

namespace polemcl::report::test_range_image_picture {
namespace {

constexpr unsigned orange = 0xd55e00, noReturn = 0xf3f4f6;
constexpr int cell = 3;  ///< px: 500 columns and 64 rows are drawn as 1500 x 192
constexpr int left = 24, top = 92, height = 192, step = height + 44;

class RangeImagePicture : public ::testing::Test {
 protected:
  RangeImagePicture() : points(clouds::castYard(clouds::sensorOptions("os1_64"))) {
    view.title = "the yard";
    view.points = points.view();
    view.sensor = clouds::sensorOptions("os1_64");
    view.options.fovUp = 17 * kDegree;
    view.options.fovDown = -17 * kDegree;
  }
  static std::string bytesOf(const std::filesystem::path& name) {
    std::ifstream in(name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  }

  static constexpr double kDegree = M_PI / 180;
  clouds::PointList points;
  RangeImageView view;
  std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "range.png";
};

}  // namespace

TEST_F(RangeImagePicture, PolesAreOrangeWhereTheyStand) {
  drawRangeImagePng(view, file);
  const Pixels image(file);
  EXPECT_EQ(image.width(), 1500 + 2 * left);
  ExtractionOptions options;
  options.method = ExtractionMethod::rangeImage;
  options.rangeImage = view.options;
  PoleExtractor extractor(view.sensor, options);
  const auto poles = extractor.extract(points.view());
  ASSERT_EQ(poles.size(), 4u);
  for (const PoleDetection& pole : poles) {
    // Column of Eq. 1, and a pole's width to each side.
    const double column = 0.5 * (1 - std::atan2(pole.y, pole.x) / M_PI) * 500;
    int found = 0;
    for (int x = left + cell * static_cast<int>(column - 4); x < left + cell * (column + 4); ++x)
      for (int y = top + 2 * step; y < top + 2 * step + height; ++y)
        if (x >= left && x < left + 1500) found += image.at(x, y) == orange;
    EXPECT_GE(found, 4 * cell * cell) << pole.x << ' ' << pole.y;
  }
  // Poles are marked in the third image only; the others have no such colour.
  for (int y = top; y < top + step + height; ++y)
    for (int x = left; x < left + 1500; ++x) ASSERT_NE(image.at(x, y), orange) << x << ' ' << y;
}

TEST_F(RangeImagePicture, NearIsDarkerThanFarAndNoReturnIsLeftOpen) {
  clouds::PointList two;
  for (int i = -20; i <= 20; ++i) {
    two.add(5, i * 0.05, 0);
    two.add(-40, i * 0.4, 0);
  }
  view.points = two.view();
  drawRangeImagePng(view, file);
  const Pixels image(file);
  const int row = top + height / 2;  // the horizon is in the middle of the field of view
  const auto darkest = [&](int x) {
    unsigned least = 0xffffff;
    for (int y = row - 6; y < row + 6; ++y) least = std::min(least, image.at(x, y) & 0xff);
    return least;
  };
  EXPECT_LT(darkest(left + 750), 0x90u);  // blue of near: 0x6b
  EXPECT_GT(darkest(left + 4), 0xa0u);    // far, behind
  EXPECT_EQ(image.at(left + 375, row), noReturn);
}

TEST_F(RangeImagePicture, SameInputSameBytes) {
  drawRangeImagePng(view, file);
  const std::string first = bytesOf(file);
  drawRangeImagePng(view, file);
  EXPECT_FALSE(first.empty());
  EXPECT_EQ(first, bytesOf(file));
}

TEST_F(RangeImagePicture, RefusesWhatCannotBeDrawn) {
  EXPECT_THROW(drawRangeImagePng(view, "/nowhere/range.png"), Error);
  view.options.epsilon = -1;
  EXPECT_THROW(drawRangeImagePng(view, file), Error);
  view.options.epsilon = 0.2;
  view.points = {};
  EXPECT_THROW(drawRangeImagePng(view, file), Error);
}

}  // namespace polemcl::report::test_range_image_picture
