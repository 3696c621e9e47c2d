#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cli/CommandLine.h"
#include "cli/Settings.h"
#include "core/common/Binder.h"

namespace polemcl::test_print_config {

using namespace polemcl::apps;

namespace {

struct Result {
  int code = -1;
  std::string out, err;
  bool worked = false;
};

/// A program that needs a file and settings, both itself and below a subcommand.
Result run(std::vector<std::string> arguments, bool takesConfig = true) {
  Result result;
  CommandLine line("pole-test", "Tries things.");
  std::string input, config;
  std::vector<std::string> set;
  CLI::App* below = line.cli().add_subcommand("below", "Tries more.");
  for (CLI::App* app : {&line.cli(), below}) {
    app->add_option("--input", input, "A file")->required();
    if (takesConfig) app->add_option("--config", config, "Settings")->required();
    if (takesConfig) addSetOption(*app, set);
  }
  std::vector<const char*> all{"pole-test"};
  for (const auto& argument : arguments) all.push_back(argument.c_str());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  result.code = line.run(static_cast<int>(all.size()), all.data(), [&] { result.worked = true; });
  result.out = testing::internal::GetCapturedStdout();
  result.err = testing::internal::GetCapturedStderr();
  return result;
}

const std::string s_kitti = std::string(POLEMCL_SOURCE_DIR) + "/config/kitti.ini";

}  // namespace

TEST(PrintConfig, PrintsAndEndsWithoutTheOtherArguments) {
  const Result result = run({"--config", s_kitti, "--print-config"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_FALSE(result.worked);
  EXPECT_EQ(result.out, settingsText(loadSettings(s_kitti), Tier::tuning));
  EXPECT_EQ(result.err, "");
}

TEST(PrintConfig, PrintsTheExpertSettingsWithAll) {
  const Result result = run({"--print-config", "--all", "--config", s_kitti, "--input", "a"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.out, settingsText(loadSettings(s_kitti)));
}

TEST(PrintConfig, PrintsWhatIsSetOnTheCommandLine) {
  const std::vector<std::string> set{"filter.particles=77", "map.min_count=9"};
  const Result result =
      run({"--config", s_kitti, "--set", set[0], "--print-config", "--set", set[1]});
  EXPECT_EQ(result.out, settingsText(loadSettings(s_kitti, set), Tier::tuning));
  EXPECT_NE(result.out.find("particles = 77"), std::string::npos);
}

TEST(PrintConfig, WorksBelowASubcommand) {
  const Result result = run({"below", "--config", s_kitti, "--print-config"});
  EXPECT_EQ(result.out, settingsText(loadSettings(s_kitti), Tier::tuning));
}

TEST(PrintConfig, RefusesWhatCannotBePrinted) {
  const Result none = run({"--print-config"});
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.err.find("--config"), std::string::npos) << none.err;
  EXPECT_EQ(run({"--print-config", "--config", "no.ini"}).code, 1);
  EXPECT_EQ(run({"--print-config", "--config", s_kitti}, false).code, 2);  // takes no settings
  EXPECT_EQ(run({"--all", "--config", s_kitti, "--input", "a"}).code, 2);
}

TEST(PrintConfig, StandsInTheHelp) {
  EXPECT_NE(run({"--help"}).out.find("--print-config"), std::string::npos);
  EXPECT_EQ(run({"--help"}, false).out.find("--print-config"), std::string::npos);
}

}  // namespace polemcl::test_print_config
