#pragma once
/// \file PolePositions.h
/// \brief Poles to CSV, and positions of poles from any supported file.

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "core/mapping/PoleExistence.h"

namespace polemcl::io {

/// \brief Writes CSV with the header `x,y,radius,count,bottom,top,confidence,cov_xx,cov_xy,cov_yy`:
/// map frame, m and m². With histories `,existence,seen,missed,first_seen,last_seen` follow, the
/// last two as dateText(). Written atomically.
/// \param histories One per pole, or empty.
/// \throws Error when the file cannot be written.
void writePoleCsv(const std::filesystem::path& file, const std::vector<MapPole>& poles,
                  const std::vector<PoleHistory>& histories = {});

/// \brief Positions of the poles in a file, in the order of the file, map frame, m. Supported:
/// `.polemap`; `.csv` with columns named x and y; `.npz` with the array `poleparams` or `polemeans`
/// (first two columns).
/// \throws Error with the file (and line): unknown extension, not readable, column or array
///         missing, not a number, damaged.
std::vector<Eigen::Vector2d> readPolePositions(const std::filesystem::path& file);

}  // namespace polemcl::io
