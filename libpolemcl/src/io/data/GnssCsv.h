#pragma once
/// \file GnssCsv.h
/// \brief Positions from satellites in a table.

#include <filesystem>
#include <vector>

#include "core/common/GnssFix.h"

namespace polemcl::io {

/// \brief Reads the columns `time` (s), `latitude`, `longitude` (deg on WGS 84) and `sigma` (m,
/// along each horizontal axis) of a CSV file; others are ignored. The antenna is at the robot.
/// \throws Error as CsvTable; with file and line when a latitude is beyond ±90, a longitude beyond
///         ±180, a sigma not above 0, or a time before that of the row above.
std::vector<GnssFix> readGnssCsv(const std::filesystem::path& file);

}  // namespace polemcl::io
