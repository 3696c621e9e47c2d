#include "io/file/Process.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>

#include <polemcl/core/common/Types.h>
#include "io/file/Bytes.h"
#include "io/file/InstalledFiles.h"

namespace polemcl::io {

namespace fs = std::filesystem;

namespace {

constexpr const char* kPython = "/usr/bin/python3";  // the one that Debian's packages are for
constexpr int kNotStarted = 127;  ///< exit code of a child that could not become its program

/// A file that is open.
class OpenFile {
 public:
  OpenFile(int number, const std::string& name) : m_number(number) {
    if (number < 0) throw Error(name + ": cannot be opened: " + std::strerror(errno));
  }
  ~OpenFile() { ::close(m_number); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  int number() const { return m_number; }
  /// Opens it anew, from its beginning.
  fs::path path() const { return "/proc/self/fd/" + std::to_string(m_number); }

 private:
  int m_number;
};

/// A file in memory, which ends with the process.
class MemoryFile : public OpenFile {
 public:
  explicit MemoryFile(const char* name) : OpenFile(::memfd_create(name, MFD_CLOEXEC), name) {}
};

using Streams = std::array<int, 3>;  ///< standard input, output, errors

/// In the child: becomes the program, or ends. Only calls that are safe after a fork of a program
/// with threads.
[[noreturn]] void become(const char* program, char* const* arguments, const char* folder,
                         const Streams& streams, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // without its parent nobody waits for it
  if (::getppid() == parent && ::dup2(streams[0], STDIN_FILENO) >= 0 &&
      ::dup2(streams[1], STDOUT_FILENO) >= 0 && ::dup2(streams[2], STDERR_FILENO) >= 0 &&
      ::chdir(folder) == 0)
    ::execv(program, arguments);
  ::_exit(kNotStarted);
}

/// \return What the program ended with, as waitpid() has it.
int spawn(const std::vector<std::string>& command, const fs::path& folder, const Streams& streams) {
  const std::string& program = command.front();
  if (::access(program.c_str(), X_OK) != 0)
    throw Error(program + ": cannot be started: " + std::strerror(errno));
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const auto& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  const pid_t parent = ::getpid(), child = ::fork();
  if (child < 0) throw Error(program + ": cannot be started: " + std::strerror(errno));
  if (child == 0) become(program.c_str(), arguments.data(), folder.c_str(), streams, parent);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) throw Error(program + ": cannot be waited for: " + std::strerror(errno));
  if (WIFEXITED(status) && WEXITSTATUS(status) == kNotStarted)
    throw Error(program + ": cannot be started in " + folder.string());
  return status;
}

/// The last line that a program wrote, but for the hint after wrong usage: its error. Empty where
/// that is the command itself.
std::string lastLine(const fs::path& said) {
  std::ifstream stream(said);
  std::string line, last;
  while (std::getline(stream, line))
    if (!line.empty() && line.rfind("Try `", 0) != 0) last = line;
  return last.rfind("$ ", 0) == 0 ? "" : last;
}

void requireSuccess(const fs::path& program, int status, const fs::path& said) {
  const std::string name = program.filename().string();
  if (WIFSIGNALED(status))
    throw Error(name + " was ended by signal " + std::to_string(WTERMSIG(status)) + " (" +
                strsignal(WTERMSIG(status)) + ")");
  if (WEXITSTATUS(status) == 0) return;
  const std::string line = lastLine(said);
  throw Error(line.empty() ? name + " ended with exit code " + std::to_string(WEXITSTATUS(status))
                           : line);
}

}  // namespace

std::vector<std::string> pythonScript(const std::string& name) {
  const fs::path script = fileOfDataFolder(name, "report");
  if (script.empty()) throw Error("report/" + name + " is not among the installed files");
  if (::access(kPython, X_OK) != 0)
    throw Error(std::string(kPython) + " is missing; install the package python3-matplotlib");
  return {kPython, "-B", fs::absolute(script)};
}

void runLogged(const std::vector<std::string>& command, const fs::path& folder,
               const fs::path& log) {
  const OpenFile nothing(::open("/dev/null", O_RDONLY | O_CLOEXEC), "/dev/null");
  const OpenFile said(::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666),
                      log.string());
  const int status = spawn(command, folder, {nothing.number(), said.number(), said.number()});
  requireSuccess(command.front(), status, log);
}

std::string runFilter(const std::vector<std::string>& command, const std::string& input) {
  const MemoryFile in("input"), out("output"), said("errors");
  std::ofstream stream(in.path(), std::ios::binary);
  stream << input;
  if (!stream.flush()) throw Error(command.front() + ": no memory for its input");
  const int status = spawn(command, ".", {in.number(), out.number(), said.number()});
  requireSuccess(command.front(), status, said.path());
  return readBytes(out.path());
}

}  // namespace polemcl::io
