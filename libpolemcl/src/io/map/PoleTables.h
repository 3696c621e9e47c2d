#pragma once
/// \file PoleTables.h
/// \brief Whole pole maps from and to tables that others read: CSV, and the first implementation's
/// NPZ. What a table does not tell gets defaults: radius 0.1 m, bottom 0 and top 0 (not known),
/// confidence 1, count 1, covariance 0.01 m² each way.

#include <filesystem>

#include "io/map/PoleMapFile.h"

namespace polemcl::io {

/// \brief A CSV with columns named x and y, and any of those that writePoleCsv() writes. Poles have
/// histories if there is a column `existence`; days become the beginning of that day.
/// \throws Error naming file and line: no x or y, not a number, a count that is none, no day.
PoleMapData readPoleCsv(const std::filesystem::path& file);

/// \brief The array `poleparams` (x, y first) or `polemeans` (x, y and, of three columns, radius).
/// \throws Error as readPolePositions(), and when a radius is negative or not finite.
PoleMapData readPoleNpz(const std::filesystem::path& file);

/// \brief The array `polemeans`: x, y, radius of each pole, float64. \throws Error when it cannot
/// be written.
void writePoleNpz(const std::filesystem::path& file, const std::vector<MapPole>& poles);

}  // namespace polemcl::io
