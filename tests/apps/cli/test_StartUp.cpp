#include <gtest/gtest.h>

#include <string>

#include "cli/Programs.h"
#include "cli/Version.h"
#include "support/Shell.h"

namespace polemcl::test_start_up {

using namespace polemcl::apps;
using namespace testing_apps;

namespace {

const fs::path bin = POLEMCL_BIN_DIR;

/// A copy of the programs' start, without any of what is installed beside it but the module.
fs::path bareProgram(const TempFolder& folder, const std::string& name) {
  fs::create_directories(folder / "bin");
  fs::create_directories(folder / "lib");
  fs::copy_file(bin / name, folder / "bin" / name);
  fs::create_symlink(bin.parent_path() / "lib" / programModule, folder / "lib" / programModule);
  return folder / "bin" / name;
}

}  // namespace

TEST(StartUp, HelpAndVersionAreThoseOfThePrograms) {
  for (const Program& program : programs()) {
    const std::string command = (bin / program.name).string();
    EXPECT_EQ(shell(command + " --version").out, versionLine(program.name) + "\n");
    // Spelled so that the module answers.
    const Outcome whole = shell(command + " --quiet --help");
    EXPECT_EQ(whole.code, 0);
    EXPECT_NE(whole.out.find("Usage: " + std::string(program.name)), std::string::npos);
    EXPECT_EQ(shell(command + " --help").out, whole.out);
    EXPECT_EQ(shell(command + " -h").out, whole.out);
  }
}

TEST(StartUp, HelpOfASubcommand) {
  const std::string command = (bin / "pole-map").string();
  for (const std::string name : {"build", "update", "diff", "convert", "import"}) {
    const Outcome help = shell(command + " " + name + " --help");
    EXPECT_EQ(help.code, 0);
    EXPECT_EQ(help.out, shell(command + " " + name + " --quiet --help").out);
    EXPECT_NE(help.out.find("Usage: pole-map " + name), std::string::npos) << help.out;
  }
  EXPECT_EQ(shell(command + " nonsense --help").out, shell(command + " --help").out);
}

TEST(StartUp, HelpAndVersionLoadNothingOfMrpt) {
  for (const std::string arguments : {"--help", "build --help", "--version"}) {
    const Outcome outcome =
        shell("LD_DEBUG=files '" + (bin / "pole-map").string() + "' " + arguments);
    EXPECT_NE(outcome.out.find("libstdc++"), std::string::npos) << "the loader tells its files";
    EXPECT_EQ(outcome.out.find("libmrpt"), std::string::npos) << arguments;
  }
}

TEST(StartUp, WithoutItsTextsAProgramStillKnowsItsHelp) {
  const TempFolder folder;
  const fs::path program = bareProgram(folder, "pole-map");
  const Outcome help = shell(program.string() + " --help");
  EXPECT_EQ(help.code, 0);
  EXPECT_EQ(help.out, shell((bin / "pole-map").string() + " --help").out);
}

}  // namespace polemcl::test_start_up
