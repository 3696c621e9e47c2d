#include "cli/Messages.h"

#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <iostream>
#include <string_view>

#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace {

std::string s_verboseProgram;  // empty: not verbose

std::string_view environment(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "";
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

}  // namespace polemcl::apps
