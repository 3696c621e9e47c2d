#include <gtest/gtest.h>
#include <unistd.h>

#include "report/picture/DiffPicture.h"
#include "support/Pixels.h"
#include "support/SampleViews.h"

namespace polemcl::report::test_diff_picture {
namespace {

constexpr unsigned green = 0x009e73, orange = 0xd55e00, blue = 0x0072b2, grey = 0xaab2bd;

std::filesystem::path picture(const MapDiff& diff, const char* name) {
  const auto file = std::filesystem::temp_directory_path() /
                    (std::string("polemcl_diff_") + name + std::to_string(::getpid()) + ".png");
  drawDiffPng(diff, "a → b", file);
  return file;
}

MapDiff someChanges() {
  return diffMaps({poleAt(0, 0), poleAt(10, 0), poleAt(20, 8)},
                  {poleAt(0, 0), poleAt(11, 0.5), poleAt(30, 4)});
}

}  // namespace

TEST(DiffPicture, EachKindHasItsColour) {
  const auto file = picture(someChanges(), "kinds");
  const Pixels image(file);
  const MapDiff same = diffMaps({poleAt(0, 0), poleAt(20, 8)}, {poleAt(0, 0), poleAt(20, 8)});
  const auto calmFile = picture(same, "calm");
  const Pixels calm(calmFile);
  for (const unsigned color : {green, orange, blue}) {
    EXPECT_GT(image.count(color), calm.count(color) + 20) << std::hex << color;
  }
  EXPECT_GT(calm.count(grey), image.count(grey)) << "two stayed, not one";
  std::filesystem::remove(file);
  std::filesystem::remove(calmFile);
}

TEST(DiffPicture, RefusesNothingAndSmallPages) {
  EXPECT_THROW(picture({}, "none"), Error);
  EXPECT_THROW(drawDiffPng(someChanges(), "", "x.png", 800, 600), Error);
}

}  // namespace polemcl::report::test_diff_picture
