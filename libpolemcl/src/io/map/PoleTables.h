#pragma once
/// \file PoleTables.h
/// \brief Whole pole maps from tables of other programs: CSV, and the NPZ of the first
/// implementation. Values missing in a table get defaults: radius 0.1 m, bottom 0 and top 0 (not
/// known), confidence 1, count 1, covariance 0.01 m² in x and y.

#include <filesystem>

#include "io/map/PoleMapFile.h"

namespace polemcl::io {

/// \brief Reads a CSV with columns named x and y, and any others that writePoleCsv() writes. Poles
/// have histories if there is a column `existence`; a date stands for the beginning of that day.
/// \throws Error with file and line: x or y missing, not a number, invalid count, invalid date.
PoleMapData readPoleCsv(const std::filesystem::path& file);

/// \brief Reads the array `poleparams` (x, y first) or `polemeans` (x, y and, if it has three
/// columns, radius).
/// \throws Error as readPolePositions(). Also when a radius is negative or not finite.
PoleMapData readPoleNpz(const std::filesystem::path& file);

}  // namespace polemcl::io
