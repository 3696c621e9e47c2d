#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>

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

TEST(Progress, WritesLinesNowAndThenWithoutATerminal) {
  EXPECT_EQ(progressLine("extract", 25, 100, 2.0, 0), "extract 25/100 (25 %)  12.5/s  0:06 left");
  EXPECT_EQ(progressLine("read", 50, 0, 10.0, 0), "read 50  5.0/s");
  testing::internal::CaptureStderr();
  {
    Progress seldom("extract", 10, false), always("map", 10, false, std::chrono::seconds(0)),
        quiet("hush", 10, true, std::chrono::seconds(0));
    for (std::size_t i = 1; i <= 10; ++i)
      for (Progress* each : {&seldom, &always, &quiet}) each->update(i);
  }
  const std::string lines = testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 10) << lines;
  EXPECT_EQ(lines.rfind("map 1/10 (10 %)", 0), 0u) << lines;
  EXPECT_EQ(lines.find_first_of("[#\r\033"), std::string::npos) << lines;
}

}  // namespace polemcl::test_progress
