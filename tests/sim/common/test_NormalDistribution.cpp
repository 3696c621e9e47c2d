#include <gtest/gtest.h>

#include <cmath>

#include "sim/common/NormalDistribution.h"
#include "sim/common/Random.h"

namespace polemcl::test_normal_distribution {

using namespace polemcl::sim;

TEST(NormalDistribution, AgreesWithTables) {
  EXPECT_NEAR(normalCdf(0), 0.5, 1e-15);
  EXPECT_NEAR(normalCdf(1.959963985), 0.975, 1e-9);
  EXPECT_NEAR(normalQuantile(0.975), 1.959963985, 1e-8);
  EXPECT_NEAR(normalQuantile(0.001), -3.090232306, 1e-8);
  EXPECT_NEAR(normalQuantile(0.5), 0, 1e-9);
  EXPECT_TRUE(std::isfinite(normalQuantile(0)) && std::isfinite(normalQuantile(1)));
}

TEST(NormalDistribution, QuantileIsTheInverse) {
  for (double x = -4; x <= 4; x += 0.05) EXPECT_NEAR(normalQuantile(normalCdf(x)), x, 1e-6);
}

TEST(NormalDistribution, OfTwoAgreesWithClosedFormsAndWithCounting) {
  for (const double r : {-0.8, -0.3, 0.0, 0.5, 0.95})
    EXPECT_NEAR(bivariateNormalCdf(0, 0, r), 0.25 + std::asin(r) / (2 * M_PI), 1e-7);
  EXPECT_NEAR(bivariateNormalCdf(0.4, -1.1, 0), normalCdf(0.4) * normalCdf(-1.1), 1e-12);
  Random random(1);
  double both = 0;
  constexpr int kDraws = 200000;
  for (int i = 0; i < kDraws; ++i) {
    const double a = random.normal(), b = 0.6 * a + 0.8 * random.normal();
    both += a < 0.7 && b < -0.2;
  }
  EXPECT_NEAR(bivariateNormalCdf(0.7, -0.2, 0.6), both / kDraws, 0.004);
}

TEST(NormalDistribution, FromHashesHasItsMomentsAndTails) {
  double sum = 0, square = 0, tail = 0;
  constexpr int kDraws = 200000;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const double z = normalFromHash(hash(i));
    sum += z;
    square += z * z;
    tail += z > 2;
  }
  EXPECT_NEAR(sum / kDraws, 0, 0.01);
  EXPECT_NEAR(square / kDraws, 1, 0.01);
  EXPECT_NEAR(tail / kDraws, 0.02275, 0.0015);
}

}  // namespace polemcl::test_normal_distribution
