#include <gtest/gtest.h>

#include <vector>

#include "report/picture/PictureLayout.h"

namespace polemcl::report::test_picture_layout {
namespace {

bool overlap(const Rect& a, const Rect& b) {
  return a.x < b.right() && b.x < a.right() && a.y < b.bottom() && b.y < a.bottom();
}

}  // namespace

TEST(PictureLayout, ALongStreetHasItsErrorsBelow) {
  const PictureLayout layout = layoutPicture(1600, 1000, {0, 1500, 0, 100}, true);
  EXPECT_GT(layout.position.y, layout.map.bottom());
  EXPECT_EQ(layout.position.width, layout.map.width);
}

TEST(PictureLayout, ASquareTownHasThemBeside) {
  const PictureLayout layout = layoutPicture(1600, 1000, {0, 200, 0, 220}, true);
  EXPECT_GT(layout.position.x, layout.map.right());
  EXPECT_GT(layout.map.height, 800);
}

TEST(PictureLayout, WithoutErrorsTheMapTakesAll) {
  const PictureLayout layout = layoutPicture(1600, 1000, {0, 10, 0, 10}, false);
  EXPECT_GT(layout.map.width, 1400);
  EXPECT_GT(layout.map.height, 800);
  EXPECT_EQ(layout.position.width, 0);
}

TEST(PictureLayout, PartsStayOnThePageAndApartWhateverTheShape) {
  for (const auto& [width, height] : {std::pair(1200, 750), std::pair(1600, 1000)})
    for (const Bounds& bounds : std::vector<Bounds>{
             {0, 0, 0, 0}, {0, 1000, 0, 0}, {0, 0, 0, 1000}, {-5, 5, -5, 5}, {0, 3, 0, 2}}) {
      const PictureLayout layout = layoutPicture(width, height, bounds, true);
      for (const Rect& part : {layout.map, layout.position, layout.heading}) {
        EXPECT_GE(part.x, 80);  // labels of the value axis
        EXPECT_GE(part.y, 90);  // title and legend
        EXPECT_LE(part.right(), width - 20);
        EXPECT_LE(part.bottom(), height - 50);  // labels of the distance axis
        EXPECT_GE(part.width, 300);
        EXPECT_GE(part.height, 60);
      }
      EXPECT_FALSE(overlap(layout.map, layout.position));
      EXPECT_FALSE(overlap(layout.map, layout.heading));
      EXPECT_FALSE(overlap(layout.position, layout.heading));
    }
}

}  // namespace polemcl::report::test_picture_layout
