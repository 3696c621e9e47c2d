#include <gtest/gtest.h>

#include <polemcl/core/common/Types.h>
#include "io/file/Process.h"
#include "support/Refusal.h"

namespace polemcl::io::test_process {
namespace {
std::string messageOfShell(const std::string& script) {
  return tests::messageOf([&] { runFilter({"/bin/sh", "-c", script}, ""); });
}

TEST(Process, AFilterTakesAndGivesAnyBytes) {
  std::string bytes(3'000'000, '\0');  // more than a pipe holds
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * i);
  EXPECT_EQ(runFilter({"/bin/cat"}, bytes), bytes);
  EXPECT_EQ(runFilter({"/bin/cat"}, ""), "");
}

TEST(Process, WhatAFilterSaysAsideIsNotItsResult) {
  EXPECT_EQ(runFilter({"/bin/sh", "-c", "echo warning >&2; echo result"}, ""), "result\n");
}

TEST(Process, AFailureIsToldByItsLastLine) {
  EXPECT_EQ(messageOfShell("echo half; echo Traceback >&2; echo 'no scan in it' >&2; exit 1"),
            "no scan in it");
  EXPECT_EQ(messageOfShell("echo half; exit 3"), "sh ended with exit code 3");
  EXPECT_EQ(messageOfShell("kill -9 $$").rfind("sh was ended by signal 9", 0), 0u);
  EXPECT_EQ(tests::messageOf([] {
              runFilter({"/not/there"}, "");
            }).rfind("/not/there: cannot be started", 0),
            0u);
}

TEST(Process, AScriptThatIsNotInstalledIsNamed) {
  EXPECT_HAS(tests::messageOf([] { pythonScript("none.py"); }), "report/none.py");
}

}  // namespace
}  // namespace polemcl::io::test_process
