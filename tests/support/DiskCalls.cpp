#include "support/DiskCalls.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>

namespace testing_disk {
namespace fs = std::filesystem;
namespace {
DiskCalls* s_calls = nullptr;
}

struct DiskCallNotes {
  static void note(const std::string& call) {
    if (s_calls) s_calls->m_calls.push_back(call);
  }
  static std::string nameOf(int file) {
    std::error_code none;
    return fs::read_symlink("/proc/self/fd/" + std::to_string(file), none).filename();
  }
  /// A failure that the test asked for.
  static bool fails() {
    if (!s_calls || s_calls->failSync == 0) return false;
    errno = s_calls->failSync;
    return true;
  }
  static bool isLocked(const fs::path& folder) {
    const int file = static_cast<int>(::syscall(SYS_openat, AT_FDCWD, folder.c_str(), O_RDONLY));
    const bool isFree = ::syscall(SYS_flock, file, LOCK_EX | LOCK_NB) == 0;
    ::close(file);
    return !isFree;
  }
};

DiskCalls::DiskCalls() {
  s_calls = this;
}

DiskCalls::~DiskCalls() {
  s_calls = nullptr;
}

std::vector<std::string> DiskCalls::of(const std::string& kind) const {
  std::vector<std::string> found;
  for (const auto& call : m_calls)
    if (call.rfind(kind, 0) == 0) found.push_back(call);
  return found;
}

}  // namespace testing_disk

using testing_disk::DiskCallNotes;
using testing_disk::s_calls;

extern "C" {
#pragma GCC visibility push(default)  // so that libraries call these, too

int fsync(int file) {
  DiskCallNotes::note("sync " + DiskCallNotes::nameOf(file));
  return DiskCallNotes::fails() ? -1 : static_cast<int>(::syscall(SYS_fsync, file));
}

int syncfs(int file) noexcept {
  DiskCallNotes::note("sync all");
  return DiskCallNotes::fails() ? -1 : static_cast<int>(::syscall(SYS_syncfs, file));
}

int rename(const char* from, const char* to) noexcept {
  const int failed = static_cast<int>(::syscall(SYS_renameat, AT_FDCWD, from, AT_FDCWD, to));
  const int error = errno;
  if (s_calls && failed == 0) {
    const std::filesystem::path path = std::filesystem::absolute(to);
    DiskCallNotes::note("rename " + path.filename().string() +
                        (DiskCallNotes::isLocked(path.parent_path()) ? ", locked" : ""));
  }
  errno = error;
  return failed;
}

int renameat2(int a, const char* from, int b, const char* to, unsigned flags) noexcept {
  DiskCallNotes::note("exchange " + std::filesystem::path(to).filename().string());
  if (!s_calls || !s_calls->failExchange)
    return static_cast<int>(::syscall(SYS_renameat2, a, from, b, to, flags));
  errno = EINVAL;
  return -1;
}

int flock(int file, int operation) noexcept {
  if (!s_calls || s_calls->othersLocks == 0)
    return static_cast<int>(::syscall(SYS_flock, file, operation));
  --s_calls->othersLocks;
  errno = EWOULDBLOCK;
  return -1;
}

std::FILE* fopen(const char* file, const char* mode) {
  using Function = std::FILE* (*)(const char*, const char*);
  static const auto real = reinterpret_cast<Function>(::dlsym(RTLD_NEXT, "fopen"));
  DiskCallNotes::note("open " + std::filesystem::path(file).filename().string());
  return real(file, mode);
}

#pragma GCC visibility pop
}  // extern "C"
