#include "cli/CommandLine.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <iostream>
#include <memory>
#include <optional>

#include <polemcl/mrpt/common/RegisterClasses.h>
#include "cli/HelpFormatter.h"
#include "cli/Messages.h"
#include "cli/OptionText.h"
#include "cli/Outputs.h"
#include "cli/Progress.h"
#include "cli/Settings.h"
#include "cli/Version.h"
#include "core/common/Binder.h"
#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace {

constexpr double s_largest = 1e6;  // of metres, seconds and the like

const std::function<void(CLI::App&)>* s_visitor = nullptr;  // of visitOptions()

/// What broken files bring into messages becomes question marks.
std::string printable(const std::string& text) {
  std::string clean;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = io::characterLength(text, at);
    const bool isControl = (text[at] >= 0 && text[at] < 0x20) || text[at] == 0x7f;
    clean += length > 0 && !isControl ? text.substr(at, length) : "?";
    at += std::max<std::size_t>(1, length);
  }
  return clean;
}

bool lacksSubcommand(const CLI::App& cli) {
  return cli.get_require_subcommand_min() > 0 && cli.get_subcommands().empty();
}

std::string subcommandNames(const CLI::App& cli) {
  std::string names;
  for (const CLI::App* command : subcommandsOf(cli))
    names += (names.empty() ? "" : ", ") + command->get_name();
  return names;
}

/// Declares `--print-config` where `--config` is declared; whether it is anywhere.
bool offerPrintConfig(CLI::App& app) {
  bool offered = app.get_option_no_throw("--config") != nullptr;
  if (offered && app.get_option_no_throw("--print-config") == nullptr) {
    auto* print = app.add_flag("--print-config", "Print the effective settings, and end");
    app.add_flag("--all", "Print the expert settings, too")->needs(print);
  }
  for (CLI::App* below : app.get_subcommands({})) offered |= offerPrintConfig(*below);
  return offered;
}

/// What `--print-config` prints.
struct PrintRequest {
  std::string config;
  std::vector<std::string> assignments;
  bool all = false;
};

/// The request of a command line, if it has one. Its other arguments do not matter, so that none of
/// them is required. \throws CLI::ParseError without `--config`.
std::optional<PrintRequest> printRequest(int argc, const char* const* argv) {
  const auto isRequest = [](const char* argument) {
    return std::string(argument) == "--print-config";
  };
  if (std::none_of(argv, argv + argc, isRequest)) return std::nullopt;
  CLI::App cli;
  PrintRequest request;
  cli.allow_extras();
  cli.add_option("--config", request.config)->required();
  addSetOption(cli, request.assignments);
  cli.add_flag("--print-config");
  cli.add_flag("--all", request.all);
  cli.parse(argc, argv);
  return request;
}

void printConfig(const PrintRequest& request) {
  std::cout << settingsText(loadSettings(request.config, request.assignments),
                            request.all ? Tier::expert : Tier::tuning);
}

/// The message of a wrong command line; where values are missing or too many, also what the option
/// takes.
std::string explained(const CLI::App& cli, const CLI::ParseError& error) {
  const std::string what = error.what();
  if (error.get_name() != "ArgumentMismatch") return what;
  const std::string name = what.substr(0, what.find(':'));
  auto apps = cli.get_subcommands();
  apps.insert(apps.begin(), const_cast<CLI::App*>(&cli));
  for (const auto* app : apps)
    if (const auto* option = app->get_option_no_throw(name))
      return what + "; it takes " + option->get_type_name();
  return what;
}

}  // namespace

CommandLine::CommandLine(const std::string& program, const std::string& description)
    : m_program(program), m_cli(description, program) {
  forgetOutputs();
  m_cli.formatter(std::make_shared<HelpFormatter>());
  m_cli.set_help_flag("-h,--help", "Print this help, and end");
  m_cli.set_version_flag("--version", versionLine(program), "Print version and build, and end");
  auto* quiet = m_cli.add_flag("--quiet", m_quiet, "Print nothing but errors and warnings");
  m_cli
      .add_flag("--verbose", m_verbose,
                "Say which build, settings and threads are used, and how long it took; show MRPT's "
                "errors in full")
      ->excludes(quiet);
  addNumber(m_cli, "--threads", m_threads, "Number of threads at most; 0: one for each core",
            CLI::Range(0, 10000));
  // So that `pole-eval map --quiet` works as well as `pole-eval --quiet map`.
  m_cli.fallthrough();
}

