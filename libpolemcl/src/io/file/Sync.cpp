#include "io/file/Sync.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include <polemcl/core/common/Types.h>

namespace polemcl::io {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void fail(const fs::path& path) {
  throw Error(path.string() +
              ": what was written may not survive a power cut: " + std::strerror(errno));
}

class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags) : m_number(::open(path.c_str(), flags | O_CLOEXEC)) {}
  ~Descriptor() {
    if (m_number >= 0) ::close(m_number);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return m_number; }

 private:
  int m_number;
};

}  // namespace

std::error_code syncFile(const fs::path& file) {
  const Descriptor open(file, O_WRONLY);
  if (open.number() >= 0 && ::fsync(open.number()) == 0) return {};
  return {errno, std::generic_category()};
}

void syncFolder(const fs::path& folder) {
  const Descriptor open(folder, O_RDONLY | O_DIRECTORY);
  if (open.number() < 0 && errno == EACCES) return;
  if (open.number() < 0) fail(folder);
  if (::fsync(open.number()) != 0 && errno != EINVAL && errno != ENOTSUP) fail(folder);
}

void syncAll(const fs::path& folder) {
  const Descriptor open(folder, O_RDONLY | O_DIRECTORY);
  if (open.number() < 0 || ::syncfs(open.number()) != 0) fail(folder);
}

}  // namespace polemcl::io
