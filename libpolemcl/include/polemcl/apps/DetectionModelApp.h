#pragma once
/// \file DetectionModelApp.h
/// \brief `pole-eval model`: fits a detection model to ray-cast drives.

#include <polemcl/sim/DetectionModel.h>

#include <filesystem>
#include <vector>

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

}  // namespace polemcl::apps
