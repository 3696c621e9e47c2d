#pragma once
/// \file DriveFixFiles.h
/// \brief Positions from satellites, in tables beside rawlogs or in these.

#include <filesystem>
#include <optional>
#include <vector>

#include "core/common/GnssFix.h"
#include "core/slam/DriveFixes.h"
#include "io/map/Datum.h"
#include "map/MapBuildApp.h"

namespace polemcl::apps {

/// \brief Reads the columns `time` (s, clock of the scans), `latitude`, `longitude` (deg, WGS 84)
/// and `sigma` (m, along each axis); `antenna_x` and `antenna_y` (m, frame of the robot) may be
/// absent. \throws Error with file and line: as io::CsvTable; a number out of its range; times that
/// go back.
std::vector<GnssFix> readGnssCsv(const std::filesystem::path& file);

/// \brief Fixes that were read.
struct ReadFixes {
  std::vector<DriveFix> fixes;     ///< by scans
  std::vector<std::size_t> apart;  ///< of each drive: left out, their scans are too far apart
};

/// \brief Reads the fixes of drives onto the plane of a datum: of the tables (readGnssCsv()), or
/// without tables those in the rawlogs (readGnssFixes()). Those before the first scan or after the
/// last one are left out, as are those between scans more than 2 s and 10 m apart, and those more
/// than 50 km from the median place of their file.
/// \param firstScan Number of the first scan of these drives.
/// \param datum If none is given: becomes the first fix.
/// \throws Error as the readers; when no fix of a table lies within its drive, or all of these
/// between scans too far apart; when the fixes of a drive are more than 50 km from the datum.
ReadFixes readDriveFixes(const MapBuildJob& job, const std::vector<MappingSession>& drives,
                         std::size_t firstScan, std::optional<io::Datum>& datum);

}  // namespace polemcl::apps
