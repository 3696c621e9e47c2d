#include <gtest/gtest.h>

#include "core/mapping/MapDiff.h"
#include "support/Poles.h"

namespace polemcl::test_map_diff {
namespace {

using namespace polemcl::tests;

std::vector<MapPole> polesAt(const std::vector<std::pair<double, double>>& places) {
  std::vector<MapPole> poles;
  for (const auto& [x, y] : places) poles.push_back(mapPoleAt(x, y));
  return poles;
}

TEST(MapDiff, TellsNewVanishedAndMoved) {
  const auto before = polesAt({{0, 0}, {10, 0}, {20, 0}, {30, 0}});
  const auto after = polesAt({{40, 0}, {30.1, 0}, {10.8, 0.6}, {0.1, -0.1}});
  const MapDiff diff = diffMaps(before, after);
  ASSERT_EQ(diff.same.size(), 2u);
  EXPECT_EQ(diff.same[0].before.x, 0);
  EXPECT_EQ(diff.same[1].after.x, 30.1);
  ASSERT_EQ(diff.moved.size(), 1u);
  EXPECT_EQ(diff.moved[0].before.x, 10);
  EXPECT_EQ(diff.moved[0].after.x, 10.8);
  EXPECT_NEAR(diff.moved[0].distance, 1, 1e-12);
  ASSERT_EQ(diff.appeared.size(), 1u);
  EXPECT_EQ(diff.appeared[0].x, 40);
  ASSERT_EQ(diff.vanished.size(), 1u);
  EXPECT_EQ(diff.vanished[0].x, 20);
}

TEST(MapDiff, PairsOneToOneTheNearestFirst) {
  // 0.2 is nearer to 0.1 than to 0: that pair is taken, 0 has vanished beside -0.24.
  const MapDiff diff = diffMaps(polesAt({{0, 0}, {0.1, 0}}), polesAt({{0.2, 0}, {-0.24, 0}}));
  ASSERT_EQ(diff.same.size(), 2u);
  EXPECT_EQ(diff.same[0].before.x, 0);
  EXPECT_EQ(diff.same[0].after.x, -0.24);
  EXPECT_EQ(diff.same[1].before.x, 0.1);
  EXPECT_TRUE(diff.moved.empty());
}

TEST(MapDiff, AStandingPoleIsNotTakenForAMovedOne) {
  // The new pole beside the one that stays did not come from it.
  const MapDiff diff = diffMaps(polesAt({{0, 0}}), polesAt({{0, 0}, {1, 0}}));
  EXPECT_EQ(diff.same.size(), 1u);
  EXPECT_EQ(diff.appeared.size(), 1u);
  EXPECT_TRUE(diff.moved.empty());
}

TEST(MapDiff, EmptyMaps) {
  EXPECT_EQ(diffMaps({}, polesAt({{1, 1}})).appeared.size(), 1u);
  EXPECT_EQ(diffMaps(polesAt({{1, 1}}), {}).vanished.size(), 1u);
  EXPECT_TRUE(diffMaps({}, {}).same.empty());
}

TEST(MapDiff, RefusesBadInput) {
  EXPECT_THROW(diffMaps({}, {}, {0, 1}), Error);
  EXPECT_THROW(diffMaps({}, {}, {0.2, -1}), Error);
  EXPECT_THROW(diffMaps(polesAt({{NAN, 0}}), polesAt({{1, 1}})), Error);
}

}  // namespace
}  // namespace polemcl::test_map_diff
