#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <new>
#include <stdexcept>
#include <system_error>

#include <polemcl/core/common/Types.h>
#include "cli/CommandLine.h"
#include "cli/Failure.h"

namespace polemcl::test_failure {
namespace {

using namespace polemcl::apps;

const std::string kNoMemory =
    "there is not enough memory; end other programs, or raise its limit (ulimit -v)";

/// As a library that throws where nobody can catch it.
void endBy(const std::function<void()>& work) noexcept {
  endUncaughtInOneLine("/usr/bin/pole-test");
  work();
}

TEST(Failure, SaysWhatTheMachineLacks) {
  EXPECT_EQ(reasonOf(std::bad_alloc()), kNoMemory);
  EXPECT_EQ(reasonOf(Error("scan 3: std::bad_alloc")), "scan 3: " + kNoMemory);
  EXPECT_EQ(reasonOf(Error("no pole")), "no pole");
  const std::error_code again(EAGAIN, std::generic_category());
  EXPECT_EQ(reasonOf(std::system_error(again)),
            "no thread can be started: Resource temporarily unavailable");
  EXPECT_EQ(reasonOf(std::filesystem::filesystem_error("read", again)).find("thread"),
            std::string::npos);
}

TEST(Failure, WhatNobodyCanCatchEndsInOneLine) {
  EXPECT_EXIT(endBy([] { throw std::runtime_error("no thread"); }),
              testing::ExitedWithCode(exitFailed), "^pole-test: no thread\n$");
  EXPECT_EXIT(endBy([] { throw std::bad_alloc(); }), testing::ExitedWithCode(exitFailed),
              "^pole-test: there is not enough memory[^\n]*\n$");
  EXPECT_EXIT(endBy([] { throw 7; }), testing::ExitedWithCode(exitFailed),
              "^pole-test: failed for an unknown reason\n$");
}

TEST(Failure, OneLineIsEnough) {
  const auto twice = [] {
    sayFailure("pole-test", "the first");
    throw std::runtime_error("the second");
  };
  EXPECT_EXIT(endBy(twice), testing::ExitedWithCode(exitFailed), "^pole-test: the first\n$");
}

}  // namespace
}  // namespace polemcl::test_failure
