#include <gtest/gtest.h>
#include <mrpt/core/exceptions.h>
#include <tbb/global_control.h>

#include <regex>
#include <string>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "cli/CommandLine.h"
#include "cli/Version.h"
#include "support/TempFolder.h"

namespace polemcl::test_command_line {
namespace {

using namespace polemcl::apps;

struct Result {
  int code = -1;
  std::string out, err;
  double radius = 1.0;
  bool quiet = false, worked = false;
};

/// A program with one required and one optional argument, whose work is `body`.
Result runWith(
    std::vector<const char*> arguments, const std::function<void()>& body = [] {}) {
  Result result;
  CommandLine line("pole-test", "Tries things.");
  std::string input;
  line.cli().add_option("--input", input, "A file")->required();
  line.cli().add_option("--radius", result.radius, "Metres");
  arguments.insert(arguments.begin(), "pole-test");
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  result.code = line.run(static_cast<int>(arguments.size()), arguments.data(), [&] {
    result.worked = true;
    result.quiet = line.quiet();
    body();
  });
  result.out = testing::internal::GetCapturedStdout();
  result.err = testing::internal::GetCapturedStderr();
  return result;
}

TEST(CommandLine, RunsTheWorkAndReturnsZero) {
  const auto result = runWith({"--input", "a", "--radius", "2.5"});
  EXPECT_EQ(result.code, 0);
  EXPECT_TRUE(result.worked);
  EXPECT_FALSE(result.quiet);
  EXPECT_EQ(result.radius, 2.5);
  EXPECT_EQ(result.out + result.err, "");
}

TEST(CommandLine, KnowsQuiet) {
  EXPECT_TRUE(runWith({"--input", "a", "--quiet"}).quiet);
}

TEST(CommandLine, LimitsTheThreads) {
  using tbb::global_control;
  const auto allowed = [] {
    return global_control::active_value(global_control::max_allowed_parallelism);
  };
  std::size_t threads = 0;
  runWith({"--input", "a", "--threads", "1"}, [&] { threads = allowed(); });
  EXPECT_EQ(threads, 1u);
  const std::size_t all = allowed();
  runWith({"--input", "a"}, [&] { threads = allowed(); });
  EXPECT_EQ(threads, all);
}

TEST(CommandLine, AssignmentsMayBeRepeated) {
  CommandLine line("pole-test", "Tries things.");
  std::vector<std::string> set;
  addSetOption(line.cli(), set);
  const char* arguments[] = {"pole-test", "--set", "a.b=1", "--set", "a.c=x y"};
  EXPECT_EQ(line.run(5, arguments, [] {}), 0);
  EXPECT_EQ(set, (std::vector<std::string>{"a.b=1", "a.c=x y"}));
}

TEST(CommandLine, HelpAndVersionAreNoErrors) {
  const auto help = runWith({"--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_FALSE(help.worked);
  EXPECT_NE(help.out.find("Tries things."), std::string::npos);
  EXPECT_NE(help.out.find("--radius"), std::string::npos);
  const auto shown = runWith({"--version"});
  EXPECT_EQ(shown.code, 0);
  EXPECT_FALSE(shown.worked);
  EXPECT_EQ(shown.out,
            std::string("pole-test ") + version() + " (build " + buildIdentity() + ")\n");
  EXPECT_TRUE(std::regex_match(
      buildIdentity(),
      std::regex("([0-9a-f]{12}(\\+[0-9a-f]{12})?|sources-[0-9a-f]{12}), [A-Za-z]+ [0-9.]+, "
                 "[A-Za-z]+, .*-ffp-contract=off.*")))
      << buildIdentity();
}

TEST(CommandLine, RefusesInOneLine) {
  const std::string hint = "\nTry `pole-test --help`.\n";
  const auto fine = [] {};
  const struct {
    std::vector<const char*> arguments;
    std::function<void()> work;
    int code;
    std::string named;
  } refusals[] = {
      {{}, fine, 2, "--input is required"},
      {{"--input"}, fine, 2, "--input"},
      {{"--input", "a", "--raduis", "1"}, fine, 2, "--raduis"},
      {{"--input", "a", "--radius", "x"}, fine, 2, "--radius = x"},
      {{"--input", "a", "--threads", "-1"}, fine, 2, "--threads"},
      {{"--input", "a", "one", "--two"}, fine, 2, "not expected: one --two"},
      {{"--input", "a"}, [] { throw polemcl::Error("a.rawlog: no file"); }, 1, "a.rawlog: no file"},
      // MRPT's errors lose their call stack.
      {{"--input", "a"}, [] { THROW_EXCEPTION("the cloud\n is   gone"); }, 1, "the cloud is gone"},
      {{"--input", "a"}, [] { throw 7; }, 1, "failed for an unknown reason"},
  };
  for (const auto& [arguments, work, code, named] : refusals) {
    const auto result = runWith(arguments, work);
    const std::string end = code == 2 ? hint : "\n";
    EXPECT_EQ(result.err.rfind("pole-test: ", 0), 0u) << result.err;
    EXPECT_EQ(result.err.find('\n'), result.err.size() - end.size()) << result.err;
    EXPECT_EQ(result.err.substr(result.err.find('\n')), end);
    EXPECT_HAS(result.err, named);
    EXPECT_EQ(result.code, code) << named;
    EXPECT_EQ(result.worked, code == 1) << named;
    EXPECT_EQ(result.out, "");
  }
}

TEST(CommandLine, NamesTheSubcommands) {
  for (const bool given : {false, true}) {
    CommandLine line("pole-test", "Tries things.");
    std::string input;
    std::vector<Subcommand> commands;
    for (const char* name : {"build", "diff"}) {
      CLI::App* command = line.cli().add_subcommand(name, "Tries more.");
      command->add_option("--input", input, "A file")->required();
      commands.push_back({command, [](bool) { return ""; }});
    }
    const auto main = [&](int argc, const char* const* argv) {
      return line.run(argc, argv, commands);
    };
    const auto outcome = testing_apps::runProgram(
        main, given ? std::vector<std::string>{"diff"} : std::vector<std::string>{});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.err, given ? "pole-test: --input is required\nTry `pole-test diff --help`.\n"
                                 : "pole-test: a subcommand is needed: build, diff\n"
                                   "Try `pole-test --help`.\n");
  }
}

TEST(CommandLine, MessagesHoldNoRawBytes) {
  EXPECT_EQ(oneLine("a \xff\xfe\x1b[2J b"), "a ???[2J b");
  EXPECT_EQ(oneLine("l\xc3\xa4nge 5 m\xc2\xb2 \xe2\x80\xa6 \xf0\x9f\x9a\x97"),
            "l\xc3\xa4nge 5 m\xc2\xb2 \xe2\x80\xa6 \xf0\x9f\x9a\x97");
  EXPECT_EQ(oneLine("cut \xe2\x80"), "cut ??");
}

}  // namespace
}  // namespace polemcl::test_command_line
