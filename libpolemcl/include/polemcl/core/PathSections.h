#pragma once
/// \file PathSections.h
/// \brief A path split into sections of equal length along the way travelled.

#include <polemcl/core/Types.h>

#include <cstdint>
#include <vector>

namespace polemcl {

/// \brief A section with at least one scan.
struct PathSection {
  std::uint32_t path = 0;  ///< 0 for the first drive, 1 for the second, …
  std::size_t index = 0;   ///< number of the section on its path: [index, index + 1) · length
  std::vector<std::size_t> scans;  ///< by ascending index
  std::size_t middle =
      0;  ///< of these the scan nearest to the middle of the section; of equals the first
};

struct PathSections {
  std::vector<PathSection> occupied;  ///< in the order travelled
  std::size_t count = 0;              ///< all sections, those without a scan included
  double length = 0;                  ///< of all paths, m
};

/// \brief Splits the way travelled.
///
/// The length grows only with what leads away from where the last part of a section was completed:
/// the jitter of a vehicle that stands adds nothing, so nothing is counted twice from one place.
/// \param poses Finite, in the order travelled.
/// \param drives One a pose: where it changes, a new path begins with a section of its own.
/// \param sectionLength > 0, m.
/// \param used One a pose, or empty for all: the others are part of the way only, no scan.
PathSections splitPath(const std::vector<Pose2D>& poses, const std::vector<std::uint32_t>& drives,
                       double sectionLength, const std::vector<bool>& used = {});

}  // namespace polemcl
