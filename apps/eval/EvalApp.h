#pragma once
/// \file EvalApp.h
/// \brief `pole-eval`: scores of a pole map, errors of a trajectory.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/CommandLine.h"
#include "core/evaluation/TrajectoryEvaluation.h"

namespace polemcl::apps {

/// \brief `pole-eval map`.
struct EvalMapOptions {
  std::filesystem::path truth, map;           ///< `.polemap`, `.csv` with x,y columns, or `.npz`
  double radius = 1.0;                        ///< a map pole is right within it, m, > 0
  bool oneToOne = false;                      ///< maximum matching instead of the authors' count
  std::optional<std::filesystem::path> json;  ///< written when given
};
/// \brief Scores the map and writes the JSON file (keys `precision recall f1 matches` and more;
/// also `shift_x_m shift_y_m rotation_deg`, how far the map as a whole is off, see MapShift).
/// \throws Error naming the file and what is wrong with it, or the radius.
MapScore evalMap(const EvalMapOptions& options);

/// \brief `pole-eval trajectory`.
struct EvalTrajectoryOptions {
  std::filesystem::path truth, estimate;  ///< TUM, robot poses in the map frame
  Sampling sampling = Sampling::perPose;
  std::optional<std::filesystem::path> json;
  std::optional<std::filesystem::path> map;    ///< drawn under the trajectories
  std::optional<std::filesystem::path> scene;  ///< `.3Dscene` to write
  std::optional<std::filesystem::path> png;    ///< picture to write, drawn without a display
  std::string title;  ///< of the picture; empty: the name of the estimate's file
};
/// \brief Evaluates in 2D and writes what was asked for: JSON (keys `pos_mean pos_rmse lat_mean
/// lon_mean ang_mean_deg ang_rmse_deg pos_max poses` and more), scene, picture.
/// \throws Error naming the file and what is wrong, or when under half of the poses are matched.
TrajectoryErrors evalTrajectory(const EvalTrajectoryOptions& options);

/// \brief Declares `detections`, `repeatability`, `rotation`, `model`, `sightings`, `motion` and
/// `features`.
std::vector<Subcommand> extractionCommands(CLI::App& program);

/// \brief Declares `global`, `consistency` and `faults`.
std::vector<Subcommand> localizationCommands(CLI::App& program);

/// \brief The program. \return An ExitCode.
int evalMain(int argc, const char* const* argv);

}  // namespace polemcl::apps