int CommandLine::usageError(const std::string& what) const {
  std::cerr << m_program << ": " << coloured(Colour::red, oneLine(what)) << "\nTry `" << m_program
            << " --help`.\n";
  return exitUsage;
}

int CommandLine::run(int argc, const char* const* argv, const std::function<void()>& work) {
  std::optional<PrintRequest> request;
  try {
    const bool offered = offerPrintConfig(m_cli);
    if (s_visitor) {
      (*s_visitor)(m_cli);
      return exitDone;
    }
    if (offered) request = printRequest(argc, argv);
    if (!request) m_cli.parse(argc, argv);
    requireDistinctOutputs(m_cli);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() != static_cast<int>(CLI::ExitCodes::Success))
      return usageError(lacksSubcommand(m_cli) ? "a subcommand is needed: " + subcommandNames(m_cli)
                                               : explained(m_cli, e));
    m_cli.exit(e);  // prints what --help or --version ask for
    return exitDone;
  }
  return this->work([&] {
    requireInputsKept(m_cli);
    request ? printConfig(*request) : work();
  });
}

int CommandLine::work(const std::function<void()>& work) const {
  registerClasses();
  std::optional<tbb::global_control> limit;
  if (m_threads > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism,
                  static_cast<std::size_t>(m_threads));
  setVerbose(m_program, m_verbose);
  const auto begin = std::chrono::steady_clock::now();
  sayDetail(versionLine(m_program));
  sayDetail("threads: at most " + std::to_string(tbb::global_control::active_value(
                                      tbb::global_control::max_allowed_parallelism)));
  try {
    work();
    sayDetail("took " + resourcesTaken(secondsSince(begin)));
    return exitDone;
  } catch (const std::exception& e) {
    if (oneLine(e.what()) != e.what()) sayDetail(std::string("in full: ") + e.what());
    std::cerr << m_program << ": " << coloured(Colour::red, oneLine(e.what())) << '\n';
  } catch (...) {
    std::cerr << m_program << ": " << coloured(Colour::red, "failed for an unknown reason") << '\n';
  }
  return exitFailed;
}

int CommandLine::run(int argc, const char* const* argv, const std::vector<Subcommand>& commands) {
  m_cli.require_subcommand(1);
  return run(argc, argv, [&] {
    for (const Subcommand& command : commands) {
      if (!command.parser->parsed()) continue;
      const std::string text = command.run(m_quiet);
      if (!m_quiet) std::cout << text;
    }
  });
}

void visitOptions(int (*program)(int argc, const char* const* argv), const char* name,
                  const std::function<void(CLI::App&)>& visit) {
  s_visitor = &visit;
  const char* const argv[] = {name, nullptr};
  program(1, argv);
  s_visitor = nullptr;
}

void addSetOption(CLI::App& cli, std::vector<std::string>& assignments) {
  cli.add_option("--set", assignments, "Replaces a setting of the INI file; may be repeated")
      ->type_name("SECTION.KEY=VALUE")
      ->take_all()
      ->expected(1);
}

CLI::Validator positiveNumber() {
  return {
      [](std::string& text) {
        double value = 0;
        const bool good = CLI::detail::lexical_cast(text, value) && value > 0 && value <= s_largest;
        return good ? std::string() : "allowed is a number above 0, up to 1e6, not '" + text + "'";
      },
      "above 0"};
}

std::string oneLine(const std::string& message) {
  // MRPT wraps its messages: a banner, `Message:  <text>`, `Location: …`, a call stack.
  const std::string label = "Message:";
  std::string text = message;
  const auto at = text.find(label);
  if (text.rfind("==== MRPT exception", 0) == 0 && at != std::string::npos) {
    text = text.substr(at + label.size());
    text = text.substr(0, text.find("\nLocation:"));
  }
  std::string line;
  for (char c : text) {
    const bool blank = c == '\n' || c == '\r' || c == '\t' || c == ' ';
    if (!blank)
      line += c;
    else if (!line.empty() && line.back() != ' ')
      line += ' ';
  }
  if (!line.empty() && line.back() == ' ') line.pop_back();
  return printable(line);
}

}  // namespace polemcl::apps
