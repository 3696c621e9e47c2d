#include <polemcl/apps/GlobalTrials.h>

#include <memory>

#include "EvalCommands.h"

namespace polemcl::apps {
namespace {

void declareFiles(CLI::App& cli, TrialDriveFiles& files) {
  cli.add_option("--config", files.config, "Settings (.ini)")->required();
  cli.add_option("--map", files.map, "Pole map (.polemap)")->required();
  cli.add_option("--input", files.input, "Rawlog of poles, with odometry")->required();
  cli.add_option("--truth", files.truth, "True robot poses of the drive (.tum)")->required();
}

EvalCommand globalCommand(CLI::App& program) {
  auto& cli = *program.add_subcommand("global", "Random starts without a pose: are they found?");
  const auto shared = std::make_shared<GlobalTrialsOptions>();
  GlobalTrialsOptions& options = *shared;
  declareFiles(cli, options.files);
  cli.add_option("--trials", options.trials, "Random starts")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  cli.add_option("--seed", options.seed, "Of the starts; trial i filters with seed + i")
      ->capture_default_str();
  cli.add_option("--metres", options.metres, "Driven in each trial, at most, m")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  cli.add_option("--json", options.json, "Write the figures to this file");
  return {&cli, [shared] { return evalGlobal(*shared); }};
}

}  // namespace

std::vector<EvalCommand> localizationCommands(CLI::App& program) {
  return {globalCommand(program)};
}

}  // namespace polemcl::apps
