#include "cli/Messages.h"

#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <new>
#include <string_view>
#include <system_error>

#include "cli/CommandLine.h"
#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace {

std::string s_verboseProgram;  // empty: not verbose

std::string_view environment(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "";
}

constexpr const char* kNoMemory =
    "there is not enough memory; end other programs, or raise its limit (ulimit -v)";
const char* s_program = "";
std::atomic<bool> s_hasFailed{false};  ///< and has said why

/// Without memory: no strings.
void write(const char* text) {
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text, std::strlen(text));
}

[[noreturn]] void endInOneLine() {
  if (s_hasFailed.exchange(true)) std::_Exit(exitFailed);
  write(s_program);
  write(": ");
  try {
    if (const auto uncaught = std::current_exception()) std::rethrow_exception(uncaught);
    write("failed for an unknown reason");
  } catch (const std::bad_alloc&) {
    write(kNoMemory);
  } catch (const std::exception& error) {
    write(error.what());
  } catch (...) {
    write("failed for an unknown reason");
  }
  write("\n");
  std::_Exit(exitFailed);
}

bool isLackOfThreads(const std::exception& error) {
  const auto* const failure = dynamic_cast<const std::system_error*>(&error);
  return failure && failure->code().value() == EAGAIN &&
         !dynamic_cast<const std::filesystem::filesystem_error*>(&error);
}

}  // namespace

bool errorsAreOnTerminal() {
  return ::isatty(STDERR_FILENO) == 1;
}

std::string coloured(Colour colour, const std::string& text) {
  if (!errorsAreOnTerminal() || !environment("NO_COLOR").empty() || environment("TERM") == "dumb")
    return text;
  const char* const code = colour == Colour::red ? "31" : colour == Colour::yellow ? "33" : "32";
  return std::string("\033[") + code + "m" + text + "\033[0m";
}

std::string warningLine(const std::string& program, const std::string& text) {
  return program + ": " + coloured(Colour::yellow, "warning:") + " " + text;
}

void setVerbose(const std::string& program, bool verbose) {
  s_verboseProgram = verbose ? program : "";
}

void sayDetail(const std::string& text) {
  if (s_verboseProgram.empty()) return;
  std::cerr << s_verboseProgram + ": " + text + '\n' << std::flush;
}

std::string resourcesTaken(double seconds) {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  // Linux counts in units of 1024 bytes.
  return io::fixed(seconds, 1) + " s, at most " +
         io::fixed(static_cast<double>(usage.ru_maxrss) * 1024 / 1e6, 0) + " MB of memory";
}

std::string reasonOf(const std::exception& error) {
  const std::string what = error.what(), noMemory = "std::bad_alloc";
  if (isLackOfThreads(error)) return "no thread can be started: " + what;
  const auto at = what.find(noMemory);  // also where others put a place before it
  return at == std::string::npos
             ? what
             : what.substr(0, at) + kNoMemory + what.substr(at + noMemory.size());
}

void sayFailure(const std::string& program, const std::string& text) {
  s_hasFailed = true;
  std::cerr << program << ": " << coloured(Colour::red, text) << '\n';
}

void endUncaughtInOneLine(const char* path) {
  const char* const slash = std::strrchr(path, '/');
  s_program = slash ? slash + 1 : path;
  s_hasFailed = false;
  std::set_terminate(endInOneLine);
}

}  // namespace polemcl::apps
