#pragma once
/// \file LabelsApp.h
/// \brief `pole-labels`: SemanticKITTI's labels and poses -> a map of the poles that really stand.

#include <filesystem>
#include <functional>

#include "core/mapping/LabelMapBuilder.h"

namespace polemcl::apps {

/// \brief What `pole-labels` reads and writes.
struct LabelsOptions {
  /// `sequences/NN`: `velodyne/*.bin`, `labels/*.label`, and what readKittiOdometry() needs beside.
  std::filesystem::path input;
  std::filesystem::path output;  ///< `.polemap` or `.csv`
  LabelMapOptions labels;
};

struct LabelsSummary {
  std::size_t scans = 0, points = 0, poles = 0;  ///< points of poles
};

/// \brief Reads scan after scan, none is held; writes the poles in the LiDAR frame of scan 0, as
/// pole-import has them.
/// \param progress Called with the scans done and those in all; may be empty.
/// \throws Error as readKittiOdometry() and readLabelledCloud(); no poses; no pole found; an output
///         of another ending.
LabelsSummary mapLabels(const LabelsOptions& options,
                        const std::function<void(std::size_t, std::size_t)>& progress = {});

/// \brief The program. \return An ExitCode.
int labelsMain(int argc, const char* const* argv);

}  // namespace polemcl::apps
