#include <gtest/gtest.h>

#include <cmath>

#include <polemcl/core/sensor/SensorOptions.h>

namespace polemcl::test_scan_timing {

TEST(ScanTiming, ClockwiseFromTheBackStampedForwards) {
  const ScanTiming timing{Turn::clockwise, 0.1, M_PI, 0.5};
  EXPECT_NEAR(timing.offset(0), 0, 1e-15);
  EXPECT_NEAR(timing.offset(M_PI / 2), -0.025, 1e-15) << "the left comes before the front";
  EXPECT_NEAR(timing.offset(-M_PI / 2), 0.025, 1e-15);
  EXPECT_NEAR(timing.offset(M_PI - 1e-6), -0.05, 1e-6);
  EXPECT_NEAR(timing.offset(-M_PI + 1e-6), 0.05, 1e-6);
  EXPECT_NEAR(timing.offset(5 * M_PI / 2), -0.025, 1e-15) << "any number of turns";
}

TEST(ScanTiming, CounterclockwiseFromTheFrontStampedAtTheBegin) {
  const ScanTiming timing{Turn::counterclockwise, 0.05, 0, 0};
  EXPECT_NEAR(timing.offset(0.001), 0.05 * 0.001 / (2 * M_PI), 1e-15);
  EXPECT_NEAR(timing.offset(M_PI), 0.025, 1e-15);
  EXPECT_NEAR(timing.offset(-0.001), 0.05, 1e-5);
}

TEST(ScanTiming, CompensatedAndUnknownScansHaveNoOffsets) {
  for (const Turn turn : {Turn::automatic, Turn::compensated}) {
    const ScanTiming timing{turn};
    EXPECT_FALSE(timing.known());
    EXPECT_EQ(timing.offset(1), 0);
  }
}

TEST(ScanTiming, AnotherClockShiftsAllScans) {
  EXPECT_NEAR((ScanTiming{Turn::clockwise, 0.1, M_PI, 0.5, 0.08}.offset(0)), 0.08, 1e-15);
  EXPECT_EQ((ScanTiming{Turn::compensated, 0.1, M_PI, 0.5, 0.08}.offset(2)), 0.08);
}

}  // namespace polemcl::test_scan_timing
