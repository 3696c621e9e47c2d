#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "cli/Settings.h"

namespace polemcl::test_settings_page {

// With POLEMCL_WRITE_PAGES in the environment the page is written instead.
TEST(SettingsPage, IsUpToDate) {
  const std::string path = std::string(POLEMCL_SOURCE_DIR) + "/share/doc/settings.md";
  if (std::getenv("POLEMCL_WRITE_PAGES")) std::ofstream(path) << apps::settingsPage();
  std::stringstream written;
  written << std::ifstream(path).rdbuf();
  EXPECT_EQ(written.str(), apps::settingsPage())
      << "make it anew: POLEMCL_WRITE_PAGES=1 test_config --gtest_filter='SettingsPage.*'";
}

TEST(SettingsPage, EndsEachRowWithItsMeaning) {
  std::istringstream lines(apps::settingsPage());
  std::size_t rows = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("| `", 0) != 0) continue;
    ++rows;
    EXPECT_EQ(line.find("|  |\n"), std::string::npos) << line;
    EXPECT_EQ(line.substr(line.size() - 2), " |") << line;
  }
  EXPECT_GT(rows, 200u);
}

}  // namespace polemcl::test_settings_page
