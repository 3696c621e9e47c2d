#include <gtest/gtest.h>

#include <cmath>

#include "sim/world/Season.h"

namespace polemcl::test_season {

using namespace polemcl::sim;

TEST(Season, WinterIsBareAndWhiteAndSummerGreen) {
  EXPECT_EQ(seasonOf(15).foliage, 0);
  EXPECT_EQ(seasonOf(15).snow, 1);
  EXPECT_EQ(seasonOf(196).foliage, 1);
  EXPECT_EQ(seasonOf(196).snow, 0);
  EXPECT_NEAR(seasonOf(120).foliage, 0.5, 1e-12) << "the end of April";
  EXPECT_NEAR(seasonOf(345).snow, 0.5, 1e-12) << "mid December";
}

TEST(Season, YearsFollowOneAnotherWithoutJumps) {
  for (int day = -400; day < 800; ++day) {
    const Season today = seasonOf(day), tomorrow = seasonOf(day + 1);
    EXPECT_LE(std::abs(tomorrow.foliage - today.foliage), 0.05) << day;
    EXPECT_LE(std::abs(tomorrow.snow - today.snow), 0.06) << day;
    EXPECT_EQ(seasonOf(day + 365).snow, today.snow) << day;
    EXPECT_GE(today.foliage, 0);
    EXPECT_LE(today.foliage, 1);
    EXPECT_FALSE(today.snow > 0 && today.foliage > 0) << "no snow on green trees, day " << day;
  }
}

}  // namespace polemcl::test_season
