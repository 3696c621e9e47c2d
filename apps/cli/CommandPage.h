#pragma once
/// \file CommandPage.h
/// \brief Pages of the documentation that list the options of a program, from their declarations.

#include <CLI/CLI.hpp>
#include <string>

namespace polemcl::apps {

/// \brief The page of a program with all its subcommands, in Markdown.
std::string commandPage(const CLI::App& app);

}  // namespace polemcl::apps
