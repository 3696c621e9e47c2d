#include <cstdio>
#include <memory>
#include <sstream>

#include "cli/Outputs.h"
#include "cli/Progress.h"
#include "core/common/Angles.h"
#include "eval/ConsistencyEval.h"
#include "eval/EvalApp.h"
#include "eval/FaultTrials.h"
#include "eval/GlobalTrials.h"
#include "eval/StartTrials.h"

namespace polemcl::apps {
namespace {

void declareFiles(CLI::App& cli, TrialDriveFiles& files) {
  addConfigOption(cli, files.config)->required();
  addSetOption(cli, files.set);
  addFile(cli, "--map", files.map, "Pole map (.polemap)")->required();
  addFile(cli, "--input", files.input, "Rawlog of poles, with odometry")->required();
  addFile(cli, "--truth", files.truth, "True robot poses of the drive (.tum)")->required();
}

/// A command that starts at random places of a drive.
Subcommand trialCommand(CLI::App& program, const char* name, const char* meaning,
                        std::string (*evaluate)(const RandomStartsOptions&)) {
  auto& cli = *program.add_subcommand(name, meaning);
  const auto shared = std::make_shared<RandomStartsOptions>();
  RandomStartsOptions& options = *shared;
  declareFiles(cli, options.files);
  addNumber(cli, "--trials", options.trials, "Number of random starts", CLI::Range(1, 1000000));
  cli.add_option("--seed", options.seed, "Seed of the starts; the filter of trial i uses seed + i")
      ->capture_default_str();
  addNumber(cli, "--metres", options.metres, "Longest path of a trial, m", positiveNumber());
  addOutput(cli, "--json", options.json, "Write the results to this file (JSON)");
  return {&cli, [shared, evaluate](bool quiet) {
            Progress progress("trials", static_cast<std::size_t>(shared->trials), quiet);
            shared->progress = [&] { progress.step(); };
            return evaluate(*shared);
          }};
}

Subcommand globalCommand(CLI::App& program) {
  return trialCommand(program, "global",
                      "Starts at random places without a pose: is the pose found?", evalGlobal);
}

Subcommand startsCommand(CLI::App& program) {
  return trialCommand(program, "starts",
                      "Starts at random places with a pose as rough as [start] says: does the "
                      "filter find the true one?",
                      evalStarts);
}

std::string row(const std::string& name, const ConsistencyScore& s) {
  char line[200];
  std::snprintf(line, sizeof line, "%-10s %8zu %8.3f %8.3f %9.3f %8.3f %9.4f %11.1f\n",
                name.c_str(), s.samples, s.neesMean, s.neesMedian, s.neesPositionMean,
                s.neesHeadingMean, s.coverage95, s.longestBeyond5);
  return line;
}

std::string localizationText(const ConsistencyResult& result) {
  std::ostringstream out;
  out << "normalised squared errors; right are 3, 2.37 (median), 2 (x y), 1 (yaw), and 0.95 of the "
         "true positions within the 95 % ellipses; longest time in a row beyond 5 sigma of the "
         "position\n"
      << "run           poses     mean   median  position  heading  coverage  5 sigma, s\n";
  for (std::size_t i = 0; i < result.runs.size(); ++i)
    out << row(std::to_string(i), result.runs[i]);
  out << row("all", result.all);
  if (result.notOk > 0) out << result.notOk << " poses that are not ok left out\n";
  if (result.unmatched > 0) out << result.unmatched << " poses that the truth does not cover\n";
  return out.str();
}

Subcommand consistencyCommand(CLI::App& program) {
  auto& cli =
      *program.add_subcommand("consistency", "Compares the errors of poses with their covariances");
  const auto options = std::make_shared<EvalConsistencyOptions>();
  addFile(cli, "--truth", options->truth,
          "True robot poses, TUM: one file for all runs, or one per run")
      ->required();
  addFile(cli, "--cov", options->cov, "run_NN_cov.csv of pole-localize, one or several")
      ->required();
  addFile(cli, "--health", options->health,
          "run_NN_health.csv of each run: count only poses that are ok");
  addNumber(cli, "--truth-sigma-m", options->truthSigma,
            "Standard deviation of the true positions along an axis, m", CLI::NonNegativeNumber);
  const auto headingDeg = std::make_shared<double>(0);
  addNumber(cli, "--truth-sigma-deg", *headingDeg, "The same of the true headings, deg",
            CLI::NonNegativeNumber);
  addNumber(cli, "--skip-seconds", options->skipSeconds,
            "Time after the first pose that is left out, s", CLI::NonNegativeNumber);
  addNumber(cli, "--skip-metres", options->skipMetres,
            "Path after the first pose that is left out, m", CLI::NonNegativeNumber);
  addOutput(cli, "--json", options->json, "Write the results to this file (JSON)");
  return {&cli, [options, headingDeg](bool) {
            options->truthSigmaYaw = *headingDeg * degree;
            return localizationText(evalConsistency(*options));
          }};
}

Subcommand faultsCommand(CLI::App& program) {
  auto& cli = *program.add_subcommand(
      "faults", "Injects faults into a drive: are they noticed, does localization recover?");
  const auto shared = std::make_shared<FaultTrialsOptions>();
  FaultTrialsOptions& options = *shared;
  declareFiles(cli, options.files);
  std::vector<std::pair<std::string, Fault>> faults;
  for (const Fault fault :
       {Fault::none, Fault::kidnap, Fault::wrongMap, Fault::blind, Fault::stuck, Fault::slip})
    faults.emplace_back(name(fault), fault);
  addChoice(cli, "--fault", options.fault.fault, faults,
            "Kind of fault; none: the whole drive as it is")
      ->required();
  addFile(cli, "--other-map", options.otherMap, "The wrong map (.polemap), for wrong-map");
  addNumber(cli, "--trials", options.trials,
            "Number of trials, each with the fault at another place", CLI::Range(1, 1000000));
  cli.add_option("--seed", options.seed, "Seed of the faults; the filter of trial i uses seed + i")
      ->capture_default_str();
  const auto number = [&](const char* flag, double& value, const char* meaning) {
    addNumber(cli, flag, value, meaning, positiveNumber());
  };
  number("--lead", options.fault.lead, "Time before the fault, s");
  number("--duration", options.fault.duration, "Duration of blind, stuck and slip, s");
  number("--tail", options.fault.tail, "Path after the fault, m");
  addNumber(cli, "--slip", options.fault.slip, "Error of the slipping odometry's scale, as a share",
            positiveNumber() & CLI::Range(0.0, 1.0));
  addOutput(cli, "--json", options.json, "Write the results to this file (JSON)");
  return {&cli, [shared](bool quiet) {
            Progress progress("trials", static_cast<std::size_t>(shared->trials), quiet);
            shared->progress = [&] { progress.step(); };
            return evalFaults(*shared);
          }};
}

}  // namespace

std::vector<Subcommand> localizationCommands(CLI::App& program) {
  return {globalCommand(program), startsCommand(program), consistencyCommand(program),
          faultsCommand(program)};
}

}  // namespace polemcl::apps
