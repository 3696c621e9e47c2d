#include <gtest/gtest.h>

#include <cmath>

#include "core/common/Statistics.h"

namespace polemcl::test_statistics {

TEST(Statistics, QuantilesLieBetweenRanks) {
  EXPECT_FALSE(quantile({}, 0.5));
  EXPECT_DOUBLE_EQ(*quantile({3}, 0.9), 3);
  EXPECT_DOUBLE_EQ(*quantile({4, 1, 3, 2}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(*quantile({4, 1, 3, 2, 5}, 0.9), 4.6);
  EXPECT_DOUBLE_EQ(*quantile({4, 1}, 1), 4);
}

TEST(Statistics, NearestRankIsOneOfTheValues) {
  EXPECT_EQ(nearestRank({4, 1, 3, 2, 5}, 0.1), 1);
  EXPECT_EQ(nearestRank({4, 1, 3, 2, 5}, 0.7), 4);
  EXPECT_EQ(nearestRank({7}, 0.9), 7);
  std::vector<float> values{5, 1, 4};
  EXPECT_EQ(elementOfRank(values, 1), 4);
}

TEST(Statistics, NormalQuantilesAreThoseOfTheTables) {
  EXPECT_NEAR(normalQuantile(0.5), 0, 1e-12);
  EXPECT_NEAR(normalQuantile(0.95), 1.6448536269514722, 2e-9);
  EXPECT_NEAR(normalQuantile(0.99), 2.3263478740408408, 3e-9);
  EXPECT_NEAR(normalQuantile(0.025), -1.9599639845400545, 3e-9);
  EXPECT_EQ(normalQuantile(0), normalQuantile(1e-9));
  for (double x = -4; x <= 4; x += 0.05)
    EXPECT_NEAR(normalQuantile(0.5 * std::erfc(-x * M_SQRT1_2)), x, 1e-6);
}

}  // namespace polemcl::test_statistics
