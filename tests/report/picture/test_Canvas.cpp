#include <gtest/gtest.h>

#include <polemcl/core/common/Types.h>
#include "report/picture/Canvas.h"
#include "support/Pixels.h"
#include "support/SampleViews.h"

namespace polemcl::report::test_canvas {

TEST(Canvas, ShapesLandWhereTheyAreDrawn) {
  Canvas canvas(100, 60);
  canvas.fill({10, 20, 30, 10}, rgb(0xff0000));
  canvas.disc({70, 30}, 8, rgb(0x00ff00), rgb(0x000000), 0);
  canvas.line({{0, 50}, {100, 50}}, rgb(0x0000ff), 4);
  const TestFolder folder;
  const auto file = folder / "a.png";
  canvas.writePng(file);
  const Pixels image(file);
  ASSERT_EQ(image.width(), 100);
  ASSERT_EQ(image.height(), 60);
  EXPECT_EQ(image.at(11, 21), 0xff0000u);
  EXPECT_EQ(image.at(39, 29), 0xff0000u);
  EXPECT_EQ(image.at(42, 25), 0xffffffu);
  EXPECT_EQ(image.at(70, 30), 0x00ff00u);
  EXPECT_EQ(image.at(70, 40), 0xffffffu);
  EXPECT_EQ(image.at(50, 50), 0x0000ffu);
  EXPECT_EQ(image.at(50, 54), 0xffffffu);
}

TEST(Canvas, ClipKeepsDrawingInside) {
  Canvas canvas(40, 40);
  canvas.clip({0, 0, 20, 40});
  canvas.fill({0, 0, 40, 40}, rgb(0xff0000));
  canvas.unclip();
  canvas.fill({30, 0, 5, 5}, rgb(0x0000ff));
  const TestFolder folder;
  const auto file = folder / "a.png";
  canvas.writePng(file);
  const Pixels image(file);
  EXPECT_EQ(image.at(10, 10), 0xff0000u);
  EXPECT_EQ(image.at(25, 10), 0xffffffu);
  EXPECT_EQ(image.at(32, 2), 0x0000ffu);
}

TEST(Canvas, TextEndsWhereItsAlignmentSays) {
  Canvas canvas(300, 120);
  const TextStyle right{20, rgb(0x000000), Align::right};
  canvas.text("metres", {200, 30}, right);
  canvas.text("metres", {100, 70}, {20, rgb(0x000000), Align::left});
  canvas.text("metres", {150, 110}, {20, rgb(0x000000), Align::centre});
  const double width = canvas.textWidth("metres", right);
  const TestFolder folder;
  const auto file = folder / "a.png";
  canvas.writePng(file);
  const Pixels image(file);
  const auto expectInk = [&](int top, int bottom, double left) {
    const auto [first, last] = image.inkColumns(top, bottom);
    EXPECT_NEAR(first, left, 4);
    EXPECT_NEAR(last, left + width, 4);
  };
  expectInk(10, 36, 200 - width);
  expectInk(50, 76, 100);
  expectInk(90, 116, 150 - width / 2);
}

TEST(Canvas, AHaloKeepsTextReadableUponADrawing) {
  Canvas canvas(200, 60);
  canvas.fill({0, 0, 200, 60}, rgb(0x0000ff));
  canvas.text("H", {20, 45}, {40, rgb(0x000000)});
  canvas.text("H", {120, 45}, {40, rgb(0x000000), Align::left, false, false, true});
  const TestFolder folder;
  const auto file = folder / "a.png";
  canvas.writePng(file);
  const Pixels image(file);
  const auto count = [&](int left, int right, unsigned color) {
    int pixels = 0;
    for (int y = 0; y < 60; ++y)
      for (int x = left; x < right; ++x) pixels += image.at(x, y) == color;
    return pixels;
  };
  EXPECT_EQ(count(0, 100, 0xffffff), 0);
  EXPECT_GT(count(100, 200, 0xffffff), 50);
  EXPECT_EQ(count(0, 100, 0x000000), count(100, 200, 0x000000));
}

TEST(Canvas, RefusesWhatCairoCannotHold) {
  EXPECT_THROW(Canvas(100000, 100), Error);
}

TEST(Canvas, RefusesToWriteIntoAMissingFolder) {
  Canvas canvas(10, 10);
  EXPECT_THROW(canvas.writePng(TestFolder() / "no/a.png"), Error);
}

TEST(Canvas, RefusesTextThatIsNoUtf8AndWritesNothing) {
  Canvas canvas(50, 50);
  canvas.text("\xff\xfe", {5, 20}, {});
  const TestFolder folder;
  const auto file = folder / "a.png";
  EXPECT_THROW(canvas.writePng(file), Error);
  EXPECT_FALSE(std::filesystem::exists(file));
}

}  // namespace polemcl::report::test_canvas
