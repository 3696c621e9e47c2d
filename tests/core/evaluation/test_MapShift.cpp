// The shift and the turn of a whole map are found.

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "core/evaluation/MapShift.h"

namespace polemcl::test_map_shift {

TEST(MapShift, FindsTheMotionOfAMap) {
  const std::vector<Eigen::Vector2d> truth{{0, 0}, {10, 2}, {20, -3}, {35, 1}};
  const Eigen::Vector2d centre = (truth[0] + truth[1] + truth[2] + truth[3]) / 4;
  std::vector<Eigen::Vector2d> map;
  for (const Eigen::Vector2d& pole : truth)
    map.push_back(Eigen::Rotation2Dd(0.01) * (pole - centre) + centre +
                  Eigen::Vector2d(0.1, -0.05));
  map.emplace_back(60, 60);  // false
  const MapShift moved = mapShift(truth, map, 0.5);
  EXPECT_EQ(moved.pairs, 4u);
  EXPECT_NEAR(moved.shift.x(), 0.1, 1e-12);
  EXPECT_NEAR(moved.shift.y(), -0.05, 1e-12);
  EXPECT_NEAR(moved.rotation, 0.01, 1e-12);
  EXPECT_EQ(mapShift(truth, {{100, 0}}, 0.5).pairs, 0u);
  EXPECT_EQ(mapShift(truth, {{0.1, 0}}, 0.5).rotation, 0);
}

}  // namespace polemcl::test_map_shift
