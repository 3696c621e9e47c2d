#include <gtest/gtest.h>

#include "cli/Progress.h"

namespace polemcl::test_progress {

using polemcl::apps::Progress;
using polemcl::apps::progressLine;

TEST(Progress, ShowsShareRateAndTimeLeft) {
  // 25 of 100 in 2 s: 12.5 a second, 75 more take 6 s.
  EXPECT_EQ(progressLine("extract", 25, 100, 2.0),
            "extract [#####---------------] 25/100  12.5/s  0:06 left");
  // 1 of 1001 in 0.1 s: 1000 more take 100 s.
  EXPECT_EQ(progressLine("map", 1, 1001, 0.1),
            "map [--------------------] 1/1001  10.0/s  1:40 left");
}

TEST(Progress, LeavesOutWhatIsNotKnown) {
  EXPECT_EQ(progressLine("read", 50, 0, 10.0), "read 50  5.0/s");
  EXPECT_EQ(progressLine("read", 0, 10, 3.0), "read [--------------------] 0/10");
  EXPECT_EQ(progressLine("read", 10, 10, 5.0), "read [####################] 10/10  2.0/s");
}

TEST(Progress, IsSilentWithoutATerminal) {
  testing::internal::CaptureStderr();
  {
    Progress progress("extract", 10, false);
    for (std::size_t i = 1; i <= 10; ++i) progress.update(i);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace polemcl::test_progress
