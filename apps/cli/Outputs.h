#pragma once
/// \file Outputs.h
/// \brief Files that a program writes, told apart from those that it reads.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cli/CommandLine.h"

namespace polemcl::apps {

/// \brief A new program begins: the options of the one before it are gone.
void forgetOutputs();
/// \brief Notes that the value of an option names a file to write. \param beside What is written
/// beside a file `S.rawlog`, such as `.tum` for `S.tum`.
CLI::Option* markOutput(CLI::Option* option, const std::vector<std::string>& beside = {});
/// \brief addFile() and markOutput().
template <class Path>
CLI::Option* addOutput(CLI::App& cli, const std::string& flag, Path& value,
                       const std::string& meaning) {
  return markOutput(addFile(cli, flag, value, meaning));
}

/// \name Checks of a parsed command line, before anything is read
/// @{
/// \throws CLI::ValidationError when two outputs have one name: one of them would be lost.
void requireDistinctOutputs(const CLI::App& cli);
/// \brief Options that addFile(), addFolder() and addConfigOption() declared and that are not
/// marked are inputs. \throws Error when a file to write is also read, except a map that `pole-map`
/// continues (`--add`, `--map`) or converts, which `--output` may replace.
void requireInputsKept(const CLI::App& cli);
/// @}

}  // namespace polemcl::apps
