#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/common/PrincipalAxes.h"

namespace polemcl::test_principal_axes {
namespace {

Eigen::Matrix2d matrix(double xx, double xy, double yx, double yy) {
  Eigen::Matrix2d m;
  m << xx, xy, yx, yy;
  return m;
}

TEST(PrincipalAxes, GiveTheMatrixBack) {
  for (double angle : {0.0, 0.3, 1.2, M_PI / 2, 2.5}) {
    const double c = std::cos(angle), s = std::sin(angle);
    const Eigen::Matrix2d m = matrix(4 * c * c + s * s, 3 * c * s, 3 * c * s, 4 * s * s + c * c);
    const auto axes = principalAxes(m);
    ASSERT_TRUE(axes.has_value());
    EXPECT_NEAR(axes->first, 4, 1e-12);
    EXPECT_NEAR(axes->second, 1, 1e-12);
    EXPECT_NEAR(std::abs(axes->x * c + axes->y * s), 1, 1e-12);
  }
}

TEST(PrincipalAxes, FlatAndZeroMatricesHaveAxes) {
  EXPECT_EQ(principalAxes(matrix(0, 0, 0, 0))->first, 0);
  const auto flat = principalAxes(matrix(1, 1, 1, 1));
  EXPECT_NEAR(flat->first, 2, 1e-15);
  EXPECT_NEAR(flat->second, 0, 1e-15);
  EXPECT_NEAR(flat->x, std::sqrt(0.5), 1e-15);
}

TEST(PrincipalAxes, RefuseWhatIsNoCovariance) {
  EXPECT_FALSE(principalAxes(matrix(1, 2, 2, 1)));
  EXPECT_FALSE(principalAxes(matrix(-1, 0, 0, -1)));
  EXPECT_FALSE(principalAxes(matrix(1, 0.1, 0, 1)));
  EXPECT_FALSE(principalAxes(matrix(1, 0, std::nan(""), 1)));
  EXPECT_FALSE(principalAxes(matrix(std::numeric_limits<double>::infinity(), 0, 0, 1)));
}

}  // namespace
}  // namespace polemcl::test_principal_axes
