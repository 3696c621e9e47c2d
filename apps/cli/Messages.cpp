#include "cli/Messages.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
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

/// Whether a character moves the cursor, starts a command of the terminal, or turns the direction
/// of the text. \param text One character of UTF-8.
bool controlsTerminal(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (text.size() == 1)
    return (byte(0) < 0x20 && byte(0) != '\n' && byte(0) != '\t') || byte(0) == 0x7f;
  if (text.size() == 2) return byte(0) == 0xC2 && byte(1) < 0xA0;  // U+0080 to U+009F
  if (text.size() != 3 || byte(0) != 0xE2) return false;
  const int last = (byte(1) & 0x3F) << 6 | (byte(2) & 0x3F);  // of U+2xxx
  return last == 0x0E || last == 0x0F || (last >= 0x28 && last <= 0x2E) ||
         (last >= 0x66 && last <= 0x69);
}

}  // namespace

std::string printable(std::string_view text) {
  std::string clean;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = io::characterLength(text, at);
    const bool isGood = length > 0 && !controlsTerminal(text.substr(at, length));
    clean += isGood ? text.substr(at, length) : "?";
    at += std::max<std::size_t>(1, length);
  }
  return clean;
}

PrintableOutput::PrintableOutput(std::ostream& stream)
    : m_stream(stream), m_target(stream.rdbuf(this)) {}

PrintableOutput::~PrintableOutput() {
  sync();
  m_stream.rdbuf(m_target);
}

int PrintableOutput::overflow(int next) {
  if (next == traits_type::eof()) return 0;
  m_text += static_cast<char>(next);
  return next == '\n' && sync() < 0 ? traits_type::eof() : next;
}

int PrintableOutput::sync() {
  const std::string clean = printable(m_text);
  m_text.clear();
  const auto size = static_cast<std::streamsize>(clean.size());
  return m_target->sputn(clean.data(), size) == size ? m_target->pubsync() : -1;
}

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
  return program + ": " + coloured(Colour::yellow, "warning:") + " " + printable(text);
}

void setVerbose(const std::string& program, bool verbose) {
  s_verboseProgram = verbose ? program : "";
}

void sayDetail(const std::string& text) {
  if (s_verboseProgram.empty()) return;
  std::cerr << s_verboseProgram + ": " + printable(text) + '\n' << std::flush;
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
