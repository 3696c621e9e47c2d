/// \file Main.cpp
/// \brief The program of all fuzzers, with libFuzzer's options and three more:
/// `--target=NAME` says which reader; `--list` prints the names; `--seeds=FOLDER` writes first
/// inputs, a folder for each target. A report of a sanitizer, and an exception other than Error,
/// end it; libFuzzer keeps the input.

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <new>

#include <polemcl/core/common/Types.h>
#include "fuzz/Fuzz.h"

namespace {

using polemcl::fuzz::Target;

const Target* chosen = nullptr;
std::FILE* report = nullptr;  ///< standard error, which libFuzzer closes to silence the readers

const std::vector<Target>& allTargets() {
  using namespace polemcl::fuzz;
  static const std::vector<Target> targets = [] {
    std::vector<Target> all;
    for (const auto& some :
         {tableTargets(), mapTargets(), settingTargets(), scanTargets(), bagTargets(),
          folderTargets(), mrptTargets(), liveTargets(), receiverTargets(), methodTargets()})
      all.insert(all.end(), some.begin(), some.end());
    return all;
  }();
  return targets;
}

void writeSeeds(const std::filesystem::path& folder) {
  for (const Target& target : allTargets()) {
    std::filesystem::create_directories(folder / target.name);
    int number = 0;
    for (const std::string& seed : target.seeds())
      std::ofstream(folder / target.name / ("seed" + std::to_string(number++)), std::ios::binary)
          << seed;
  }
}

/// The value of an option `--NAME=`; null if this is another one.
const char* valueOf(const char* argument, const char* option) {
  const std::size_t length = std::strlen(option);
  return std::strncmp(argument, option, length) == 0 ? argument + length : nullptr;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  for (int i = 1; i < *argc; ++i) {
    const char* argument = (*argv)[i];
    if (std::strcmp(argument, "--list") == 0) {
      for (const Target& target : allTargets()) std::puts(target.name);
      std::exit(0);
    }
    if (const char* folder = valueOf(argument, "--seeds=")) {
      writeSeeds(folder);
      std::exit(0);
    }
    if (const char* name = valueOf(argument, "--target="))
      for (const Target& target : allTargets())
        if (std::strcmp(target.name, name) == 0) chosen = &target;
  }
  if (chosen == nullptr) {
    std::fputs("fuzz: --target=NAME must name one of --list\n", stderr);
    std::exit(2);
  }
  report = fdopen(dup(STDERR_FILENO), "w");
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  try {
    chosen->read({reinterpret_cast<const char*>(bytes), size});
  } catch (const polemcl::Error&) {
  } catch (const std::exception& error) {
    std::fprintf(report, "fuzz: not an Error: %s\n", error.what());
    std::fflush(report);
    std::abort();
  }
  return 0;
}

// LimitedNew.cpp bounds `new`, which the C++ library's `new[]` calls; that of the sanitizer does
// not.
void* operator new[](std::size_t size) {
  return operator new(size);
}
void operator delete[](void* memory) noexcept {
  operator delete(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  operator delete(memory);
}
