#pragma once
/// \file EvalCommands.h
/// \brief The subcommands of `pole-eval`, each with its own options and output.

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace polemcl::apps {

/// \brief A declared subcommand and what it does once parsed: returns the text for the user, shows
/// its progress unless quiet.
struct EvalCommand {
  const CLI::App* parser = nullptr;
  std::function<std::string(bool quiet)> run;
};

/// \brief Declares `detections`, `repeatability`, `rotation`, `model`, `sightings` and `motion`.
std::vector<EvalCommand> extractionCommands(CLI::App& program);

/// \brief Declares `global`, `consistency` and `faults`.
std::vector<EvalCommand> localizationCommands(CLI::App& program);

}  // namespace polemcl::apps
