#include <gtest/gtest.h>

#include <thread>

#include "localize/Pace.h"

namespace polemcl::test_pace {
namespace {

using polemcl::apps::Pace;

double seconds(ScanClock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

TEST(Pace, ScansAreDueAsFarApartAsTheirTimesByTheRate) {
  Pace pace(100.0);
  const auto first = pace.waitFor(50);
  const auto second = pace.waitFor(50.8);
  EXPECT_NEAR(seconds(second - first), 0.008, 1e-9);
  EXPECT_GE(ScanClock::now(), second);
  EXPECT_NEAR(seconds(pace.waitFor(51.0) - first), 0.010, 1e-9);
  // A gap is cut short, and a time that goes back waits for nothing.
  EXPECT_NEAR(seconds(pace.waitFor(5000) - first), 0.030, 1e-9);
  EXPECT_NEAR(seconds(pace.waitFor(10) - first), 0.030, 1e-9);
}

TEST(Pace, TheClockGoesOnWhileTheWorkIsSlow) {
  Pace pace(1000.0);
  const auto first = pace.waitFor(0);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_NEAR(seconds(pace.waitFor(1) - first), 0.001, 1e-9);  // late, and says so
  EXPECT_NEAR(seconds(pace.waitFor(2) - first), 0.002, 1e-9);
}

TEST(Pace, StartsAgainWithoutTheTimeInBetween) {
  Pace pace(1.0);
  const auto first = pace.dueOf(10);  // does not wait
  EXPECT_NEAR(seconds(pace.dueOf(11.5) - first), 1.5, 1e-9);
  pace.restart();
  const auto again = pace.dueOf(60);
  EXPECT_LE(again, ScanClock::now());
  EXPECT_GE(again, first);
  EXPECT_NEAR(seconds(pace.dueOf(60.5) - again), 0.5, 1e-9);
}

TEST(Pace, WithoutARateNothingWaits) {
  Pace pace(std::nullopt);
  const auto begin = ScanClock::now();
  for (const double time : {0.0, 1e6, 2e6}) {
    const auto due = pace.waitFor(time);
    EXPECT_GE(due, begin);
    EXPECT_LE(due, ScanClock::now());
  }
}

TEST(Pace, EndsWhenTheWindowIsClosed) {
  int asked = 0;
  Pace pace(1e-6, [&] { return ++asked < 4; });  // a second would last for days
  const auto begin = ScanClock::now();
  pace.waitFor(0);
  const auto due = pace.waitFor(1);
  EXPECT_LE(due, ScanClock::now());
  EXPECT_GE(due, begin);
  EXPECT_EQ(asked, 4);
}

}  // namespace
}  // namespace polemcl::test_pace
