#pragma once
/// \file PoleTables.h
/// \brief Poles as tables: CSV, and the NPZ of the first implementation. Positions of poles from
/// any supported file.

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "io/map/PoleMapFile.h"

namespace polemcl::io {

/// \brief Writes CSV with the header `x,y,radius,count,bottom,top,confidence,cov_xx,cov_xy,cov_yy`:
/// map frame, m and m². With histories `,existence,seen,missed,first_seen,last_seen` follow, the
/// last two as dateText(). Written atomically.
/// \param histories One per pole, or empty.
/// \throws Error when the file cannot be written.
void writePoleCsv(const std::filesystem::path& file, const std::vector<MapPole>& poles,
                  const std::vector<PoleHistory>& histories = {});

/// \name Whole maps
/// Values missing in a table get defaults: radius 0.1 m, bottom 0 and top 0 (not known), confidence
/// 1, count 1, covariance 0.01 m² in x and y.
/// @{
/// \brief Reads a CSV with columns named x and y, and any others that writePoleCsv() writes. Poles
/// have histories if there is a column `existence`; a date stands for the beginning of that day.
/// \throws Error with file and line: x or y missing, not a number, invalid count, invalid date.
PoleMapData readPoleCsv(const std::filesystem::path& file);
/// \brief Reads the array `poleparams` (x, y first) or `polemeans` (x, y and, if it has three
/// columns, radius).
/// \throws Error as readPolePositions(). Also when a radius is negative or not finite.
PoleMapData readPoleNpz(const std::filesystem::path& file);
/// @}

/// \brief Positions of the poles in a file, in the order of the file, map frame, m; nothing else in
/// the file needs to be right. Supported: `.polemap`; `.csv` with columns named x and y; `.npz`
/// with the array `poleparams` or `polemeans` (first two columns).
/// \throws Error with the file (and line): unknown extension, not readable, column or array
///         missing, not a number, damaged.
std::vector<Eigen::Vector2d> readPolePositions(const std::filesystem::path& file);

}  // namespace polemcl::io
