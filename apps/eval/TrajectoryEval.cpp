/// \file TrajectoryEval.cpp
/// \brief `pole-eval trajectory`: errors of a trajectory in 2D, as numbers, scene and picture.

#include "core/evaluation/TrajectoryEvaluation.h"
#include "eval/EvalApp.h"
#include "eval/Figures.h"
#include "io/data/Trajectory.h"
#include "io/file/ErrorPlace.h"
#include "io/map/PoleMapFile.h"
#include "io/map/PoleTables.h"
#include "localize/LocalizeReport.h"
#include "report/picture/Pictures.h"
#include "report/scene/MapScene.h"

namespace polemcl::apps {
namespace {

struct TrajectoryOptions : EvalOptions {
  std::filesystem::path truth, estimate;
  Sampling sampling = Sampling::perPose;
  std::optional<std::filesystem::path> map, scene, png;
  std::string title;
};

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

Figures trajectoryFigures(const TrajectoryOptions& options) {
  report::MapView view;
  view.truth = io::readPlanarTum(options.truth);
  view.estimate = io::readPlanarTum(options.estimate);
  if (options.map) view.poles = polesToDraw(*options.map);
  const auto errors =
      io::located(options.estimate.string() + " against " + options.truth.string() + ": ",
                  [&] { return evaluateTrajectory(view.truth, view.estimate, options.sampling); });
  view.title = options.title.empty() ? options.estimate.filename().string() : options.title;
  if (options.scene) scene::save(*report::makeMapScene(view), *options.scene);
  if (options.png) report::drawMapPng(view, *options.png);
  Json json = errorsJson(errors);
  json["per"] = options.sampling == Sampling::perMetre ? "metre" : "pose";
  return {json, filled("poses    {poses} compared, {unmatched} unmatched\n"
                       "position mean {pos_mean:4}  RMSE {pos_rmse:4}  max {pos_max:4} m\n"
                       "lateral  mean {lat_mean:4}  longitudinal mean {lon_mean:4} m\n"
                       "heading  mean {ang_mean_deg:4}  RMSE {ang_rmse_deg:4} deg\n",
                       json)};
}

void declareTrajectory(CLI::App& cli, TrajectoryOptions& options) {
  addFile(cli, "--truth", options.truth, "True robot poses, TUM")->required();
  addFile(cli, "--estimate", options.estimate, "Estimated robot poses, TUM")->required();
  addChoice<Sampling>(cli, "--per", options.sampling,
                      {{"pose", Sampling::perPose}, {"metre", Sampling::perMetre}},
                      "Evaluate at each pose, or every metre along the true path")
      ->default_str("pose");
  addFile(cli, "--map", options.map, "Pole map to draw under the trajectories");
  addOutput(cli, "--scene", options.scene, "Write a .3Dscene of map, truth and estimate");
  addOutput(cli, "--png", options.png, "Write a picture of map, truth and estimate");
  cli.add_option("--title", options.title, "Title of the picture")
      ->default_str("the file of the estimate");
}

}  // namespace

Subcommand trajectoryCommand(CLI::App& program) {
  return evalCommand<TrajectoryOptions>(program, "trajectory", "Errors of a trajectory",
                                        declareTrajectory, trajectoryFigures);
}

}  // namespace polemcl::apps
