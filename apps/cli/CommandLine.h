#pragma once
/// \file CommandLine.h
/// \brief The frame every program stands in: parse, run, catch; exit codes; common flags.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cli/HelpFormatter.h"

namespace polemcl::apps {

/// \brief What a program ends with.
enum ExitCode : int {
  exitDone = 0,
  exitFailed = 1,  ///< one line on stderr: what, where, what is allowed
  exitUsage = 2    ///< wrong usage: unknown or missing options, values of the wrong type
};

/// \brief A declared subcommand and what it does once parsed: returns the text for the user, shows
/// its progress unless quiet.
struct Subcommand {
  const CLI::App* parser = nullptr;
  std::function<std::string(bool quiet)> run;
};

/// \brief Declares `--help`, `--version`, `--quiet`, `--verbose` and `--threads`; the program
/// declares the rest on `cli()`.
///
/// Use: declare options on `cli()`, then `return line.run(argc, argv, [&] { work(options); });`.
/// `--quiet` also works behind a subcommand. Where a program declares `--config`, run() adds
/// `--print-config` and `--all`.
class CommandLine {
 public:
  /// \param program Name as the user types it, such as `pole-map`.
  /// \param description One sentence for `--help`. \param guides For `--help` of all subcommands.
  CommandLine(const std::string& program, const std::string& description, Guides guides = {});

  /// \brief CLI11's application, to declare options and subcommands on.
  CLI::App& cli() { return m_cli; }
  /// \brief True after parsing when the user wants nothing on stdout and no progress bar.
  bool quiet() const { return m_quiet; }

  /// \brief Parses the arguments, then calls `work` with everything that can throw caught.
  /// \return An ExitCode. Usage errors and failures are printed on stderr, `--help` and `--version`
  ///         on stdout; nothing escapes as an exception.
  int run(int argc, const char* const* argv, const std::function<void()>& work);
  /// \brief The same for a program of subcommands: runs the one that was given, prints its text.
  int run(int argc, const char* const* argv, const std::vector<Subcommand>& commands);

 private:
  int usageError(const std::string& what) const;
  int work(const std::function<void()>& work) const;

  std::string m_program;
  CLI::App m_cli;
  Guides m_guides;
  bool m_quiet = false, m_verbose = false;
  int m_threads = 0;  ///< at most; 0: one for each core
};

/// \brief Options for files and folders, in place of CLI11's add_option(): completion and `--help`
/// tell them apart.
template <class Path>
CLI::Option* addFile(CLI::App& cli, const std::string& flag, Path& value,
                     const std::string& meaning) {
  return cli.add_option(flag, value, meaning)->type_name("FILE");
}
template <class Path>
CLI::Option* addFolder(CLI::App& cli, const std::string& flag, Path& value,
                       const std::string& meaning) {
  return cli.add_option(flag, value, meaning)->type_name("FOLDER");
}

/// \brief Declares `--config INI`. \param purpose What of the settings is used, if not all.
template <class Path>
CLI::Option* addConfigOption(CLI::App& cli, Path& value, const std::string& purpose = "") {
  return cli
      .add_option("--config", value,
                  "Settings" + purpose + ": a file, or an installed one such as hdl32e.ini")
      ->type_name("INI");
}

/// \brief An option for one of some words, each of which stands for a value.
template <class Value>
CLI::Option* addChoice(CLI::App& cli, const std::string& flag, Value& value,
                       const std::vector<std::pair<std::string, Value>>& choices,
                       const std::string& meaning) {
  std::vector<std::string> words;
  words.reserve(choices.size());
  for (const auto& choice : choices) words.push_back(choice.first);
  return cli
      .add_option_function<std::string>(
          flag,
          [&value, choices](const std::string& word) {
            for (const auto& choice : choices)
              if (choice.first == word) value = choice.second;
          },
          meaning)
      ->check(CLI::IsMember(words));
}

/// \brief The default of an option that takes the place of a setting: "[runs] runs, else 1".
template <class Number>
std::string unlessSet(const std::string& setting, const Number& value) {
  std::ostringstream text;
  text << setting << ", else " << value;
  return text.str();
}

/// \brief Declares `--set SECTION.KEY=VALUE`, which may be given several times.
void addSetOption(CLI::App& cli, std::vector<std::string>& assignments);

/// \brief Check of an option: a number above 0 and up to 1e6. (CLI11's own takes nan.)
CLI::Validator positiveNumber();

/// \brief An option for a number that passes the check; `--help` shows its default.
template <class Number>
CLI::Option* addNumber(CLI::App& cli, const std::string& flag, Number& value,
                       const std::string& meaning, const CLI::Validator& check) {
  return cli.add_option(flag, value, meaning)->check(check)->capture_default_str();
}

/// \brief The message of an exception on one line: MRPT's call stacks are left out, other line
/// breaks become spaces, what is no UTF-8 or controls terminals question marks.
std::string oneLine(const std::string& message);

}  // namespace polemcl::apps
