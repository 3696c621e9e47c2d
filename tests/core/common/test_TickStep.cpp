#include <gtest/gtest.h>

#include <cmath>

#include <polemcl/core/common/Types.h>
#include "core/common/TickStep.h"

namespace polemcl::test_tick_step {

TEST(TickStep, StepsAreOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_DOUBLE_EQ(tickStep(10, 10), 1);
  EXPECT_DOUBLE_EQ(tickStep(11, 10), 2);
  EXPECT_DOUBLE_EQ(tickStep(41, 10), 5);
  EXPECT_DOUBLE_EQ(tickStep(51, 10), 10);
  EXPECT_DOUBLE_EQ(tickStep(0.03, 3), 0.01);
}

TEST(TickStep, NeverMoreStepsThanAllowed) {
  for (double span = 1e-4; span < 1e5; span *= 1.37)
    for (int most = 1; most < 15; ++most) {
      const double step = tickStep(span, most);
      EXPECT_LE(span / step, most * (1 + 1e-9)) << span << " in " << most;
      EXPECT_GE(span / step, most / 2.5 * (1 - 1e-9)) << span << " in " << most;
    }
}

TEST(TickStep, RefusesAnEmptyOrEndlessRange) {
  EXPECT_THROW(tickStep(0, 5), Error);
  EXPECT_THROW(tickStep(-1, 5), Error);
  EXPECT_THROW(tickStep(HUGE_VAL, 5), Error);
  EXPECT_THROW(tickStep(1, 0), Error);
}

}  // namespace polemcl::test_tick_step
