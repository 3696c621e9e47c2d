#include "cli/CommandLine.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <iostream>
#include <memory>
#include <optional>

#include <polemcl/mrpt/map/CPoleMap.h>
#include "cli/Messages.h"
#include "cli/Outputs.h"
#include "cli/Progress.h"
#include "cli/Settings.h"
#include "cli/Version.h"
#include "core/common/Binder.h"
#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace {

constexpr double kLargest = 1e6;  // of metres, seconds and the like

/// What `--print-config` asks for; thrown as soon as it is parsed, so that nothing else is
/// required.
struct PrintRequest {
  std::string config;
  std::vector<std::string> assignments;
  Tier tier;
};

/// Declares `--print-config` wherever `--config` is declared.
void offerPrintConfig(CLI::App& app) {
  for (CLI::App* below : app.get_subcommands({})) offerPrintConfig(*below);
  const CLI::Option* config = app.get_option_no_throw("--config");
  if (!config) return;
  const auto request = [&app, config] {
    if (config->results().empty()) throw CLI::RequiredError("--config");
    const CLI::Option* set = app.get_option_no_throw("--set");
    throw PrintRequest{config->results().front(), set ? set->results() : std::vector<std::string>(),
                       app.count("--all") > 0 ? Tier::expert : Tier::tuning};
  };
  auto* print =
      app.add_flag_callback("--print-config", request, "Print the effective settings, and end");
  app.add_flag("--all", "Print the expert settings, too")->needs(print);
}

void printConfig(const PrintRequest& request) {
  std::cout << settingsText(loadSettings(request.config, request.assignments), request.tier);
}

/// What is wrong with a command line; where a subcommand is missing, which ones there are.
std::string problemOf(const CLI::App& cli, const CLI::ParseError& error) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError))  // in the order given
    return "not expected: " + CLI::detail::join(cli.remaining(true), " ");
  if (cli.get_require_subcommand_min() == 0 || !cli.get_subcommands().empty()) return error.what();
  std::vector<std::string> names;
  for (const CLI::App* command : cli.get_subcommands({})) names.push_back(command->get_name());
  return "a subcommand is needed: " + CLI::detail::join(names, ", ");
}

/// Results that are printed into a file need the disk as well.
void requirePrinted() {
  if (!std::cout.flush()) throw Error("cannot write to standard output: is the disk full?");
}

}  // namespace

CommandLine::CommandLine(const std::string& program, const std::string& description, Guides guides)
    : m_program(program), m_cli(description, program), m_guides(std::move(guides)) {
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
  std::string command = m_program;
  for (const CLI::App* chosen : m_cli.get_subcommands()) command += ' ' + chosen->get_name();
  std::cerr << m_program << ": " << coloured(Colour::red, oneLine(what)) << "\nTry `" << command
            << " --help`.\n";
  return exitUsage;
}

int CommandLine::run(int argc, const char* const* argv, const std::function<void()>& work) {
  try {
    for (const auto& [name, guide] : m_guides)
      (name.empty() ? &m_cli : m_cli.get_subcommand(name))->footer(guideText(guide));
    offerPrintConfig(m_cli);
    m_cli.parse(argc, argv);
    requireDistinctOutputs(m_cli);
  } catch (const PrintRequest& request) {
    return this->work([&] { printConfig(request); });
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() != static_cast<int>(CLI::ExitCodes::Success))
      return usageError(problemOf(m_cli, e));
    return this->work([&] { m_cli.exit(e); });  // prints what --help or --version ask for
  }
  return this->work([&] {
    requireInputsKept(m_cli);
    work();
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
    requirePrinted();
    sayDetail("took " + resourcesTaken(secondsSince(begin)));
    return exitDone;
  } catch (const std::exception& e) {
    if (oneLine(e.what()) != e.what()) sayDetail(std::string("in full: ") + e.what());
    sayFailure(m_program, oneLine(reasonOf(e)));
  } catch (...) {
    sayFailure(m_program, "failed for an unknown reason");
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
        const bool good = CLI::detail::lexical_cast(text, value) && value > 0 && value <= kLargest;
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
  return printable(io::joined(io::wordsOf(text), " "));
}

}  // namespace polemcl::apps
