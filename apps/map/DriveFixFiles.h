#pragma once
/// \file DriveFixFiles.h
/// \brief Positions from satellites, in tables beside rawlogs or in these.

#include <filesystem>
#include <optional>
#include <vector>

#include "core/slam/DriveFixes.h"
#include "io/map/Datum.h"
#include "map/MapBuildApp.h"

namespace polemcl::apps {

/// \brief Reads the fixes of drives onto the plane of a datum: of the tables (readGnssCsv()), or
/// without tables those in the rawlogs (readGnssFixes()). Those before the first scan, after the
/// last one, or between scans more than 2 s apart are left out, as are those more than 50 km from
/// the median place of their file.
/// \param firstScan Number of the first scan of these drives.
/// \param datum If none is given: becomes the first fix.
/// \throws Error as the readers; when no fix of a table lies within its drive; when the fixes of a
/// drive are more than 50 km from the datum.
std::vector<DriveFix> readDriveFixes(const MapBuildJob& job,
                                     const std::vector<MappingSession>& drives,
                                     std::size_t firstScan, std::optional<io::Datum>& datum);

}  // namespace polemcl::apps
