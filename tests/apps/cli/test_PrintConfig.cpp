#include <gtest/gtest.h>

#include <iostream>
#include <string>
#include <vector>

#include "cli/CommandLine.h"
#include "cli/Settings.h"
#include "core/common/Binder.h"
#include "support/TempFolder.h"

namespace polemcl::test_print_config {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

/// A program that needs a file and settings, both itself and below a subcommand; prints "worked".
Outcome run(const std::vector<std::string>& arguments, bool takesConfig = true) {
  CommandLine line("pole-test", "Tries things.");
  std::string input, config;
  std::vector<std::string> set;
  CLI::App* below = line.cli().add_subcommand("below", "Tries more.");
  for (CLI::App* app : {&line.cli(), below}) {
    app->add_option("--input", input, "A file")->required();
    if (takesConfig) app->add_option("--config", config, "Settings")->required();
    if (takesConfig) addSetOption(*app, set);
  }
  const auto main = [&](int argc, const char* const* argv) {
    return line.run(argc, argv, [] { std::cout << "worked"; });
  };
  return runProgram(main, arguments);
}

const std::string kKitti = std::string(POLEMCL_SOURCE_DIR) + "/config/kitti.ini";

TEST(PrintConfig, PrintsAndEndsWithoutTheOtherArguments) {
  const Outcome result = succeeded(run({"--config", kKitti, "--print-config"}));
  EXPECT_EQ(result.out, settingsText(loadSettings(kKitti), Tier::tuning));
  EXPECT_EQ(result.err, "");
}

TEST(PrintConfig, PrintsTheExpertSettingsWithAll) {
  const Outcome result =
      succeeded(run({"--print-config", "--all", "--config", kKitti, "--input", "a"}));
  EXPECT_EQ(result.out, settingsText(loadSettings(kKitti)));
}

TEST(PrintConfig, PrintsWhatIsSetOnTheCommandLine) {
  const std::vector<std::string> set{"filter.particles=77", "map.min_count=9"};
  const Outcome result =
      run({"--config", kKitti, "--set", set[0], "--print-config", "--set", set[1]});
  EXPECT_EQ(result.out, settingsText(loadSettings(kKitti, set), Tier::tuning));
  EXPECT_NE(result.out.find("particles = 77"), std::string::npos);
}

TEST(PrintConfig, WorksBelowASubcommand) {
  const Outcome result = run({"below", "--config", kKitti, "--print-config"});
  EXPECT_EQ(result.out, settingsText(loadSettings(kKitti), Tier::tuning));
}

TEST(PrintConfig, RefusesWhatCannotBePrinted) {
  const Outcome none = run({"--print-config"});
  EXPECT_EQ(none.code, 2);
  EXPECT_HAS(none.err, "--config");
  EXPECT_EQ(run({"--print-config", "--config", "no.ini"}).code, 1);
  EXPECT_EQ(run({"--print-config", "--config", kKitti}, false).code, 2);  // takes no settings
  EXPECT_EQ(run({"--all", "--config", kKitti, "--input", "a"}).code, 2);
}

TEST(PrintConfig, StandsInTheHelp) {
  EXPECT_NE(run({"--help"}).out.find("--print-config"), std::string::npos);
  EXPECT_EQ(run({"--help"}, false).out.find("--print-config"), std::string::npos);
}

}  // namespace
}  // namespace polemcl::test_print_config
