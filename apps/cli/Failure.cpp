#include "cli/Failure.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <new>
#include <system_error>

#include "cli/CommandLine.h"
#include "cli/Messages.h"

namespace polemcl::apps {
namespace {

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
