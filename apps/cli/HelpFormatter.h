#pragma once
/// \file HelpFormatter.h
/// \brief The text of `--help`.

#include <CLI/CLI.hpp>
#include <string>

namespace polemcl::apps {

/// \brief Writes help texts in place of CLI11's: what it does, how to call it, options, examples,
/// and what to do next (guideOf()). No line is longer than 80 characters, but for examples.
class HelpFormatter : public CLI::FormatterBase {
 public:
  /// \param name Program and subcommand, such as `pole-map build`.
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
};

}  // namespace polemcl::apps
