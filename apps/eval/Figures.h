#pragma once
/// \file Figures.h
/// \brief What a command of `pole-eval` finds: JSON for scripts, and the same figures as a text.

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "cli/CommandLine.h"
#include "cli/JsonFile.h"
#include "cli/Outputs.h"
#include "io/file/AtomicFile.h"

namespace polemcl::apps {

struct Figures {
  Json json;
  std::string text;
};

/// \brief A text with figures filled in.
/// \param text In it, `{key}` stands for the value of the JSON object under this key, `{key:3}` for
/// it with 3 decimals, `{key:8.3}` also right-aligned in 8 columns, and `{key:1*100}` for a hundred
/// times the value with 1 decimal. A value `null` is shown as `-`.
std::string filled(const std::string& text, const Json& json);

/// \brief Options of a command: derived structs add theirs.
struct EvalOptions {
  std::optional<std::filesystem::path> json;  ///< written when given
  bool quiet = false;                         ///< no progress is shown
};

/// \brief Declares a command that writes its figures to the file of `--json`.
/// \param declare Declares the other options. \param evaluate Does the work.
template <class Options>
Subcommand evalCommand(CLI::App& program, const char* name, const char* meaning,
                       const std::function<void(CLI::App&, Options&)>& declare,
                       const std::function<Figures(const Options&)>& evaluate) {
  auto& cli = *program.add_subcommand(name, meaning);
  const auto options = std::make_shared<Options>();
  declare(cli, *options);
  markOutput(addFile(cli, "--json", options->json, "Write the results to this file (JSON)"),
             {"_timings.json"});  // of trials
  return {&cli, [options, evaluate](bool quiet) {
            options->quiet = quiet;
            io::AtomicFiles together;
            const Figures figures = evaluate(*options);
            if (options->json) writeJson(*options->json, figures.json);
            together.commit();
            return figures.text;
          }};
}

}  // namespace polemcl::apps
