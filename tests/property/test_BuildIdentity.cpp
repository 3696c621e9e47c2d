/// \file test_BuildIdentity.cpp
/// \brief The script that runs in each build, on small test projects.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

namespace polemcl::test_build_identity {

namespace fs = std::filesystem;

namespace {

/// A checkout with two sources and a document.
class BuildIdentity : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("cmake --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "cmake is not here";
    std::string name = (fs::temp_directory_path() / "polemcl-build-XXXXXX").string();
    m_folder = ::mkdtemp(name.data());
    write("CMakeLists.txt", "project(small)\n");
    write("libpolemcl/src/a.cpp", "int a;\n");
    write("apps/b.cpp", "int b;\n");
    write("share/doc/a.md", "# A\n");
  }
  void TearDown() override { fs::remove_all(m_folder); }

  void write(const std::string& file, const std::string& text) const {
    fs::create_directories((project() / file).parent_path());
    std::ofstream(project() / file) << text;
  }
  fs::path project() const { return m_folder / "small project"; }
  fs::path source() const { return m_folder / "BuildIdentity.cpp"; }
  static bool run(const std::string& command) {
    return std::system((command + " >/dev/null 2>&1").c_str()) == 0;
  }
  bool git(const std::string& arguments) const {
    return run("git -C '" + project().string() + "' -c user.name=a -c user.email=a@b " + arguments);
  }
  bool commit() const { return git("add -A") && git("commit -q -m change"); }

  /// The identity that the build reports.
  std::string identity(const std::string& options = "-O3  -DNDEBUG") const {
    const std::string script = std::string(POLEMCL_SOURCE_DIR) + "/share/cmake/BuildIdentity.cmake";
    EXPECT_TRUE(run("cmake -D 'SOURCE=" + project().string() + "' -D 'OUTPUT=" + source().string() +
                    "' -D 'COMPILER=GNU 12.2.0' -D TYPE=Release -D 'OPTIONS=" + options + "' -P '" +
                    script + "'"));
    std::ostringstream text;
    text << std::ifstream(source()).rdbuf();
    std::smatch found;
    const std::string content = text.str();
    EXPECT_TRUE(std::regex_search(content, found, std::regex("R\"identity\\((.*)\\)identity\"")));
    return found[1];
  }

  fs::path m_folder;
};

const std::string kBuilt = ", GNU 12.2.0, Release, -O3 -DNDEBUG";

}  // namespace

TEST_F(BuildIdentity, IsTheCommitWithAMarkForChangedSources) {
  if (!git("init -q") || !commit()) GTEST_SKIP() << "git is not here";
  const std::string clean = identity();
  EXPECT_TRUE(std::regex_match(clean, std::regex("[0-9a-f]{12}" + kBuilt))) << clean;
  write("share/doc/a.md", "# B\n");
  EXPECT_EQ(identity(), clean) << "a document is not built";

  write("apps/b.cpp", "int c;\n");
  const std::string changed = identity();
  EXPECT_TRUE(std::regex_match(changed, std::regex("[0-9a-f]{12}\\+[0-9a-f]{12}" + kBuilt)))
      << changed;
  EXPECT_EQ(changed.substr(0, 12), clean.substr(0, 12));
  write("apps/b.cpp", "int d;\n");
  EXPECT_NE(identity(), changed) << "another change";
  write("apps/b.cpp", "int b;\n");
  EXPECT_EQ(identity(), clean) << "taken back";
  write("libpolemcl/src/new.cpp", "int e;\n");
  EXPECT_NE(identity(), clean) << "a new file";

  ASSERT_TRUE(commit());
  const std::string next = identity();
  EXPECT_TRUE(std::regex_match(next, std::regex("[0-9a-f]{12}" + kBuilt))) << next;
  EXPECT_NE(next, clean);
  EXPECT_NE(identity("-O0"), next);
}

TEST_F(BuildIdentity, IsAHashOfTheSourcesWithoutGit) {
  const std::string archive = identity();
  EXPECT_TRUE(std::regex_match(archive, std::regex("sources-[0-9a-f]{12}" + kBuilt))) << archive;
  write("share/doc/a.md", "# B\n");
  EXPECT_EQ(identity(), archive);
  write("libpolemcl/src/a.cpp", "int f;\n");
  EXPECT_NE(identity(), archive);
}

// An archive inside a foreign repository has nothing to do with the commits there.
TEST_F(BuildIdentity, IsNotThatOfARepositoryAround) {
  const std::string archive = identity();
  if (!run("git -C '" + m_folder.string() + "' init -q")) GTEST_SKIP() << "git is not here";
  EXPECT_EQ(identity(), archive);
}

TEST_F(BuildIdentity, TouchesItsFileOnlyWhenItChanges) {
  identity();
  const auto old = fs::last_write_time(source()) - std::chrono::hours(1);
  fs::last_write_time(source(), old);
  identity();
  EXPECT_EQ(fs::last_write_time(source()), old);
  write("apps/b.cpp", "int g;\n");
  identity();
  EXPECT_NE(fs::last_write_time(source()), old);
}

}  // namespace polemcl::test_build_identity
