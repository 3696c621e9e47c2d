#pragma once
// A temporary folder for one test, and helpers for files and programs.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "support/ExpectHas.h"

namespace testing_apps {

namespace fs = std::filesystem;

/// A new, empty folder that is removed with its content.
class TempFolder {
 public:
  TempFolder() {
    std::string name = (fs::temp_directory_path() / "polemcl-apps-XXXXXX").string();
    m_path = ::mkdtemp(name.data());
  }
  ~TempFolder() {
    std::error_code ignored;
    fs::remove_all(m_path, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  const fs::path& path() const { return m_path; }
  fs::path operator/(const std::string& name) const { return m_path / name; }

 private:
  fs::path m_path;
};

inline void writeText(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream out(file, std::ios::binary);
  out << text;
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

inline std::string readText(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// Names of the files in a folder, sorted.
inline std::vector<std::string> names(const fs::path& folder) {
  std::vector<std::string> result;
  for (const auto& entry : fs::directory_iterator(folder))
    result.push_back(entry.path().filename().string());
  std::sort(result.begin(), result.end());
  return result;
}

/// The folder of real data, or empty.
inline fs::path dataFolder() {
  const char* folder = std::getenv("POLEMCL_DATA");
  return folder == nullptr ? fs::path() : fs::path(folder);
}

struct Outcome {
  int code = -1;
  std::string out, err;
};

/// Runs a program in this process.
inline Outcome runProgram(const std::function<int(int, const char* const*)>& program,
                          std::vector<std::string> arguments,
                          const std::vector<std::string>& more = {}) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  std::vector<const char*> argv{"program"};
  for (const auto& argument : arguments) argv.push_back(argument.c_str());
  Outcome outcome;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  outcome.code = program(static_cast<int>(argv.size()), argv.data());
  outcome.out = testing::internal::GetCapturedStdout();
  outcome.err = testing::internal::GetCapturedStderr();
  return outcome;
}

/// The outcome of a run that must succeed.
inline Outcome succeeded(const Outcome& outcome) {
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return outcome;
}

/// Checks for exit code 1 and one line on stderr with all of these words.
inline void expectFailure(const Outcome& outcome, const std::vector<std::string>& words) {
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  for (const auto& word : words) EXPECT_HAS(outcome.err, word) << ", without " << word;
}

inline void expectUsageError(const Outcome& outcome) {
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_HAS(outcome.err, "--help");
}

}  // namespace testing_apps

/// Skips the test when there is no real data.
#define POLEMCL_NEEDS_DATA()                                                  \
  if (testing_apps::dataFolder().empty()) {                                   \
    GTEST_SKIP() << "POLEMCL_DATA is not set: real scans and published maps"; \
  }
