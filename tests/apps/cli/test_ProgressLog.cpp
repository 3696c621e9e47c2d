#include <gtest/gtest.h>

#include "cli/ProgressLog.h"

namespace polemcl::test_progress_log {

using namespace std::chrono_literals;
using polemcl::apps::ProgressLog;
using polemcl::apps::ProgressLogger;

namespace {

const ProgressLog::Time start{1000h};

}  // namespace

TEST(ProgressLog, WritesALineAtEachTenth) {
  ProgressLog log("batch", 40, 0, start);
  EXPECT_EQ(log.line(3, 0, start + 1s), "");
  EXPECT_EQ(log.line(4, 0, start + 2s), "batch: 4 of 40 tasks done (10 %), 0:00:02 so far");
  EXPECT_EQ(log.line(7, 0, start + 3s), "");
  // Tasks that failed have ended, too.
  EXPECT_EQ(log.line(7, 2, start + 4s),
            "batch: 7 of 40 tasks done (17 %), 2 failed, 0:00:04 so far");
  EXPECT_EQ(log.line(38, 2, start + 3723s),
            "batch: 38 of 40 tasks done (95 %), 2 failed, 1:02:03 so far");
}

TEST(ProgressLog, WritesALineAfterHalfAMinuteWithoutOne) {
  ProgressLog log("batch", 351, 0, start);
  EXPECT_EQ(log.due(), start + 30s);
  EXPECT_EQ(log.line(1, 0, start + 29s), "");
  EXPECT_EQ(log.line(1, 0, start + 30s), "batch: 1 of 351 tasks done (0 %), 0:00:30 so far");
  EXPECT_EQ(log.line(1, 0, start + 59s), "");
  EXPECT_EQ(log.due(), start + 60s);
  EXPECT_EQ(log.line(1, 0, start + 61s), "batch: 1 of 351 tasks done (0 %), 0:01:01 so far");
}

TEST(ProgressLog, WhatWasDoneBeforeIsNoNews) {
  ProgressLog log("batch", 10, 5, start);
  EXPECT_EQ(log.line(5, 0, start + 1s), "");
  EXPECT_EQ(log.line(6, 0, start + 1s), "batch: 6 of 10 tasks done (60 %), 0:00:01 so far");
}

TEST(ProgressLog, ReachesStandardErrorWhereNoTerminalIs) {
  testing::internal::CaptureStderr();
  {
    ProgressLogger log("batch", 2, 0, false), quiet("hush", 2, 0, true);
    log.update(1, 0);
    log.update(1, 1);
    quiet.update(2, 0);
  }
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(said,
            "batch: 1 of 2 tasks done (50 %), 0:00:00 so far\n"
            "batch: 1 of 2 tasks done (50 %), 1 failed, 0:00:00 so far\n");
}

}  // namespace polemcl::test_progress_log
