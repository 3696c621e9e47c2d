#pragma once
/// \file PolePositions.h
/// \brief Poles to CSV, and positions of poles from whatever file holds them.

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "core/common/Types.h"
#include "core/mapping/PoleExistence.h"

namespace polemcl::io {

/// \brief CSV with the header `x,y,radius,count,bottom,top,confidence,cov_xx,cov_xy,cov_yy`: map
/// frame, m and m². With histories `,existence,seen,missed,first_seen,last_seen` follow, the last
/// two as dateText(). Written atomically. \param histories One for each pole, or none. \throws
/// Error when it cannot be written.
void writePoleCsv(const std::filesystem::path& file, const std::vector<MapPole>& poles,
                  const std::vector<PoleHistory>& histories = {});

/// \brief Positions of the poles in a file, in its order, map frame, m:
/// `.polemap`; `.csv` with columns named x and y; `.npz` with the array `poleparams` or
/// `polemeans`, first two columns. \throws Error naming the file (and line): unknown ending, cannot
/// be read, no such column or
///         array, not a number, damaged.
std::vector<Eigen::Vector2d> readPolePositions(const std::filesystem::path& file);

}  // namespace polemcl::io
