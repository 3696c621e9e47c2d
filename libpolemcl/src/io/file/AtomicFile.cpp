#include "io/file/AtomicFile.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>

#include <polemcl/core/common/Types.h>

namespace polemcl::io {

namespace fs = std::filesystem;

namespace {

Error cannotWrite(const fs::path& file, const std::string& why) {
  return Error("cannot write " + file.string() + ": " + why);
}

/// The file to replace: the target of a link, never a folder or a device.
fs::path checkedTarget(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) {
    if (!path.has_filename()) throw cannotWrite(path, "it names no file");
    return path;
  }
  if (fs::is_directory(status)) throw cannotWrite(path, "it is a folder; name a file");
  if (!fs::is_regular_file(status)) {
    throw cannotWrite(path, "it is a device or pipe; name a regular file");
  }
  if (!fs::is_symlink(path, error)) return path;
  fs::path named = fs::canonical(path, error);
  if (error) throw cannotWrite(path, error.message());
  return named;
}

/// Creates a new file beside the target.
fs::path createTemporary(const fs::path& target) {
  static std::atomic<unsigned> counter{0};
  while (true) {
    fs::path temporary = target;
    temporary += "." + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".tmp";
    const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0) {
      ::close(descriptor);
      return temporary;
    }
    // Leftover of an earlier process with our process id: try the next name.
    if (errno != EEXIST) throw cannotWrite(target, std::strerror(errno));
  }
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& path)
    : m_target(checkedTarget(path)), m_temporary(createTemporary(m_target)) {
  m_stream.open(m_temporary, std::ios::binary | std::ios::out | std::ios::trunc);
  if (!m_stream) {
    const int reason = errno;
    std::error_code ignored;
    fs::remove(m_temporary, ignored);
    throw cannotWrite(m_target, std::strerror(reason));
  }
}

AtomicFile::~AtomicFile() {
  if (!m_open) return;
  m_stream.close();
  std::error_code ignored;
  fs::remove(m_temporary, ignored);
}

void AtomicFile::commit() {
  if (!m_open) throw cannotWrite(m_target, "commit() was called before");
  errno = 0;
  m_stream.close();  // flushes the buffer; failures of earlier writes are still set
  if (m_stream.fail()) {
    const std::string why = errno != 0 ? std::strerror(errno) : "a write failed";
    throw cannotWrite(m_target, why + " (the disk may be full); nothing was changed");
  }
  std::error_code error;
  fs::rename(m_temporary, m_target, error);
  if (error) throw cannotWrite(m_target, error.message());
  m_open = false;
}

void writeFile(const fs::path& file, std::string_view content) {
  AtomicFile output(file);
  output.stream() << content;
  output.commit();
}

}  // namespace polemcl::io
