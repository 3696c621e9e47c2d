#include <gtest/gtest.h>

#include <cmath>

#include "core/common/Transform.h"

namespace polemcl::test_transform {

TEST(Transform, MovesCentreAndCovariance) {
  PoleDetection pole;
  pole.x = 2;
  pole.top = 3;
  pole.covariance << 0.04, 0.01, 0.01, 0.09;
  const PoleDetection result = moved({10, 20, M_PI / 2}, pole);
  EXPECT_NEAR(result.x, 10, 1e-12);
  EXPECT_NEAR(result.y, 22, 1e-12);
  // A quarter turn swaps the variances and changes the sign of the cross term.
  EXPECT_NEAR(result.covariance(0, 0), 0.09, 1e-12);
  EXPECT_NEAR(result.covariance(1, 1), 0.04, 1e-12);
  EXPECT_NEAR(result.covariance(0, 1), -0.01, 1e-12);
  EXPECT_EQ(result.covariance(0, 1), result.covariance(1, 0));
  EXPECT_EQ(result.top, 3);
}

TEST(Transform, BothMovesAgree) {
  PoleDetection pole;
  pole.x = 7;
  pole.y = -3;
  pole.covariance << 0.04, 0.01, 0.01, 0.09;
  const Pose2D base{100, -50, 2.5};
  const PoleDetection whole = moved(base, pole);
  const MovedCentre part = movedCentre(base, pole);
  EXPECT_NEAR(part.centre.x(), whole.x, 1e-12);
  EXPECT_NEAR(part.centre.y(), whole.y, 1e-12);
  EXPECT_NEAR((part.covariance - whole.covariance).norm(), 0, 1e-15);
  EXPECT_NEAR((part.centre - part.arm - Eigen::Vector2d(base.x, base.y)).norm(), 0, 1e-12);
}

}  // namespace polemcl::test_transform
