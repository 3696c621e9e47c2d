/// \file HelpTexts.cpp
/// \brief Writes the help texts of all programs and their subcommands into a folder, for main.cpp.
/// The build runs it. Usage: write-help-texts FOLDER

#include <filesystem>
#include <fstream>
#include <iostream>
#include <regex>
#include <sstream>
#include <string>

#include "cli/Programs.h"

namespace {

using polemcl::apps::Program;

/// What a program prints for `--help`, or for `COMMAND --help`.
std::string helpOf(const Program& program, const std::string& command) {
  std::ostringstream text;
  std::streambuf* const before = std::cout.rdbuf(text.rdbuf());
  const char* const whole[] = {program.name, "--help", nullptr};
  const char* const part[] = {program.name, command.c_str(), "--help", nullptr};
  if (command.empty())
    program.main(2, whole);
  else
    program.main(3, part);
  std::cout.rdbuf(before);
  return text.str();
}

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file);
  out << text;
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  for (const Program& program : polemcl::apps::programs()) {
    const std::string text = helpOf(program, "");
    write(folder / (std::string(program.name) + ".txt"), text);
    const std::size_t commands = text.find("\nSubcommands:\n");
    if (commands == std::string::npos) continue;
    const std::string list = text.substr(commands);
    const std::regex line("\n  ([a-z-]+) ");
    for (std::sregex_iterator it(list.begin(), list.end(), line), end; it != end; ++it) {
      const std::string command = (*it)[1];
      write(folder / (std::string(program.name) + "-" + command + ".txt"),
            helpOf(program, command));
    }
  }
}
