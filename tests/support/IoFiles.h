#pragma once
// Shared by the tests of io/: a temporary folder, files in it, messages of errors.

#include <sys/resource.h>
#include <zlib.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <optional>

#include "support/Refusal.h"
#include "support/TempFolder.h"

namespace polemcl::io::test {

namespace fs = std::filesystem;

inline std::string read(const fs::path& file) {
  return testing_apps::readText(file);
}

inline void writeGzip(const fs::path& file, const std::string& text) {
  const gzFile stream = gzopen(file.c_str(), "wb");
  ASSERT_NE(stream, nullptr);
  ASSERT_EQ(gzwrite(stream, text.data(), static_cast<unsigned>(text.size())),
            static_cast<int>(text.size()));
  ASSERT_EQ(gzclose(stream), Z_OK);
}

using tests::messageOf;

/// A test with a folder of its own.
class FolderTest : public ::testing::Test {
 protected:
  fs::path path(const std::string& name) const { return m_folder / name; }
  /// Writes a file and the folders above it.
  fs::path write(const std::string& name, const std::string& content) const {
    fs::remove(path(name));  // overwriting makes some file systems wait for the disk
    testing_apps::writeText(path(name), content);
    return path(name);
  }

  /// A file that a reader must refuse, and what the message must say.
  struct FileFault {
    std::string file;
    std::optional<std::string> content;  ///< none: the file is missing
    std::vector<std::string> parts;
  };
  /// Each fault alone: the file is put back as it was.
  void expectRefused(const std::vector<FileFault>& faults,
                     const std::function<void()>& reading) const {
    for (const FileFault& fault : faults) {
      std::optional<std::string> before;
      if (fs::exists(path(fault.file))) before = read(path(fault.file));
      put(fault.file, fault.content);
      EXPECT_TRUE(tests::says(messageOf(reading), fault.parts))
          << fault.file << ": " << fault.content.value_or("missing");
      put(fault.file, before);
    }
  }
  void put(const std::string& name, const std::optional<std::string>& content) const {
    if (content)
      write(name, *content);
    else
      fs::remove(path(name));
  }

  const testing_apps::TempFolder m_temporary;
  const fs::path m_folder = m_temporary.path();
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

/// Fails unless the message is one line and contains all texts.
template <class... Texts>
void expectIn(const std::string& message, const Texts&... texts) {
  EXPECT_TRUE(tests::says(message, {texts...}));
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

using testing_apps::dataFolder;

}  // namespace polemcl::io::test
