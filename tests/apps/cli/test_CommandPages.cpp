/// \file test_CommandPages.cpp
/// \brief The pages in share/doc that list the options of the programs.

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "cli/CommandLine.h"
#include "cli/CommandPage.h"
#include "cli/OptionText.h"
#include "cli/Programs.h"

namespace polemcl::test_command_pages {

using namespace polemcl::apps;

// With POLEMCL_WRITE_PAGES in the environment the pages are written instead.
TEST(CommandPages, AreUpToDate) {
  for (const Program& program : programs())
    visitOptions(program.main, program.name, [&](CLI::App& cli) {
      const std::string path =
          std::string(POLEMCL_SOURCE_DIR) + "/share/doc/" + program.name + ".md";
      if (std::getenv("POLEMCL_WRITE_PAGES")) std::ofstream(path) << commandPage(cli);
      std::ifstream file(path);
      EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), commandPage(cli))
          << path
          << "; make it anew: POLEMCL_WRITE_PAGES=1 test_apps --gtest_filter='CommandPages.*'";
    });
}

TEST(CommandPages, HaveEachOptionOfEachSubcommand) {
  for (const Program& program : programs())
    visitOptions(program.main, program.name, [&](CLI::App& cli) {
      const std::string page = commandPage(cli);
      for (const CLI::App* command : subcommandsOf(cli)) {
        EXPECT_NE(page.find("\n## " + cli.get_name() + ' ' + command->get_name() + '\n'),
                  std::string::npos)
            << command->get_name();
        for (const OptionText& option : optionsOf(*command, false)) {
          if (option.names.back() == "--help") continue;
          EXPECT_NE(page.find("| `" + option.names.front()), std::string::npos)
              << command->get_name() << ' ' << option.names.front();
        }
      }
    });
}

TEST(CommandPages, TellCommonOptionsOnce) {
  CLI::App app("Tries things", "pole-test");
  int number = 0;
  for (const std::string name : {"a", "b"}) {
    CLI::App* command = app.add_subcommand(name, "Does " + name);
    command->add_option("--shared", number, "The same | in both");
    command->add_option("--own-" + name, number, "Of <one> only");
  }
  const std::string page = commandPage(app);
  const auto count = [&](const std::string& text) {
    int found = 0;
    for (std::size_t at = 0; (at = page.find(text, at)) != std::string::npos; ++at) ++found;
    return found;
  };
  EXPECT_EQ(count("| `--shared"), 1) << page;
  EXPECT_EQ(count("The same \\| in both"), 1) << page;
  EXPECT_EQ(count("| `--own-a"), 1) << page;
  EXPECT_EQ(count("Of \\<one>"), 2) << page;
}

}  // namespace polemcl::test_command_pages
