#include <gtest/gtest.h>

#include <cmath>

#include "sim/world/SightLines.h"

namespace polemcl::test_sight_lines {
namespace {

using namespace polemcl::sim;

/// A block 4 m wide and 2 m deep at (10, 0), turned by an angle.
SightLines::Block block(double turn) {
  SightLines::Block block;
  block.centre = {10, 0};
  block.half = {1, 2};
  block.axes << std::cos(turn), std::sin(turn), -std::sin(turn), std::cos(turn);
  block.reach = std::sqrt(5);
  return block;
}

TEST(SightLines, TheFreeWayEndsAtTheFirstBlock) {
  const SightLines::Block near = block(0);
  SightLines::Block far = near;
  far.centre.x() = 20;
  EXPECT_NEAR(SightLines::freeWay({&far, &near}, {0, 0}, {40, 0}), 9, 1e-12);
  EXPECT_NEAR(SightLines::freeWay({&far, &near}, {0, 0}, {0, 40}), 40, 1e-12);
  EXPECT_NEAR(SightLines::freeWay({&near}, {0, 0}, {8, 0}), 8, 1e-12) << "it stands behind";
  EXPECT_NEAR(SightLines::freeWay({&near}, {0, 1}, {40, 1}), 9, 1e-12);
  EXPECT_NEAR(SightLines::freeWay({}, {3, 4}, {0, 0}), 5, 1e-12);
}

TEST(SightLines, OfATurnedBlockItIsItsNearSide) {
  const SightLines::Block turned = block(M_PI / 2);  // now 2 m to both sides of its centre
  EXPECT_NEAR(SightLines::freeWay({&turned}, {0, 0}, {40, 0}), 8, 1e-9);
}

TEST(SightLines, BlockedAgreesWithTheFreeWay) {
  const SightLines::Block near = block(0.4);
  for (double angle = -1; angle < 1; angle += 0.01) {
    const Eigen::Vector2d to(30 * std::cos(angle), 30 * std::sin(angle));
    const bool blocked = SightLines::freeWay({&near}, {0, 0}, to) < 30 - 1e-9;
    EXPECT_EQ(SightLines::blocked({&near}, {0, 0}, to), blocked) << angle;
  }
}

TEST(SightLines, BoardsAndContainersHideAndMeshIsToldApart) {
  WorldOptions options;
  options.length = 60;
  options.relief = 0;
  const Street street = Street::make(options);
  const auto world = [&](Kind kind) {
    ObjectBuilder builder(kind, Site{{10, 0, 0}, 0});
    if (kind == Kind::siteFence)
      builder.thicket({0, 0, 1}, {0.01, 3, 0.9}, materials::kMetal, 0.2);
    else
      builder.box({0, 0, 1.1}, {0.02, 3, 1.1}, materials::kWood);
    return World(options, street, Terrain(options, street, {}), {builder.build(1)}, {});
  };
  const auto blocked = [&](Kind kind, Obstacle obstacle) {
    const World here = world(kind);
    const SightLines lines(here, obstacle);
    return SightLines::blocked(lines.around({0, 0}, 40), {0, 0}, {20, 0});
  };
  for (const Kind kind : {Kind::house, Kind::wall, Kind::hoarding, Kind::container}) {
    EXPECT_TRUE(blocked(kind, Obstacle::opaque)) << name(kind);
    EXPECT_FALSE(blocked(kind, Obstacle::mesh)) << name(kind);
  }
  EXPECT_FALSE(blocked(Kind::siteFence, Obstacle::opaque));
  EXPECT_TRUE(blocked(Kind::siteFence, Obstacle::mesh));
  EXPECT_FALSE(blocked(Kind::car, Obstacle::opaque)) << "the model's rates hold what cars hide";
}

}  // namespace
}  // namespace polemcl::test_sight_lines
