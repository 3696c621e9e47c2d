#pragma once
/// \file EvalCommands.h
/// \brief The subcommands of `pole-eval`, each with its own options and output.

#include <vector>

#include "cli/CommandLine.h"

namespace polemcl::apps {

/// \brief Declares `detections`, `repeatability`, `rotation`, `model`, `sightings` and `motion`.
std::vector<Subcommand> extractionCommands(CLI::App& program);

/// \brief Declares `global`, `consistency` and `faults`.
std::vector<Subcommand> localizationCommands(CLI::App& program);

}  // namespace polemcl::apps
