#pragma once
/// \file ScanFixes.h
/// \brief Positions from satellites among the scans of a folder.

#include <string>

#include "io/dataset/ScanFolder.h"

namespace polemcl::io {

/// \brief Sigma of a fix of which none is stated, m. Assumed: a single receiver under open sky.
constexpr double kAssumedFixSigma = 2.5;

/// \brief Adds a fix. One that is not finite or not on the globe is left out.
void takeFix(const GnssFix& fix, ScanFolder& folder);

/// \brief Sorts the fixes by time, and adds a note with their number and source.
void finishFixes(const std::string& source, ScanFolder& folder);

}  // namespace polemcl::io
