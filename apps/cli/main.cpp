/// \file main.cpp
/// \brief The main function of each program, POLEMCL_PROGRAM. Loading MRPT takes a third of
/// a second; `--version` and `--help` need none of it. Everything else is in a module, loaded when
/// needed.

#include <dlfcn.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include "cli/Programs.h"
#include "cli/Version.h"
#include "io/file/InstalledFiles.h"

namespace {

/// Name of the text that the arguments ask for, such as `pole-map-build.txt` for `build --help`;
/// empty when they ask for something else.
std::string helpText(int argc, const char* const* argv) {
  const std::string last = argv[argc - 1];
  if (argc < 2 || argc > 3 || (last != "--help" && last != "-h")) return "";
  const std::string program = POLEMCL_PROGRAM;
  if (argc == 2) return program + ".txt";
  const std::string command = argv[1];
  const bool isWord = command.find_first_not_of("abcdefghijklmnopqrstuvwxyz-") == command.npos;
  return isWord && command[0] != '-' ? program + "-" + command + ".txt" : "";
}

/// Prints the answer when the arguments ask for nothing but the version or a help text.
bool answered(int argc, const char* const* argv) {
  if (argc == 2 && std::string(argv[1]) == "--version") {
    std::cout << polemcl::apps::versionLine(POLEMCL_PROGRAM) << std::endl;
    return true;
  }
  const std::string name = helpText(argc, argv);
  if (name.empty()) return false;
  const std::filesystem::path file = polemcl::io::installedFile(name, "help");
  std::ifstream text(file);
  if (!file.is_absolute() || !text) return false;  // the module knows it, too
  std::cout << text.rdbuf() << std::flush;
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && answered(argc, argv)) return 0;
  const std::string file = polemcl::io::installedModule(polemcl::apps::programModule).string();
  void* const module = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);
  void* const entry = module ? dlsym(module, polemcl::apps::programEntry) : nullptr;
  if (!entry) {
    std::cerr << POLEMCL_PROGRAM << ": cannot be loaded: " << dlerror() << '\n';
    return 1;
  }
  return reinterpret_cast<polemcl::apps::ProgramEntry>(entry)(POLEMCL_PROGRAM, argc, argv);
}
