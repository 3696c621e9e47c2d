#pragma once
/// \file InspectApp.h
/// \brief `pole-extract --inspect`: what LiDAR is this, and an INI file for it.

#include <filesystem>
#include <iosfwd>
#include <optional>

#include "cli/Settings.h"
#include "core/sensor/TimingSearch.h"
#include "mrpt/rawlog/PoleSequence.h"
#include "mrpt/rawlog/RawlogInspection.h"

namespace polemcl::apps {

/// \brief Files of `pole-extract --inspect`.
struct InspectOptions {
  std::filesystem::path input;                       ///< rawlog of scans
  std::optional<std::filesystem::path> writeConfig;  ///< INI file to write, when given
  bool allowTruncated = false;                       ///< use the readable part of a damaged rawlog
  std::optional<std::filesystem::path> truth;        ///< true poses, instead of the odometry
  double turnSeconds = 0.1;                          ///< duration of a turn of the LiDAR, s
};

struct Inspection {
  RawlogInspection sensor;
  /// None if the clouds are upside down, or if there are neither odometry between all scans nor
  /// true poses.
  std::optional<TimingEstimate> timing;
  std::optional<RangeCorrection> ranges;  ///< looked for only with true poses
};

/// \brief Inspects, writes the INI file if one is wanted. \throws Error as inspectRawlog(), and
/// when the file cannot be written; it is then as it was before.
Inspection inspect(const InspectOptions& options, const ScanProgress& progress = {});

/// \brief Defaults of all programs, with the sensor that was found, its timing if it turns, and its
/// ranges if they are off.
AllSettings settingsFor(const Inspection& inspection);

/// \brief A table for people: beams, columns, view, mounting, which preset fits how well, timing.
void printInspection(std::ostream& out, const Inspection& inspection);

}  // namespace polemcl::apps
