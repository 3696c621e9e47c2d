#pragma once
/// \file OptionText.h
/// \brief What `--help`, man pages and completion say of an option, from its declaration.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace polemcl::apps {

/// \brief An option in words.
struct OptionText {
  std::vector<std::string> names;    ///< such as `-h`, `--help`; one without dashes: an argument
  std::string value;                 ///< such as `FILE`, `N`, `robot|sensor`; empty: a flag
  bool many = false;                 ///< takes several values
  bool required = false;             ///< must be given
  std::vector<std::string> choices;  ///< allowed words; empty: others are allowed
  std::string meaning;  ///< with what is allowed, the default, and which options go together

  /// \brief Such as `-h, --help` or `--input FILE...`.
  std::string head() const;
};
OptionText describe(const CLI::Option& option);

/// \brief The options of a program or a subcommand, in the order of their declaration.
/// \param positional True: the arguments without a name; false: the others.
std::vector<OptionText> optionsOf(const CLI::App& app, bool positional);
/// \brief What a subcommand takes from its program, such as `--quiet`; empty for programs.
std::vector<OptionText> sharedOptions(const CLI::App& app);

/// \brief The subcommands of a program, in the order of their declaration.
std::vector<CLI::App*> subcommandsOf(CLI::App& app);
std::vector<const CLI::App*> subcommandsOf(const CLI::App& app);

/// \brief How to call it: `pole-map diff before after [OPTIONS]`. \param name With the program's.
std::string usageOf(const CLI::App& app, const std::string& name);

}  // namespace polemcl::apps
