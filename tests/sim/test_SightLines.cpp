#include <gtest/gtest.h>
#include <polemcl/sim/SightLines.h>

#include <cmath>

using namespace polemcl;
using namespace polemcl::sim;

namespace {

/// A block 4 m wide and 2 m deep at (10, 0), turned by an angle.
SightLines::Block block(double turn) {
  SightLines::Block block;
  block.centre = {10, 0};
  block.half = {1, 2};
  block.axes << std::cos(turn), std::sin(turn), -std::sin(turn), std::cos(turn);
  block.reach = std::sqrt(5);
  return block;
}

}  // namespace

TEST(SightLines, theFreeWayEndsAtTheFirstBlock) {
  const SightLines::Block near = block(0);
  SightLines::Block far = near;
  far.centre.x() = 20;
  EXPECT_NEAR(SightLines::freeWay({&far, &near}, {0, 0}, {40, 0}), 9, 1e-12);
  EXPECT_NEAR(SightLines::freeWay({&far, &near}, {0, 0}, {0, 40}), 40, 1e-12);
  EXPECT_NEAR(SightLines::freeWay({&near}, {0, 0}, {8, 0}), 8, 1e-12) << "it stands behind";
  EXPECT_NEAR(SightLines::freeWay({&near}, {0, 1}, {40, 1}), 9, 1e-12);
  EXPECT_NEAR(SightLines::freeWay({}, {3, 4}, {0, 0}), 5, 1e-12);
}

TEST(SightLines, ofATurnedBlockItIsItsNearSide) {
  const SightLines::Block turned = block(M_PI / 2);  // now 2 m deep to both sides of its centre
  EXPECT_NEAR(SightLines::freeWay({&turned}, {0, 0}, {40, 0}), 8, 1e-9);
}

TEST(SightLines, blockedAgreesWithTheFreeWay) {
  const SightLines::Block near = block(0.4);
  for (double angle = -1; angle < 1; angle += 0.01) {
    const Eigen::Vector2d to(30 * std::cos(angle), 30 * std::sin(angle));
    const bool blocked = SightLines::freeWay({&near}, {0, 0}, to) < 30 - 1e-9;
    EXPECT_EQ(SightLines::blocked({&near}, {0, 0}, to), blocked) << angle;
  }
}
