#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>

#include <polemcl/core/common/Types.h>
#include "cli/CommandLine.h"
#include "cli/Messages.h"
#include "support/Shell.h"

// What programs write on a terminal, elsewhere, with `--quiet` and with `--verbose`.

namespace polemcl::test_messages {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

const std::string bin = POLEMCL_BIN_DIR;
const std::string red = "\033[31m", green = "\033[32m", end = "\033[0m";

const std::string failing = bin + "/pole-map convert missing.polemap --output none.csv";

/// A short simulated drive of poles in a new folder.
std::string simulation(const TempFolder& folder, const std::string& more = "") {
  return bin + "/pole-simulate --config demo.ini --length 30 --sensor vlp16 --poles " +
         (folder / "poles.rawlog").string() + " " + more;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Messages, WhatControlsATerminalBecomesQuestionMarks) {
  EXPECT_EQ(printable("a\033[31m\r\x7f\xc2\x9b b\u202e\u2066\u200f c"), "a?[31m??? b??? c");
  EXPECT_EQ(printable("ü – \u2030 \xff\tx\n"), "ü – \u2030 ?\tx\n");
  std::ostringstream text;
  {
    std::ostream out(text.rdbuf());
    const PrintableOutput clean(out);
    out << "a\xc2"
        << "\x9b" << 7 << "\xc3"
        << "\xbc\n"
        << "end\033";
    EXPECT_EQ(text.str(), "a?7ü\n");
  }
  EXPECT_EQ(text.str(), "a?7ü\nend?");
}

TEST(Messages, TextOfAFileDoesNotControlATerminal) {
  if (!terminalsExist()) GTEST_SKIP() << "no pseudo terminal: is /dev/pts mounted?";
  const TempFolder folder;
  writeText(folder / "e.csv", "lon,lat,kind\n8,50,\033]0;x\n8.0001,50,lamp\n");
  const Outcome shown =
      onTerminal(bin + "/pole-map import --input " + (folder / "e.csv").string() + " --output " +
                 (folder / "o.polemap").string() + " --keep kind=lamp --keep kind=tree");
  EXPECT_TRUE(has(shown.out + shown.err, "?]0;x")) << shown.out << shown.err;
  EXPECT_FALSE(has(shown.out + shown.err, "\033]0;x"));
}

TEST(Messages, ErrorsAreRedOnATerminalOnly) {
  if (!terminalsExist()) GTEST_SKIP() << "no pseudo terminal: is /dev/pts mounted?";
  const Outcome shown = onTerminal("env -u NO_COLOR TERM=xterm " + failing);
  EXPECT_EQ(shown.code, 1);
  EXPECT_EQ(shown.out.rfind("pole-map: " + red + "cannot read missing.polemap", 0), 0u)
      << shown.out;
  EXPECT_TRUE(has(shown.out, end)) << shown.out;
  for (const std::string environment : {"NO_COLOR=1 TERM=xterm", "-u NO_COLOR TERM=dumb"}) {
    const Outcome plain = onTerminal("env " + environment + " " + failing);
    EXPECT_EQ(plain.out.rfind("pole-map: cannot read missing.polemap", 0), 0u)
        << environment << plain.out;
    EXPECT_FALSE(has(plain.out, "\033")) << environment << plain.out;
  }
  EXPECT_FALSE(has(shell("env -u NO_COLOR TERM=xterm " + failing).out, "\033"));
}

TEST(Messages, WhatCannotBePrintedIsAFailure) {
  for (const std::string command :
       {"pole-map --help", "pole-localize --config demo.ini --print-config"}) {
    const Outcome outcome = shell(bin + "/" + command + " >/dev/full");
    EXPECT_EQ(outcome.code, 1) << command;
    EXPECT_TRUE(has(outcome.out, "cannot write to standard output")) << outcome.out;
  }
}

TEST(Messages, ABarIsForTerminals) {
  if (!terminalsExist()) GTEST_SKIP() << "no pseudo terminal: is /dev/pts mounted?";
  const TempFolder folder;
  const Outcome shown = onTerminal("env -u NO_COLOR TERM=xterm " + simulation(folder));
  EXPECT_EQ(shown.code, 0) << shown.out;
  EXPECT_TRUE(has(shown.out, "\rsimulate [" + green)) << shown.out;
  EXPECT_TRUE(has(shown.out, "\r\033[K")) << "the bar is taken off the screen";
  const Outcome plain = onTerminal("env NO_COLOR=1 TERM=xterm " + simulation(folder));
  EXPECT_TRUE(has(plain.out, "\rsimulate [")) << plain.out;
  EXPECT_FALSE(has(plain.out, green)) << plain.out;
  EXPECT_EQ(onTerminal(simulation(folder, "--quiet")).out, "");
  EXPECT_FALSE(has(shell(simulation(folder)).out, "simulate [")) << "without a terminal";
}

TEST(Messages, VerboseSaysBuildSettingsAndTime) {
  const TempFolder folder;
  const Outcome shown = shell(simulation(folder, "--verbose --threads 1"));
  EXPECT_EQ(shown.code, 0) << shown.out;
  for (const std::string text :
       {"pole-simulate: pole-simulate 1.", "pole-simulate: threads: at most 1\n",
        "pole-simulate: settings: ", "share/polemcl/config/demo.ini\n", "pole-simulate: took ",
        " MB of memory\n"})
    EXPECT_TRUE(has(shown.out, text)) << text << " is not in: " << shown.out;
  EXPECT_FALSE(has(shell(simulation(folder)).out, "took "));
  EXPECT_EQ(shell(simulation(folder, "--quiet --verbose")).code, 2);
}

TEST(Messages, WarningsNameTheProgram) {
  EXPECT_TRUE(has(warningLine("pole-map", "old"), "pole-map: ")) << "of a test, perhaps in colour";
  EXPECT_TRUE(has(warningLine("pole-map", "old"), "warning:"));
}

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

}  // namespace polemcl::test_messages
