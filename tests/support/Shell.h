#pragma once
// Runs commands of the shell, also on a terminal.

#include <cstdio>
#include <string>

#include "support/TempFolder.h"

namespace testing_apps {

/// What a command prints, on both streams, and the number it ends with.
inline Outcome shell(const std::string& command) {
  Outcome outcome;
  std::FILE* pipe = popen(("{ " + command + "\n} 2>&1").c_str(), "r");
  if (!pipe) return outcome;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe))
    outcome.out += static_cast<char>(c);
  outcome.code = pclose(pipe) >> 8;
  return outcome;
}

/// The same with a pseudo terminal for all streams. \param command Without single quotes.
inline Outcome onTerminal(const std::string& command) {
  return shell("script --quiet --return --command '" + command + "' /dev/null </dev/null");
}

/// Whether a pseudo terminal can be had: not in a root folder without /dev/pts.
inline bool terminalsExist() {
  return onTerminal("true").code == 0;
}

}  // namespace testing_apps
