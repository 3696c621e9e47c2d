#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "cli/Settings.h"
#include "config/SettingsPage.h"

namespace polemcl::test_settings_page {

// With POLEMCL_WRITE_PAGES in the environment the pages are written instead.
TEST(SettingsPage, IsUpToDate) {
  for (const auto& [name, text] : apps::settingsPages()) {
    const std::string path = std::string(POLEMCL_SOURCE_DIR) + "/share/doc/" + name;
    if (std::getenv("POLEMCL_WRITE_PAGES")) std::ofstream(path) << text;
    std::stringstream written;
    written << std::ifstream(path).rdbuf();
    EXPECT_EQ(written.str(), text)
        << path
        << "; make it anew: POLEMCL_WRITE_PAGES=1 test_config --gtest_filter='SettingsPage.*'";
  }
}

TEST(SettingsPage, NoOldPageStays) {
  const auto pages = apps::settingsPages();
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(POLEMCL_SOURCE_DIR) + "/share/doc")) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(name.rfind("settings", 0) != 0 || pages.count(name)) << name;
  }
}

TEST(SettingsPage, SaysWhatEachKeyMeans) {
  std::size_t rows = 0;
  for (const auto& page : apps::settingsPages()) {
    std::istringstream lines(page.second);
    for (std::string line; std::getline(lines, line);) {
      if (line.rfind("| `", 0) != 0) continue;
      ++rows;
      EXPECT_EQ(line.find("` |  |"), std::string::npos) << line;
      EXPECT_EQ(line.substr(line.size() - 2), " |") << line;
    }
  }
  EXPECT_GT(rows, 100u);
}

TEST(SettingsPage, EachKeyOfAnIniFileIsOnOnePage) {
  std::multiset<std::string> shown;
  for (const auto& page : apps::settingsPages()) {
    std::istringstream lines(page.second);
    std::string section;
    for (std::string line; std::getline(lines, line);) {
      if (line.rfind("## [", 0) == 0) section = line.substr(3);
      if (line.rfind("| `", 0) == 0 && !section.empty())
        shown.insert(section + line.substr(3, line.find('`', 3) - 3));
    }
  }
  std::istringstream ini(apps::settingsText(apps::AllSettings{}));
  std::size_t keys = 0;
  std::string section;
  for (std::string line; std::getline(ini, line);) {
    if (line.rfind('[', 0) == 0) section = line.substr(0, line.find(']') + 1);
    const std::size_t equals = line.find(" =");
    if (equals == std::string::npos || line.find_first_of(";#") < equals) continue;
    ++keys;
    EXPECT_EQ(shown.count(section + line.substr(0, equals)), 1u) << section << line;
  }
  EXPECT_GT(keys, 100u);
}

}  // namespace polemcl::test_settings_page
