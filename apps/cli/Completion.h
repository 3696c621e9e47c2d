#pragma once
/// \file Completion.h
/// \brief Completion of command lines for bash, from the declarations of options.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace polemcl::apps {

/// \brief What a program or a subcommand takes, as one row of the script of completion().
/// \param name With the program's, such as `pole-map build`.
std::string completionRow(const CLI::App& app, const std::string& name);

/// \brief The script for bash: completes subcommands, options, words that options allow, files,
/// folders, and the names of installed settings.
/// \param programs Their names. \param rows One for each program and subcommand.
std::string completion(const std::vector<std::string>& programs, const std::string& rows);

}  // namespace polemcl::apps
