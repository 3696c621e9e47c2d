#pragma once
/// \file ManPage.h
/// \brief Man pages of section 1, from the declarations of options.

#include <CLI/CLI.hpp>
#include <string>

namespace polemcl::apps {

/// \brief The page of a program or a subcommand, for troff's man macros.
/// \param name With the program's, such as `pole-map build`. \param date Day of the page,
/// YYYY-MM-DD.
std::string manPage(const CLI::App& app, const std::string& name, const std::string& date);

/// \brief The name of a page: `pole-map-build` for `pole-map build`.
std::string manPageName(std::string name);

}  // namespace polemcl::apps
