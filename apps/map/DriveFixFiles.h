#pragma once
/// \file DriveFixFiles.h
/// \brief Positions from satellites beside rawlogs.

#include <filesystem>
#include <optional>
#include <vector>

#include "core/slam/DriveFixes.h"
#include "io/map/Datum.h"
#include "map/MappingSession.h"

namespace polemcl::apps {

/// \brief Reads the fixes of drives (readGnssCsv()), onto the plane of a datum. Those before the
/// first scan, after the last one, or between scans more than 2 s apart are left out.
/// \param files One per drive. \param firstScan Number of the first scan of these drives.
/// \param datum If none is given: becomes the first fix.
/// \throws Error as readGnssCsv(); when no fix of a file lies within its drive.
std::vector<DriveFix> readDriveFixes(const std::vector<std::filesystem::path>& files,
                                     const std::vector<MappingSession>& drives,
                                     std::size_t firstScan, std::optional<io::Datum>& datum);

}  // namespace polemcl::apps
