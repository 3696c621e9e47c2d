/// \file test_Versions.cpp
/// \brief The version number, wherever it is spelt.

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <string>

#include <polemcl/version.h>

namespace polemcl::test_versions {

namespace {

std::string textOf(const std::string& name) {
  std::ifstream file(std::string(POLEMCL_SOURCE_DIR) + "/" + name);
  EXPECT_TRUE(file) << name;
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string firstMatch(const std::string& name, const std::string& pattern) {
  const std::string text = textOf(name);
  std::smatch match;
  return std::regex_search(text, match, std::regex(pattern)) ? match[1].str() : "";
}

const std::string kMinorVersion =
    std::to_string(POLEMCL_VERSION_MAJOR) + "." + std::to_string(POLEMCL_VERSION_MINOR);

}  // namespace

// The version of CMakeLists.txt is also spelt in files that CMake does not write.
TEST(Versions, AreTheSameEverywhere) {
  const std::string version = POLEMCL_VERSION_TEXT;
  EXPECT_EQ(firstMatch("CHANGELOG.md", R"(\n## \[(\d[^\]]*)\])"), version);
  EXPECT_EQ(firstMatch("CITATION.cff", R"(\nversion: (\S+))"), version);
  EXPECT_EQ(firstMatch("share/doc/cite.md", R"(version = \{([^}]*)\})"), version);
  EXPECT_EQ(firstMatch("tests/install/packages.sh", R"(libpolemcl(\d\S*))"), kMinorVersion);
  EXPECT_EQ(firstMatch("share/doc/programs.md", R"(`libpolemcl(\d[^`]*)`)"), kMinorVersion);
  EXPECT_EQ(firstMatch("share/doc/files.md", R"(`libpolemcl\.so\.(\d[^`]*)`)"), kMinorVersion);
}

// Later versions are tried on the files of this one: share/doc/releasing.md.
TEST(Versions, HaveFilesToReadLater) {
  EXPECT_FALSE(textOf("tests/releases/" + kMinorVersion + ".0/street.polemap").empty());
}

}  // namespace polemcl::test_versions
