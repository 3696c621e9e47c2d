#pragma once
/// \file MotionEval.h
/// \brief `pole-eval motion`: do the true poses agree with what the poles of single scans say? No
/// map, no filter: only which way the robot went between two scans that saw the same poles.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/localization/ScanRegistration.h"

namespace polemcl::apps {

struct EvalMotionOptions {
  std::filesystem::path poles;  ///< rawlog of poles
  std::filesystem::path truth;  ///< TUM, robot poses
  std::size_t every = 4;  ///< scans 0, N, 2N, … are compared, each with the next; at least 1
  std::optional<std::filesystem::path> json;
};

/// \brief One stretch between two scans, as three sources have it: robot motions in the frame of
/// the first scan, m and rad.
struct MotionComparison {
  std::size_t scan = 0;  ///< 0-based index of the first scan
  Pose2D truth;
  std::optional<Pose2D> odometry;  ///< none where the rawlog has none
  ScanRegistration poles;  ///< from the true motion on; fewer than 3 pairs: the poles do not tell
};

/// \brief \throws Error naming the file: a scan at a time without a true pose, fewer than two scans
/// to compare, a rawlog of scans instead of poles.
std::vector<MotionComparison> evalMotion(const EvalMotionOptions& options);

}  // namespace polemcl::apps
