/// \file MapEval.cpp
/// \brief `pole-eval map`: scores of a pole map. `shift_x_m shift_y_m rotation_deg` say how far the
/// map as a whole is off, see MapEvaluation.h.

#include "core/common/Angles.h"
#include "core/evaluation/MapEvaluation.h"
#include "eval/EvalApp.h"
#include "eval/Figures.h"
#include "io/file/ErrorPlace.h"
#include "io/map/Datum.h"
#include "io/map/PoleMapFile.h"
#include "io/map/PoleTables.h"

namespace polemcl::apps {
namespace {

struct MapOptions : EvalOptions {
  std::filesystem::path truth, map;
  double radius = 1.0;
  bool oneToOne = false;
};

std::vector<Eigen::Vector2d> readPoles(const std::filesystem::path& file) {
  auto poles = io::readPolePositions(file);
  if (poles.empty()) throw Error(file.string() + ": holds no pole, so there is nothing to score");
  return poles;
}

/// The info of a `.polemap`; other formats have none.
std::pair<std::string, std::map<std::string, std::string>> factsOf(
    const std::filesystem::path& file) {
  if (file.extension() != ".polemap") return {file.string(), {}};
  return {file.string(), io::readPoleMap(file).info};
}

Figures mapFigures(const MapOptions& options) {
  io::requireSameDatum(factsOf(options.truth), factsOf(options.map));
  const auto truth = readPoles(options.truth), map = readPoles(options.map);
  const auto score =
      io::located(options.map.string() + " against " + options.truth.string() + ": ",
                  [&] { return scoreMap(truth, map, options.radius, options.oneToOne); });
  const MapShift moved = mapShift(truth, map, options.radius);
  const Json json{{"precision", score.precision},
                  {"recall", score.recall},
                  {"f1", score.f1},
                  {"matches", score.matches},
                  {"map_poles", score.mapPoles},
                  {"truth_poles", score.truthPoles},
                  {"radius", options.radius},
                  {"one_to_one", options.oneToOne},
                  {"shift_x_m", moved.shift.x()},
                  {"shift_y_m", moved.shift.y()},
                  {"rotation_deg", moved.rotation / degree}};
  return {json, filled("map poles {map_poles}, truth poles {truth_poles}, matches {matches}\n"
                       "precision {precision:4}  recall {recall:4}  F1 {f1:4}\n",
                       json)};
}

void declareMap(CLI::App& cli, MapOptions& options) {
  addFile(cli, "--truth", options.truth, "True poles: .polemap, .csv with x,y columns, or .npz")
      ->required();
  addFile(cli, "--map", options.map, "Poles to score, in any of these formats")->required();
  addNumber(cli, "--radius", options.radius, "Distance within which a pole is right, m",
            CLI::PositiveNumber);
  cli.add_flag("--one-to-one", options.oneToOne,
               "Match each pole at most once; otherwise, map poles near any true pole are right");
}

}  // namespace

Subcommand mapCommand(CLI::App& program) {
  return evalCommand<MapOptions>(program, "map", "Precision, recall and F1 of a pole map",
                                 declareMap, mapFigures);
}

}  // namespace polemcl::apps
