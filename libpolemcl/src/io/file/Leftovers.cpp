#include "io/file/Leftovers.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace polemcl::io {
namespace fs = std::filesystem;
namespace {

constexpr const char* kEnding = ".tmp";

/// A regular file or folder that nobody has removed.
bool isThere(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && status.st_nlink > 0 &&
         (S_ISREG(status.st_mode) || S_ISDIR(status.st_mode));
}

bool isNumber(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

}  // namespace

PathLock::PathLock(const fs::path& path)
    // Opening a pipe would wait for its other end.
    : PathLock(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK)) {}

PathLock::PathLock(int descriptor) : m_descriptor(descriptor) {
  if (descriptor < 0) return;
  const bool isLocked = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
  m_isOfAnother = !isLocked && errno == EWOULDBLOCK;
  m_isHeld = isLocked && isThere(descriptor);
}

PathLock PathLock::waitFor(const fs::path& path) {
  PathLock lock;
  lock.m_descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  int failed = 0;
  do {
    failed = ::flock(lock.m_descriptor, LOCK_EX);
  } while (failed != 0 && errno == EINTR);
  lock.m_isHeld = failed == 0;
  return lock;
}

PathLock::~PathLock() {
  if (m_descriptor >= 0) ::close(m_descriptor);
}

PathLock::PathLock(PathLock&& other) noexcept
    : m_descriptor(std::exchange(other.m_descriptor, -1)),
      m_isHeld(std::exchange(other.m_isHeld, false)),
      m_isOfAnother(std::exchange(other.m_isOfAnother, false)) {}

PathLock& PathLock::operator=(PathLock&& other) noexcept {
  std::swap(m_descriptor, other.m_descriptor);
  std::swap(m_isHeld, other.m_isHeld);
  std::swap(m_isOfAnother, other.m_isOfAnother);
  return *this;
}

std::vector<fs::path> leftoversIn(const fs::path& folder,
                                  const std::function<bool(const std::string& name)>& isTemporary) {
  std::vector<fs::path> leftovers;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none))
    if (isTemporary(entry.path().filename().string()) && PathLock(entry.path()).isHeld())
      leftovers.push_back(entry.path());
  return leftovers;
}

bool isTemporaryOf(const std::string& target, const std::string& name) {
  const std::string begin = target + ".", end = kEnding;
  if (name.size() <= begin.size() + end.size() || name.compare(0, begin.size(), begin) != 0 ||
      name.compare(name.size() - end.size(), end.size(), end) != 0)
    return false;
  const auto middle = name.substr(begin.size(), name.size() - begin.size() - end.size());
  const auto dash = middle.find('-');
  return dash != std::string::npos && isNumber(middle.substr(0, dash)) &&
         isNumber(middle.substr(dash + 1));
}

void removeLeftovers(const fs::path& target,
                     const std::function<bool(const fs::path& path)>& isOurs) {
  const fs::path folder = target.has_parent_path() ? target.parent_path() : ".";
  const std::string own = target.filename().string();
  std::error_code none;
  for (const fs::path& left :
       leftoversIn(folder, [&](const std::string& name) { return isTemporaryOf(own, name); })) {
    const PathLock lock(left);  // so that nobody begins to use it
    if (lock.isHeld() && isOurs(left)) fs::remove_all(left, none);
  }
}

}  // namespace polemcl::io
