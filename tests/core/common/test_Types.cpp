#include <gtest/gtest.h>

#include <cmath>

#include <polemcl/core/common/Types.h>

namespace polemcl::test_types {

TEST(Types, WrapAngleKeepsPiAndLeavesMinusPiOut) {
  EXPECT_DOUBLE_EQ(wrapAngle(M_PI), M_PI);
  EXPECT_DOUBLE_EQ(wrapAngle(-M_PI), M_PI);
  EXPECT_NEAR(wrapAngle(3 * M_PI / 2), -M_PI / 2, 1e-15);
  EXPECT_NEAR(wrapAngle(-7.0), -7.0 + 2 * M_PI, 1e-15);
}

TEST(Types, ComposeByHand) {
  const Pose2D p = compose({1, 2, M_PI / 2}, {3, 0.5, M_PI / 4});
  EXPECT_NEAR(p.x, 0.5, 1e-15);
  EXPECT_NEAR(p.y, 5, 1e-15);
  EXPECT_NEAR(p.yaw, 3 * M_PI / 4, 1e-15);
}

TEST(Types, RelativeUndoesCompose) {
  const Pose2D a{4, -3, 2.5}, step{0.3, -0.7, 1.9};
  const Pose2D back = relative(a, compose(a, step));
  EXPECT_NEAR(back.x, step.x, 1e-14);
  EXPECT_NEAR(back.y, step.y, 1e-14);
  EXPECT_NEAR(back.yaw, step.yaw, 1e-14);
}

}  // namespace polemcl::test_types
