#include <gtest/gtest.h>

#include "report/scene/DiffScene.h"
#include "support/SampleViews.h"
#include "support/Scenes.h"

namespace polemcl::report::test_diff_scene {

TEST(DiffScene, EachKindInItsGroup) {
  const MapDiff diff = diffMaps({poleAt(0, 0), poleAt(10, 0), poleAt(20, 8), poleAt(25, 8)},
                                {poleAt(0, 0), poleAt(11, 0.5), poleAt(30, 4)});
  const auto scene = makeDiffScene(diff, "a to b");
  EXPECT_EQ(cylindersOf(scene, "same").size(), 1u);
  EXPECT_EQ(cylindersOf(scene, "new").size(), 1u);
  EXPECT_EQ(cylindersOf(scene, "vanished").size(), 2u);
  EXPECT_EQ(cylindersOf(scene, "moved").size(), 1u);
  for (const char* line : {"a to b\n", "1 on both maps\n", "1 new", "2 vanished", "1 moved"})
    EXPECT_NE(legendOf(scene).find(line), std::string::npos) << line << legendOf(scene);
}

TEST(DiffScene, PlacesAndHeightsAreThoseOfThePoles) {
  const auto poles = cylindersOf(makeDiffScene(diffMaps({}, {poleAt(3, 4)})), "new");
  ASSERT_EQ(poles.size(), 1u);
  EXPECT_EQ(poles[0]->getPose().x, 3);
  EXPECT_EQ(poles[0]->getPose().y, 4);
  EXPECT_EQ(poles[0]->getPose().z, 0.5);
  EXPECT_NEAR(poles[0]->getHeight(), 4, 1e-6);
}

TEST(DiffScene, UtmCoordinatesKeepTheirCentimetres) {
  const auto scene = makeDiffScene(diffMaps(
      {poleAt(448010.25, 5417000.5)}, {poleAt(448011.25, 5417000.5), poleAt(448050, 5417000)}));
  const auto moved = cylindersOf(scene, "moved");
  ASSERT_EQ(moved.size(), 1u);
  EXPECT_NEAR(moved[0]->getPose().x, 11.25, 1e-6);
  EXPECT_NEAR(moved[0]->getPose().y, 0.5, 1e-6);
  EXPECT_NEAR(boxOf(scene, "moves").min.x, 10.25, 1e-4);
  EXPECT_NEAR(boxOf(scene, "moves").max.x, 11.25, 1e-4);
  EXPECT_NE(legendOf(scene).find("x 448000, y 5417000"), std::string::npos);
}

TEST(DiffScene, RefusesNothing) {
  EXPECT_THROW(makeDiffScene({}), Error);
}

}  // namespace polemcl::report::test_diff_scene
