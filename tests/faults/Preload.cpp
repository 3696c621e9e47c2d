// Loaded into the programs (LD_PRELOAD): notes what they do to files below
// POLEMCL_FAULT_ROOT, and lets one call fail, or ends everything before it as a power cut does.
//
// POLEMCL_FAULT is `KIND:NUMBER:ERRNO`: the call of that kind and number fails; with 0 for ERRNO
// the group of processes is killed instead. Kind `change` counts the calls that change names or
// bring something to the disk. POLEMCL_FAULT_LOG gets a line for each call, with inodes for
// folders and for what is replaced or removed; such a file gets a second link in
// POLEMCL_FAULT_KEEP, so that it can be put back.

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

std::string setting(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "";
}

int openQuietly(const std::string& file, int flags) {
  return static_cast<int>(::syscall(SYS_openat, AT_FDCWD, file.c_str(), flags | O_CLOEXEC));
}

/// The number of the call among those that may fail, over all processes.
long countCall() {
  static long* const count = [] {
    const int file = openQuietly(setting("POLEMCL_FAULT_LOG") + ".count", O_RDWR);
    void* const shared = ::mmap(nullptr, sizeof(long), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    ::syscall(SYS_close, file);
    return static_cast<long*>(shared);
  }();
  return __atomic_add_fetch(count, 1, __ATOMIC_SEQ_CST);
}

void note(const std::string& line) {
  const int before = errno;
  const int log = openQuietly(setting("POLEMCL_FAULT_LOG"), O_WRONLY | O_APPEND);
  ::syscall(SYS_write, log, (line + "\n").c_str(), line.size() + 1);
  ::syscall(SYS_close, log);
  errno = before;
}

/// Whether this call shall fail; does not return from a power cut.
bool fails(const char* kind, bool isChange) {
  if (isChange) note("change");
  static const std::string fault = setting("POLEMCL_FAULT");
  char wanted[32];
  long number = 0;
  int error = 0;
  if (std::sscanf(fault.c_str(), "%31[a-z]:%ld:%d", wanted, &number, &error) != 3) return false;
  const bool isMeant =
      std::strcmp(wanted, kind) == 0 || (isChange && std::strcmp(wanted, "change") == 0);
  if (!isMeant || countCall() != number) return false;
  if (error == 0) ::kill(0, SIGKILL);
  errno = error;
  return true;
}

std::string pathOf(int descriptor) {
  char path[4096];
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  const ssize_t length = ::readlink(link.c_str(), path, sizeof path);
  return length > 0 ? std::string(path, static_cast<std::size_t>(length)) : "";
}

std::string absolute(int folder, const std::string& path) {
  if (path.empty() || path[0] == '/') return path;
  return pathOf(folder) + "/" + path;
}

std::string absolute(const std::string& path) {
  char here[4096];
  return path.empty() || path[0] == '/' ? path : ::getcwd(here, sizeof here) + ("/" + path);
}

bool isWatched(const std::string& path) {
  static const std::string root = setting("POLEMCL_FAULT_ROOT") + "/";
  return root.size() > 1 && path.compare(0, root.size(), root) == 0;
}

bool exists(const std::string& path) {
  const int before = errno;
  struct stat status {};
  const bool is = ::lstat(path.c_str(), &status) == 0;
  errno = before;
  return is;
}

std::string inode(const std::string& path) {
  struct stat status {};
  return "\t" + std::to_string(::lstat(path.c_str(), &status) == 0 ? status.st_ino : 0);
}

/// Folder and name of an entry.
std::string entry(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  return inode(path.substr(0, slash)) + "\t" + path.substr(slash + 1);
}

/// A second link to what is about to go. \return Its inode; 0 where nothing is.
std::string keep(const std::string& path) {
  static int number = 0;
  const std::string name = std::to_string(::getpid()) + "-" + std::to_string(++number);
  const int before = errno;
  const std::string link = setting("POLEMCL_FAULT_KEEP") + "/" + name;
  [[maybe_unused]] const int linked = ::link(path.c_str(), link.c_str());  // no folder can be
  const std::string kept = inode(path);
  errno = before;
  return kept;
}

/// One call on a file that changes no name.
template <class Result, class Call>
Result touch(const char* kind, const std::string& path, bool isChange, Result failed, Call call) {
  if (!isWatched(path)) return call();
  if (fails(kind, isChange)) return failed;
  note(kind + inode(path));
  return call();
}

template <class Result, class Call>
Result openFile(const std::string& path, bool writes, Result failed, Call call) {
  if (!isWatched(path)) return call();
  const bool isNew = writes && !exists(path);
  if (fails("open", isNew)) return failed;
  const Result result = call();
  if (result == failed) return failed;
  note("open");
  if (isNew) note("create" + entry(path));
  if (writes) note("dirty" + inode(path));
  return result;
}

template <class Call>
int renameFile(const std::string& from, const std::string& to, unsigned flags, Call call) {
  if (!isWatched(to)) return call();
  if (fails("rename", true)) return -1;
  const bool isExchange = flags == RENAME_EXCHANGE;
  const std::string line = entry(from) + entry(to) + (isExchange ? inode(to) : keep(to));
  const int result = call();
  if (result == 0) note((isExchange ? "exchange" : "rename") + line);
  return result;
}

template <class Call>
int removeFile(const std::string& path, Call call) {
  if (!isWatched(path)) return call();
  if (fails("unlink", true)) return -1;
  const std::string line = entry(path) + keep(path);
  const int result = call();
  if (result == 0) note("unlink" + line);
  return result;
}

}  // namespace

