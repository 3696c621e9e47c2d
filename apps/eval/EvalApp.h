#pragma once
/// \file EvalApp.h
/// \brief `pole-eval`: scores of maps, trajectories and extractors, trials of the localization.
/// `--help` of a command says what it reads; its file, what the figures mean.

#include <vector>

#include "cli/CommandLine.h"

namespace polemcl::apps {

/// \name Commands: each function declares the options of one, or of those in the list
/// @{
Subcommand mapCommand(CLI::App& program);
Subcommand trajectoryCommand(CLI::App& program);
Subcommand detectionsCommand(CLI::App& program);
Subcommand repeatabilityCommand(CLI::App& program);
Subcommand rotationCommand(CLI::App& program);
Subcommand motionCommand(CLI::App& program);
Subcommand consistencyCommand(CLI::App& program);
Subcommand sightingsCommand(CLI::App& program);
Subcommand featuresCommand(CLI::App& program);
std::vector<Subcommand> trialCommands(CLI::App& program);  ///< `global`, `starts`, `faults`
/// @}

/// \brief The program. \return An ExitCode.
int evalMain(int argc, const char* const* argv);

}  // namespace polemcl::apps
