#pragma once
/// \file HelpFormatter.h
/// \brief The text of `--help`.

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

namespace polemcl::apps {

/// \brief What helps a user to begin and to go on.
struct Guide {
  std::vector<std::string> examples;  ///< commands to type; tests parse them
  std::string next;                   ///< one sentence or two
};
/// \brief By subcommand; that of the program itself has an empty name.
using Guides = std::map<std::string, Guide>;
/// \brief The end of a help text.
std::string guideText(const Guide& guide);

/// \brief Writes help texts in place of CLI11's, alike with all of its releases: lines of at most
/// 80 characters, required options in the usage, and what each option allows.
class HelpFormatter : public CLI::FormatterBase {
 public:
  /// \param name Program and subcommand, such as `pole-map build`.
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
};

}  // namespace polemcl::apps
