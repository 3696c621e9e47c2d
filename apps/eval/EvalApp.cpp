#include "eval/EvalApp.h"

#include <memory>
#include <sstream>

#include "cli/JsonFile.h"
#include "cli/Outputs.h"
#include "core/common/Angles.h"
#include "core/evaluation/MapShift.h"
#include "io/data/Trajectory.h"
#include "io/file/ErrorPlace.h"
#include "io/file/TextFile.h"
#include "io/map/PoleMapFile.h"
#include "io/map/PolePositions.h"
#include "localize/LocalizeReport.h"
#include "report/picture/MapPicture.h"
#include "report/scene/MapScene.h"

namespace polemcl::apps {
namespace {

std::string scoreText(const MapScore& score) {
  std::ostringstream out;
  out << "map poles " << score.mapPoles << ", truth poles " << score.truthPoles << ", matches "
      << score.matches << '\n'
      << "precision " << io::fixed(score.precision, 4) << "  recall " << io::fixed(score.recall, 4)
      << "  F1 " << io::fixed(score.f1, 4) << '\n';
  return out.str();
}

std::string scoreText(const TrajectoryErrors& errors) {
  std::ostringstream out;
  out << "poses    " << errors.poses << " compared, " << errors.unmatched << " unmatched\n"
      << "position mean " << io::fixed(errors.posMean, 4) << "  RMSE "
      << io::fixed(errors.posRmse, 4) << "  max " << io::fixed(errors.posMax, 4) << " m\n"
      << "lateral  mean " << io::fixed(errors.latMean, 4) << "  longitudinal mean "
      << io::fixed(errors.lonMean, 4) << " m\n"
      << "heading  mean " << io::fixed(errors.angMeanDeg, 4) << "  RMSE "
      << io::fixed(errors.angRmseDeg, 4) << " deg\n";
  return out.str();
}

Subcommand mapCommand(CLI::App& program) {
  auto& cli = *program.add_subcommand("map", "Precision, recall and F1 of a pole map");
  const auto shared = std::make_shared<EvalMapOptions>();
  EvalMapOptions& options = *shared;
  addFile(cli, "--truth", options.truth, "True poles: .polemap, .csv with x,y columns, or .npz")
      ->required();
  addFile(cli, "--map", options.map, "Poles to score, in any of these formats")->required();
  addNumber(cli, "--radius", options.radius, "Distance within which a pole is right, m",
            CLI::PositiveNumber);
  cli.add_flag("--one-to-one", options.oneToOne,
               "Match each pole at most once; otherwise, map poles near any true pole are right");
  addOutput(cli, "--json", options.json, "Write the results to this file (JSON)");
  return {&cli, [shared](bool) { return scoreText(evalMap(*shared)); }};
}

Subcommand trajectoryCommand(CLI::App& program) {
  auto& cli = *program.add_subcommand("trajectory", "Errors of a trajectory");
  const auto shared = std::make_shared<EvalTrajectoryOptions>();
  EvalTrajectoryOptions& options = *shared;
  addFile(cli, "--truth", options.truth, "True robot poses, TUM")->required();
  addFile(cli, "--estimate", options.estimate, "Estimated robot poses, TUM")->required();
  addChoice<Sampling>(cli, "--per", options.sampling,
                      {{"pose", Sampling::perPose}, {"metre", Sampling::perMetre}},
                      "Evaluate at each pose, or every metre along the true path")
      ->default_str("pose");
  addOutput(cli, "--json", options.json, "Write the results to this file (JSON)");
  addFile(cli, "--map", options.map, "Pole map to draw under the trajectories");
  addOutput(cli, "--scene", options.scene, "Write a .3Dscene of map, truth and estimate");
  addOutput(cli, "--png", options.png, "Write a picture of map, truth and estimate");
  cli.add_option("--title", options.title, "Title of the picture")
      ->default_str("the file of the estimate");
  return {&cli, [shared](bool) { return scoreText(evalTrajectory(*shared)); }};
}

std::vector<Eigen::Vector2d> readPoles(const std::filesystem::path& file) {
  auto poles = io::readPolePositions(file);
  if (poles.empty()) throw Error(file.string() + ": holds no pole, so there is nothing to score");
  return poles;
}

/// Poles to draw; of files that only hold positions, as slim poles of 2 m.
std::vector<MapPole> polesToDraw(const std::filesystem::path& file) {
  if (file.extension() == ".polemap") return io::readPoleMap(file).poles;
  std::vector<MapPole> poles;
  for (const auto& position : io::readPolePositions(file)) {
    MapPole pole;
    pole.x = position.x();
    pole.y = position.y();
    pole.radius = 0.1;
    pole.top = 2;
    poles.push_back(pole);
  }
  return poles;
}

/// Where errors of a comparison come from.
std::string against(const std::filesystem::path& result, const std::filesystem::path& truth) {
  return result.string() + " against " + truth.string() + ": ";
}

/// By subcommand; the first one is that of the program.
const Guides kEvalGuides{
    {"",
     {{"pole-eval trajectory --truth drive.tum --estimate out/run_00.tum --map street.polemap "
       "--png run.png",
       "pole-eval map --truth scans/poles_gt.csv --map street.polemap --one-to-one"},
      "See the options of one subcommand, such as pole-eval map --help."}},
    {"map",
     {{"pole-eval map --truth scans/poles_gt.csv --map street.polemap --one-to-one --radius 0.5 "
       "--json score.json"},
      "If too few poles are found, see the settings in [map]: pole-map build --config demo.ini "
      "--print-config."}},
    {"trajectory",
     {{"pole-eval trajectory --truth drive.tum --estimate out/run_00.tum --per metre --map "
       "street.polemap --png run.png"},
      "See whether the errors fit the covariances: pole-eval consistency --help."}},
    {"detections",
     {{"pole-eval detections --scans scans --poles poles.rawlog --json detections.json"},
      "See how often poles are found again: pole-eval repeatability --help."}},
    {"repeatability",
     {{"pole-eval repeatability --poles poles.rawlog --truth drive.tum"},
      "Check the true poses: pole-eval motion --help."}},
    {"rotation",
     {{"pole-eval rotation --config demo.ini --input drive.rawlog --every 10"},
      "Compare with another configuration, such as paper/kitti.ini."}},
    {"model",
     {{"pole-eval model --drives a0.rawlog a1.rawlog b0.rawlog b1.rawlog --model my.json"},
      "Simulate long drives with it: pole-simulate --config hdl32e.ini --set "
      "simulation.detections=my.json --length 1000 --poles long.rawlog."}},
    {"sightings",
     {{"pole-eval sightings --poles drive.rawlog --json sightings.json"},
      "Fit a model of detections to such drives: pole-eval model --help."}},
    {"mrpt-truth",
     {{"pole-eval mrpt-truth --truth drive.tum --output truth.txt"},
      "Name it in the settings of pf-localization: ground_truth_path_file = truth.txt."}},
    {"motion",
     {{"pole-eval motion --poles poles.rawlog --truth drive.tum --every 4"},
      "If the poses disagree, mend the times or the poses of the dataset before you build a "
      "map."}},
    {"global",
     {{"pole-eval global --config demo.ini --map street.polemap --input poles.rawlog --truth "
       "drive.tum --trials 50"},
      "See the settings in [global]: pole-eval global --config demo.ini --print-config."}},
    {"starts",
     {{"pole-eval starts --config demo.ini --map street.polemap --input poles.rawlog --truth "
       "drive.tum --trials 50"},
      "Start without any pose: pole-eval global --help."}},
    {"consistency",
     {{"pole-eval consistency --truth drive.tum --cov out/run_00_cov.csv --health "
       "out/run_00_health.csv"},
      "If the errors are larger than the covariances say, state the error of the truth "
      "(--truth-sigma-m), or check it: pole-eval motion --help."}},
    {"faults",
     {{"pole-eval faults --config demo.ini --map street.polemap --input poles.rawlog --truth "
       "drive.tum --fault kidnap --trials 50"},
      "Compare with a drive without a fault: --fault none."}},
    {"candidates",
     {{"pole-eval candidates --config hdl32e.ini --scans scans --poles scans/poles_gt.csv "
       "--output candidates.csv"},
      "Fit weights to the tables of several drives: pole-eval train --help."}},
    {"train",
     {{"pole-eval train --candidates a.csv b.csv --test c.csv --classifier weights.csv "
       "--covariance scale.csv"},
      "The weights are compiled into the library: see share/experiments/train-classifier.sh in "
      "the sources."}},
};

}  // namespace

MapScore evalMap(const EvalMapOptions& options) {
  const auto truth = readPoles(options.truth);
  const auto map = readPoles(options.map);
  const auto score = io::located(against(options.map, options.truth), [&] {
    return scoreMap(truth, map, options.radius, options.oneToOne);
  });
  const MapShift moved = mapShift(truth, map, options.radius);
  if (options.json)
    writeJson(*options.json, {{"precision", score.precision},
                              {"recall", score.recall},
                              {"f1", score.f1},
                              {"matches", score.matches},
                              {"map_poles", score.mapPoles},
                              {"truth_poles", score.truthPoles},
                              {"radius", options.radius},
                              {"one_to_one", options.oneToOne},
                              {"shift_x_m", moved.shift.x()},
                              {"shift_y_m", moved.shift.y()},
                              {"rotation_deg", moved.rotation / degree}});
  return score;
}

TrajectoryErrors evalTrajectory(const EvalTrajectoryOptions& options) {
  report::MapView view;
  view.truth = io::readPlanarTum(options.truth);
  view.estimate = io::readPlanarTum(options.estimate);
  if (options.map) view.poles = polesToDraw(*options.map);
  auto errors = io::located(against(options.estimate, options.truth), [&] {
    return evaluateTrajectory(view.truth, view.estimate, options.sampling);
  });
  view.title = options.title.empty() ? options.estimate.filename().string() : options.title;
  if (options.scene) scene::save(*report::makeMapScene(view), *options.scene);
  if (options.png) report::drawMapPng(view, *options.png);
  if (options.json) {
    auto json = errorsJson(errors);
    json["per"] = options.sampling == Sampling::perMetre ? "metre" : "pose";
    writeJson(*options.json, json);
  }
  return errors;
}

int evalMain(int argc, const char* const* argv) {
  CommandLine line("pole-eval", "Scores pole maps, trajectories, extractors and localization.",
                   kEvalGuides);
  std::vector<Subcommand> commands{mapCommand(line.cli()), trajectoryCommand(line.cli())};
  for (auto& command : extractionCommands(line.cli())) commands.push_back(std::move(command));
  for (auto& command : localizationCommands(line.cli())) commands.push_back(std::move(command));
  return line.run(argc, argv, commands);
}

}  // namespace polemcl::apps
