#include "eval/EvalApp.h"

#include <memory>
#include <sstream>

#include <polemcl/io/map/PoleMapFile.h>
#include "cli/CommandLine.h"
#include "cli/JsonFile.h"
#include "eval/EvalCommands.h"
#include "io/data/Trajectory.h"
#include "io/file/TextFile.h"
#include "io/map/PolePositions.h"
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

nlohmann::ordered_json scoreJson(const EvalMapOptions& options, const MapScore& score) {
  nlohmann::ordered_json out;
  out["precision"] = score.precision;
  out["recall"] = score.recall;
  out["f1"] = score.f1;
  out["matches"] = score.matches;
  out["map_poles"] = score.mapPoles;
  out["truth_poles"] = score.truthPoles;
  out["radius"] = options.radius;
  out["one_to_one"] = options.oneToOne;
  return out;
}

nlohmann::ordered_json scoreJson(const EvalTrajectoryOptions& options,
                                 const TrajectoryErrors& errors) {
  nlohmann::ordered_json out;
  out["pos_mean"] = errors.posMean;
  out["pos_rmse"] = errors.posRmse;
  out["lat_mean"] = errors.latMean;
  out["lon_mean"] = errors.lonMean;
  out["ang_mean_deg"] = errors.angMeanDeg;
  out["ang_rmse_deg"] = errors.angRmseDeg;
  out["pos_max"] = errors.posMax;
  out["poses"] = errors.poses;
  out["unmatched"] = errors.unmatched;
  out["per"] = options.sampling == Sampling::perMetre ? "metre" : "pose";
  return out;
}

Subcommand mapCommand(CLI::App& program) {
  auto& cli = *program.add_subcommand("map", "Precision, recall and F1 of a pole map");
  const auto shared = std::make_shared<EvalMapOptions>();
  EvalMapOptions& options = *shared;
  cli.add_option("--truth", options.truth, "True poles: .polemap, .csv with x,y columns, or .npz")
      ->required();
  cli.add_option("--map", options.map, "Poles to score, in any of these formats")->required();
  cli.add_option("--radius", options.radius, "Distance within which a pole is right, m")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  cli.add_flag("--one-to-one", options.oneToOne,
               "Match each pole at most once (default: count map poles near any true pole)");
  cli.add_option("--json", options.json, "Write the results to this file (JSON)");
  return {&cli, [shared](bool) { return scoreText(evalMap(*shared)); }};
}

Subcommand trajectoryCommand(CLI::App& program) {
  auto& cli = *program.add_subcommand("trajectory", "Errors of a trajectory");
  const auto shared = std::make_shared<EvalTrajectoryOptions>();
  EvalTrajectoryOptions& options = *shared;
  cli.add_option("--truth", options.truth, "True robot poses, TUM")->required();
  cli.add_option("--estimate", options.estimate, "Estimated robot poses, TUM")->required();
  const std::map<std::string, Sampling> samplings{{"pose", Sampling::perPose},
                                                  {"metre", Sampling::perMetre}};
  cli.add_option("--per", options.sampling,
                 "Evaluate at each `pose`, or every `metre` along the true path (default: pose)")
      ->transform(CLI::CheckedTransformer(samplings))
      ->type_name("pose|metre");
  cli.add_option("--json", options.json, "Write the results to this file (JSON)");
  cli.add_option("--map", options.map, "Pole map to draw under the trajectories");
  cli.add_option("--scene", options.scene, "Write a .3Dscene of map, truth and estimate");
  cli.add_option("--png", options.png, "Write a picture of map, truth and estimate");
  cli.add_option("--title", options.title, "Title of the picture (default: the estimate's file)");
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

/// What `score` returns; its errors name the two files.
template <class Score>
auto comparing(const std::filesystem::path& result, const std::filesystem::path& truth,
               const Score& score) {
  try {
    return score();
  } catch (const Error& error) {
    throw Error(result.string() + " against " + truth.string() + ": " + error.what());
  }
}

void drawEvaluation(const EvalTrajectoryOptions& options, const report::MapView& view) {
  if (options.scene) scene::save(*report::makeMapScene(view), *options.scene);
  if (options.png) report::drawMapPng(view, *options.png);
}

}  // namespace

MapScore evalMap(const EvalMapOptions& options) {
  const auto truth = readPoles(options.truth);
  const auto map = readPoles(options.map);
  const auto score = comparing(options.map, options.truth, [&] {
    return scoreMap(truth, map, options.radius, options.oneToOne);
  });
  if (options.json) writeJson(*options.json, scoreJson(options, score));
  return score;
}

TrajectoryErrors evalTrajectory(const EvalTrajectoryOptions& options) {
  report::MapView view;
  view.truth = io::planar(io::readTum(options.truth));
  view.estimate = io::planar(io::readTum(options.estimate));
  if (options.map) view.poles = polesToDraw(*options.map);
  const auto errors = comparing(options.estimate, options.truth, [&] {
    return evaluateTrajectory(view.truth, view.estimate, options.sampling);
  });
  view.title = options.title.empty() ? options.estimate.filename().string() : options.title;
  drawEvaluation(options, view);
  if (options.json) writeJson(*options.json, scoreJson(options, errors));
  return errors;
}

int evalMain(int argc, const char* const* argv) {
  CommandLine line("pole-eval", "Scores pole maps, trajectories, extractors and localization.");
  std::vector<Subcommand> commands{mapCommand(line.cli()), trajectoryCommand(line.cli())};
  for (auto& command : extractionCommands(line.cli())) commands.push_back(std::move(command));
  for (auto& command : localizationCommands(line.cli())) commands.push_back(std::move(command));
  return line.run(argc, argv, commands);
}

}  // namespace polemcl::apps