#define REAL(name)                                                                         \
  static const auto real = reinterpret_cast<decltype(&::name)>(::dlsym(RTLD_NEXT, #name)); \
  (void)real

/// The mode of a new file, which open() gets as one more argument.
#define MODE(flags)                                         \
  std::va_list list;                                        \
  va_start(list, flags);                                    \
  const int mode = flags & O_CREAT ? va_arg(list, int) : 0; \
  va_end(list)

#define OPEN(name)                                            \
  int name(const char* path, int flags, ...) {                \
    REAL(name);                                               \
    MODE(flags);                                              \
    return openFile(absolute(path), flags & O_ACCMODE, -1,    \
                    [&] { return real(path, flags, mode); }); \
  }
#define OPENAT(name)                                                                         \
  int name(int folder, const char* path, int flags, ...) {                                   \
    REAL(name);                                                                              \
    MODE(flags);                                                                             \
    return openFile(folder == AT_FDCWD ? absolute(path) : absolute(folder, path),            \
                    flags & O_ACCMODE, -1, [&] { return real(folder, path, flags, mode); }); \
  }
#define FOPEN(name)                                                                         \
  FILE* name(const char* path, const char* mode) {                                          \
    REAL(name);                                                                             \
    return openFile(absolute(path), std::strpbrk(mode, "wa+"), static_cast<FILE*>(nullptr), \
                    [&] { return real(path, mode); });                                      \
  }

extern "C" {
#pragma GCC visibility push(default)

OPEN(open)
OPEN(open64)
OPENAT(openat)
OPENAT(openat64)
FOPEN(fopen)
FOPEN(fopen64)

ssize_t read(int file, void* data, size_t size) {
  REAL(read);
  return touch<ssize_t>("read", pathOf(file), false, -1, [&] { return real(file, data, size); });
}
ssize_t write(int file, const void* data, size_t size) {
  REAL(write);
  return touch<ssize_t>("write", pathOf(file), false, -1, [&] { return real(file, data, size); });
}
ssize_t writev(int file, const iovec* pieces, int count) {
  REAL(writev);
  return touch<ssize_t>("write", pathOf(file), false, -1,
                        [&] { return real(file, pieces, count); });
}
int fsync(int file) {
  REAL(fsync);
  return touch("fsync", pathOf(file), true, -1, [&] { return real(file); });
}
int syncfs(int file) noexcept {
  REAL(syncfs);
  return touch("syncfs", pathOf(file), true, -1, [&] { return real(file); });
}
int close(int file) {
  REAL(close);
  const std::string path = pathOf(file);
  const int result = real(file);
  return touch("close", path, false, -1, [&] { return result; });
}
int fclose(FILE* file) {
  REAL(fclose);
  const std::string path = pathOf(::fileno(file));
  const int result = real(file);
  return touch("close", path, false, EOF, [&] { return result; });
}
int mkdir(const char* path, mode_t mode) noexcept {
  REAL(mkdir);
  const std::string folder = absolute(path);
  if (!isWatched(folder)) return real(path, mode);
  if (fails("mkdir", true)) return -1;
  const int result = real(path, mode);
  if (result == 0) note("mkdir" + entry(folder));
  return result;
}
int rename(const char* from, const char* to) noexcept {
  REAL(rename);
  return renameFile(absolute(from), absolute(to), 0, [&] { return real(from, to); });
}
int renameat2(int a, const char* from, int b, const char* to, unsigned flags) noexcept {
  REAL(renameat2);
  return renameFile(absolute(from), absolute(to), flags,
                    [&] { return real(a, from, b, to, flags); });
}
int unlink(const char* path) noexcept {
  REAL(unlink);
  return removeFile(absolute(path), [&] { return real(path); });
}
int remove(const char* path) noexcept {
  REAL(remove);
  return removeFile(absolute(path), [&] { return real(path); });
}
int unlinkat(int folder, const char* path, int flags) noexcept {
  REAL(unlinkat);
  return removeFile(folder == AT_FDCWD ? absolute(path) : absolute(folder, path),
                    [&] { return real(folder, path, flags); });
}

#pragma GCC visibility pop
}
