#include "io/file/AtomicFile.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <set>
#include <utility>

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

fs::path folderOf(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : ".";
}

thread_local AtomicFiles* t_together = nullptr;

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

TemporaryFile::TemporaryFile(fs::path target) : m_target(std::move(target)) {
  static std::atomic<unsigned> counter{0};
  removeLeftovers(
      m_target, [](const fs::path& path) { return fs::is_regular_file(fs::symlink_status(path)); });
  while (true) {
    m_path = m_target;
    m_path += "." + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".tmp";
    const int made = ::open(m_path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (made < 0 && errno != EEXIST)  // a process on another machine may have our process id
      throw cannotWrite(m_target, std::strerror(errno));
    if (made < 0) continue;
    m_lock = PathLock(made);
    std::error_code none;
    if (!m_lock.isOfAnother() && fs::exists(m_path, none)) return;  // else taken for a leftover
  }
}

TemporaryFile::TemporaryFile(TemporaryFile&& other) noexcept
    : m_target(std::move(other.m_target)),
      m_path(std::exchange(other.m_path, {})),
      m_lock(std::move(other.m_lock)) {}

TemporaryFile::~TemporaryFile() {
  std::error_code ignored;
  if (!m_path.empty()) fs::remove(m_path, ignored);
}

void TemporaryFile::rename() {
  std::error_code error;
  fs::rename(m_path, m_target, error);
  if (error) throw cannotWrite(m_target, error.message());
  m_path.clear();
}

AtomicFile::AtomicFile(const fs::path& path) : m_temporary(checkedTarget(path)) {
  m_stream.open(m_temporary.path(), std::ios::binary | std::ios::out | std::ios::trunc);
  if (!m_stream) throw cannotWrite(m_temporary.target(), std::strerror(errno));
}

void AtomicFile::commit() {
  const fs::path& target = m_temporary.target();
  if (m_committed) throw cannotWrite(target, "commit() was called before");
  errno = 0;
  m_stream.close();  // flushes the buffer; failures of earlier writes are still set
  if (m_stream.fail()) {
    const std::string why = errno != 0 ? std::strerror(errno) : "a write failed";
    throw cannotWrite(target, why + " (the disk may be full); nothing was changed");
  }
  // Else the name may survive a power cut, and the content not.
  if (const auto error = syncFile(m_temporary.path())) throw cannotWrite(target, error.message());
  m_committed = true;
  if (t_together) {
    t_together->m_complete.push_back(std::move(m_temporary));
  } else {
    m_temporary.rename();
    syncFolder(folderOf(target));
  }
}

AtomicFiles::AtomicFiles() {
  if (t_together) throw Error("files that appear together: one such group at a time");
  t_together = this;
}

AtomicFiles::~AtomicFiles() {
  t_together = nullptr;
}

void AtomicFiles::commit() {
  if (m_complete.empty()) return;
  std::set<fs::path> folders;
  for (const TemporaryFile& file : m_complete) folders.insert(folderOf(file.target()));
  const auto sync = [&] {
    for (const fs::path& folder : folders) syncFolder(folder);
  };
  const PathLock turn = PathLock::waitFor(*folders.begin());
  TemporaryFile main = std::move(m_complete.back());
  m_complete.pop_back();
  std::error_code error;
  bool isRemoved = false;
  for (const TemporaryFile& other : m_complete) {
    isRemoved |= fs::remove(other.target(), error);
    if (error) throw cannotWrite(other.target(), error.message());
  }
  if (isRemoved) sync();
  const bool isNew = !fs::exists(main.target());
  const auto finishMain = [&] {
    main.rename();
    sync();
  };
  if (!isNew) finishMain();
  for (TemporaryFile& other : m_complete) other.rename();
  if (!m_complete.empty()) sync();
  m_complete.clear();
  if (isNew) finishMain();
}

void writeFile(const fs::path& file, std::string_view content) {
  AtomicFile output(file);
  output.stream() << content;
  output.commit();
}

}  // namespace polemcl::io
