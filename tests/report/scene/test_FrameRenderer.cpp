#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>

#include "report/scene/FrameRenderer.h"
#include "report/scene/LiveScene.h"
#include "support/LiveMoments.h"
#include "support/TempFolder.h"

namespace polemcl::report::test_frame_renderer {
namespace {
/// Pixels of a part of the picture that are nearer to this colour than to white or grey.
int count(const mrpt::img::CImage& image, int x0, int y0, int x1, int y1,
          bool (*wanted)(int, int, int)) {
  int found = 0;
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      const std::uint8_t* p = image(static_cast<unsigned>(x), static_cast<unsigned>(y), 0);
      found += wanted(p[2], p[1], p[0]);  // stored as BGR
    }
  return found;
}

bool isGreen(int r, int g, int b) {
  return g > r + 50 && g > b + 20;
}
bool isOrange(int r, int g, int b) {
  return r > g + 60 && g > b + 10;
}
bool isPurple(int r, int g, int b) {
  return r > g + 30 && b > g + 50;
}

TEST(FrameRenderer, WritesAPictureOfTheSizeWithEverythingInItsColour) {
  const testing_apps::TempFolder folder;
  FrameRenderer renderer(640, 360);
  LiveScene scene(smallMap(), "drive", FrameRenderer::textScale(360));
  LiveMoment moment = knownMoment();  // ahead, to the right and to the left
  moment.poles_robot[0].x = moment.poles_robot[1].x = 20;
  moment.poles_robot[0].y = -5, moment.poles_robot[1].y = 5;
  scene.show(moment);
  renderer.render(*scene.scene(), folder / "a.png");
  mrpt::img::CImage image;
  ASSERT_TRUE(image.loadFromFile((folder / "a.png").string()));
  EXPECT_EQ(image.getWidth(), 640u);
  EXPECT_EQ(image.getHeight(), 360u);
  // Above the panels, which fill the lower corners.
  EXPECT_GT(count(image, 320, 0, 640, 200, isGreen), 20);
  EXPECT_EQ(count(image, 0, 0, 320, 200, isGreen), 0);
  EXPECT_GT(count(image, 0, 0, 320, 200, isOrange), 20);
  EXPECT_EQ(count(image, 320, 0, 640, 200, isOrange), 0);
  // The three particles, in the panel that magnifies them.
  EXPECT_GT(count(image, 482, 215, 630, 330, isPurple), 3);
}

TEST(FrameRenderer, RefusesAFileThatCannotBeWritten) {
  FrameRenderer renderer(160, 160);
  LiveScene scene(smallMap(), "", FrameRenderer::textScale(160));
  scene.show(searchingMoment());
  EXPECT_THROW(renderer.render(*scene.scene(), testing_apps::TempFolder() / "no/a.png"), Error);
}

}  // namespace
}  // namespace polemcl::report::test_frame_renderer
