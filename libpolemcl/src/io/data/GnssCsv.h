#pragma once
/// \file GnssCsv.h
/// \brief Positions from satellites in a table.

#include <filesystem>
#include <vector>

#include "core/common/GnssFix.h"

namespace polemcl::io {

/// \brief Reads the columns `time` (s, clock of the scans), `latitude`, `longitude` (deg, WGS 84)
/// and `sigma` (m, along each axis); `antenna_x` and `antenna_y` (m, frame of the robot) may be
/// absent. \throws Error with file and line: as CsvTable; a number out of its range; times that go
/// back.
std::vector<GnssFix> readGnssCsv(const std::filesystem::path& file);

}  // namespace polemcl::io
