#pragma once
/// \file IoFiles.h
/// \brief Shared by the tests of io/: a temporary folder, files in it, messages of errors.

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <polemcl/core/common/Types.h>

namespace polemcl::io::test {

namespace fs = std::filesystem;

/// A test with a folder of its own.
class FolderTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "polemcl-io-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    m_folder = name;
  }
  void TearDown() override { fs::remove_all(m_folder); }

  fs::path path(const std::string& name) const { return m_folder / name; }
  /// Writes a file and the folders above it.
  fs::path write(const std::string& name, const std::string& content) const {
    fs::create_directories(path(name).parent_path());
    fs::remove(path(name));  // overwriting makes some file systems wait for the disk
    std::ofstream stream(path(name), std::ios::binary);
    stream << content;
    stream.close();
    EXPECT_TRUE(stream.good());
    return path(name);
  }

  fs::path m_folder;
};

/// Limits the size of all files while it exists: simulates a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : m_handler(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &m_before);
    const rlimit limit{bytes, m_before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &m_before);
    std::signal(SIGXFSZ, m_handler);
  }

 private:
  void (*m_handler)(int);
  rlimit m_before{};
};

inline std::string read(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The message of the Error that `action` throws; fails the test when it throws none.
template <class Action>
std::string messageOf(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "no Error was thrown";
  return {};
}

/// Fails unless the message is one line and contains all texts.
template <class... Texts>
void expectIn(const std::string& message, const Texts&... texts) {
  for (const std::string& text : {std::string(texts)...}) {
    EXPECT_NE(message.find(text), std::string::npos) << "'" << text << "' not in: " << message;
  }
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

/// float32 values as the bytes of a file (tests run on little-endian machines).
inline std::string floats(std::initializer_list<float> values) {
  std::string bytes(4 * values.size(), '\0');
  std::memcpy(bytes.data(), values.begin(), bytes.size());
  return bytes;
}
inline std::string doubles(std::initializer_list<double> values) {
  std::string bytes(8 * values.size(), '\0');
  std::memcpy(bytes.data(), values.begin(), bytes.size());
  return bytes;
}

/// The folder of real data, or empty.
inline fs::path dataFolder() {
  const char* folder = std::getenv("POLEMCL_DATA");
  return folder == nullptr ? fs::path() : fs::path(folder);
}

}  // namespace polemcl::io::test

/// Skips the test when there is no real data.
#define POLEMCL_NEEDS_DATA()                                                  \
  if (polemcl::io::test::dataFolder().empty()) {                              \
    GTEST_SKIP() << "POLEMCL_DATA is not set: real scans and published maps"; \
  }
