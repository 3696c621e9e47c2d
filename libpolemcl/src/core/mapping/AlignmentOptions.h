#pragma once
/// \file AlignmentOptions.h
/// \brief How a session is aligned to the map before it updates it, and what the alignment did.

#include <cstddef>

#include <polemcl/export.h>

namespace polemcl {

/// \brief What the alignment of one session did.
struct AlignmentSummary {
  std::size_t scans = 0;    ///< scans in pieces with enough poles of the map
  double meanShift = 0;     ///< mean length of the corrections of these scans, m
  double largestShift = 0;  ///< m
  double largestTurn = 0;   ///< rad
};

}  // namespace polemcl
