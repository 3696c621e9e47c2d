#include "eval/EvalApp.h"

namespace polemcl::apps {
namespace {

/// By subcommand; the first one is that of the program.
const Guides kEvalGuides{
    {"",
     {{"pole-eval trajectory --truth tuesday.tum --estimate out/run_00.tum --map street.polemap "
       "--png run.png",
       "pole-eval map --truth monday_poles_gt.csv --map street.polemap --one-to-one"},
      "See the options of one subcommand, such as pole-eval map --help."}},
    {"map",
     {{"pole-eval map --truth monday_poles_gt.csv --map street.polemap --one-to-one --radius 0.5 "
       "--json score.json"},
      "If too few poles are found, see the settings in [map]: pole-map build --config demo.ini "
      "--print-config."}},
    {"trajectory",
     {{"pole-eval trajectory --truth tuesday.tum --estimate out/run_00.tum --per metre --map "
       "street.polemap --png run.png"},
      "See whether the errors fit the covariances: pole-eval consistency --help."}},
    {"detections",
     {{"pole-eval detections --scans scans --poles poles.rawlog --json detections.json"},
      "See how often poles are found again: pole-eval repeatability --help."}},
    {"repeatability",
     {{"pole-eval repeatability --poles monday.rawlog --truth monday.tum"},
      "Check the true poses: pole-eval motion --help."}},
    {"rotation",
     {{"pole-eval rotation --config demo.ini --input scans.rawlog --every 10"},
      "Compare with another configuration, such as paper/kitti.ini."}},
    {"sightings",
     {{"pole-eval sightings --poles monday.rawlog --output sightings.csv"},
      "A model of detections is fitted to the tables of several drives: see "
      "share/experiments/detection-model.sh in the sources."}},
    {"motion",
     {{"pole-eval motion --poles monday.rawlog --truth monday.tum --every 4"},
      "If the poses disagree, mend the times or the poses of the dataset before you build a "
      "map."}},
    {"global",
     {{"pole-eval global --config demo.ini --map street.polemap --input tuesday.rawlog --truth "
       "tuesday.tum --trials 50"},
      "Put faults into a drive: pole-eval faults --help."}},
    {"starts",
     {{"pole-eval starts --config demo.ini --map street.polemap --input tuesday.rawlog --truth "
       "tuesday.tum --trials 50"},
      "Start without any pose: pole-eval global --help."}},
    {"consistency",
     {{"pole-eval consistency --truth tuesday.tum --cov out/run_00_cov.csv --health "
       "out/run_00_health.csv"},
      "If the errors are larger than the covariances say, state the error of the truth "
      "(--truth-sigma-m), or check it: pole-eval motion --help."}},
    {"faults",
     {{"pole-eval faults --config demo.ini --map street.polemap --input tuesday.rawlog --truth "
       "tuesday.tum --fault jump --lead 5 --tail 40 --trials 50"},
      "Compare with a drive without a fault: --fault none."}},
    {"features",
     {{"pole-eval features --config demo.ini --scans scans --poles scans/poles_gt.csv "
       "--output features.csv"},
      "Weights are fitted to the tables of several drives: see "
      "share/experiments/train-classifier.sh in the sources."}},
};

}  // namespace

int evalMain(int argc, const char* const* argv) {
  CommandLine line("pole-eval", "Scores pole maps, trajectories, extractors and localization.",
                   kEvalGuides);
  std::vector<Subcommand> commands;
  for (const auto command :
       {mapCommand, trajectoryCommand, detectionsCommand, repeatabilityCommand, rotationCommand,
        motionCommand, consistencyCommand, sightingsCommand, featuresCommand})
    commands.push_back(command(line.cli()));
  for (Subcommand& command : trialCommands(line.cli())) commands.push_back(std::move(command));
  return line.run(argc, argv, commands);
}

}  // namespace polemcl::apps
