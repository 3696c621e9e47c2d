#pragma once
/// \file Programs.h
/// \brief All programs by their names: what the module of the programs offers.

#include <array>

namespace polemcl::apps {

/// \brief A program's main function. \return An ExitCode.
using ProgramMain = int (*)(int argc, const char* const* argv);

struct Program {
  const char* name;  ///< as the user types it
  ProgramMain main;
};
const std::array<Program, 8>& programs();

/// \brief Name and type of the function of the module that runs one of the programs.
constexpr const char* programModule = "libpolemcl-programs.so";
constexpr const char* programEntry = "polemclRunProgram";
using ProgramEntry = int (*)(const char* name, int argc, const char* const* argv);

}  // namespace polemcl::apps
