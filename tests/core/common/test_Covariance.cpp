#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/common/Covariance.h"

namespace polemcl::test_covariance {

Eigen::Matrix2d matrix(double xx, double xy, double yx, double yy) {
  return (Eigen::Matrix2d() << xx, xy, yx, yy).finished();
}

TEST(Covariance, AcceptsSemidefiniteMatrices) {
  for (const Eigen::Matrix2d& good : {matrix(0, 0, 0, 0), matrix(1, 1, 1, 1), matrix(0, 0, 0, 2)}) {
    EXPECT_TRUE(isCovariance(good)) << good;
    EXPECT_FALSE(isDefiniteCovariance(good)) << good;
  }
  EXPECT_TRUE(isDefiniteCovariance(matrix(2, 1, 1, 2)));
}

TEST(Covariance, AcceptsRoundingInProportionToTheMatrix) {
  for (const double scale : {1e-8, 1.0, 1e6}) {
    const auto m = [&](double yx, double yy) -> Eigen::Matrix2d {
      return scale * matrix(1, 0, yx, yy);
    };
    EXPECT_TRUE(isCovariance(m(5e-10, 1)));
    EXPECT_TRUE(isCovariance(m(0, -5e-10)));
    EXPECT_FALSE(isCovariance(m(2e-9, 1)));
    EXPECT_FALSE(isCovariance(m(0, -2e-9)));
  }
}

TEST(Covariance, RefusesOtherMatrices) {
  for (const Eigen::Matrix2d& bad : {matrix(1, 2, 2, 1), matrix(-1, 0, 0, -1), matrix(1, 0.1, 0, 1),
                                     matrix(1, 0, NAN, 1), matrix(INFINITY, 0, 0, 1)})
    EXPECT_FALSE(isCovariance(bad)) << bad;
  Eigen::Matrix3d indefinite = Eigen::Matrix3d::Identity();
  indefinite(0, 2) = indefinite(2, 0) = 1.1;
  EXPECT_FALSE(isCovariance(indefinite));
}

TEST(Covariance, LargestSigmaIsThatOfTheLongAxis) {
  EXPECT_NEAR(largestSigma(matrix(9, 0, 0, 4)), 3, 1e-12);
  EXPECT_NEAR(largestSigma(matrix(5, 4, 4, 5)), 3, 1e-12);
  EXPECT_EQ(largestSigma(matrix(0, 0, 0, 0)), 0);
  EXPECT_EQ(largestSigma(matrix(NAN, 0, 0, 1)), INFINITY);
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

}  // namespace polemcl::test_covariance
