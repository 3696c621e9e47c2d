#pragma once
/// \file NcltGps.h
/// \brief Positions from the GPS receiver of NCLT.

#include "io/dataset/ScanFolder.h"
#include "io/file/TextFile.h"

namespace polemcl::io {

/// \brief Adds the fixes of `gps.csv`, with a note: utime (µs), mode, number of satellites,
/// latitude and longitude (rad), altitude, track, speed.
///
/// Rows of mode 2 and 3 (fixes in two and three dimensions) are taken. The file states no sigma:
/// 2.5 m is assumed, and that the antenna is at the robot.
/// \throws Error with file and line: rows too short, not a number.
void addNcltFixes(const std::filesystem::path& file, const ReadProgress& progress,
                  ScanFolder& folder);

}  // namespace polemcl::io
