#pragma once
/// \file DetectionModelApp.h
/// \brief `pole-eval model` and `sightings`: fits a detection model to ray-cast drives, and says
/// what the detections of a simulated drive are like.

#include <filesystem>
#include <optional>
#include <vector>

#include "sim/detections/DetectionModel.h"
#include "sim/detections/DetectionSummary.h"

namespace polemcl::apps {

/// \brief `pole-eval model`.
struct FitModelOptions {
  /// Rawlogs that `pole-simulate --poles` wrote, with their P_config.ini beside them: two for each
  /// street, on two days.
  std::vector<std::filesystem::path> drives;
  std::filesystem::path model;  ///< JSON to write
};

/// \brief Fits (sim/DetectionModelFit.h) and writes the model.
/// \throws Error naming the file: no P_config.ini, another number of scans than its drive has, an
///         odd number of drives, drives that do not belong together.
sim::DetectionModel fitModel(const FitModelOptions& options);

/// \brief `pole-eval sightings`.
struct EvalObservationsOptions {
  std::filesystem::path poles;  ///< rawlog of `pole-simulate --poles`, P_config.ini beside it
  std::optional<std::filesystem::path> json;
};
/// \brief Figures of one simulated drive, cast or drawn. \throws Error as fitModel().
sim::DetectionSummary evalObservations(const EvalObservationsOptions& options);

}  // namespace polemcl::apps
