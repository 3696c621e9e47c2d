#pragma once
/// \file InspectApp.h
/// \brief `pole-extract --inspect`: what LiDAR is this, and an INI file for it.

#include <filesystem>
#include <iosfwd>
#include <optional>

#include "cli/Settings.h"
#include "mrpt/rawlog/RawlogInspection.h"

namespace polemcl::apps {

/// \brief Files of `pole-extract --inspect`.
struct InspectOptions {
  std::filesystem::path input;                       ///< rawlog of scans
  std::optional<std::filesystem::path> writeConfig;  ///< INI file to write, when given
  bool allowTruncated = false;                       ///< use the readable part of a damaged rawlog
};

/// \brief Inspects, writes the INI file if one is wanted. \throws Error as inspectRawlog(), and
/// when the file cannot be written; it is then as it was before.
RawlogInspection inspect(const InspectOptions& options);

/// \brief Defaults of all programs, with the sensor that was found.
Settings settingsFor(const RawlogInspection& inspection);

/// \brief A table for people: beams, columns, view, mounting, and which preset fits how well.
void printInspection(std::ostream& out, const RawlogInspection& inspection);

}  // namespace polemcl::apps
