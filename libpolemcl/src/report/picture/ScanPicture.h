#pragma once
/// \file ScanPicture.h
/// \brief One scan from above with the poles found in it, as a PNG, to be looked at.

#include <filesystem>
#include <string>
#include <vector>

#include <polemcl/core/common/Types.h>

namespace polemcl::report {

/// \brief What is drawn. Points and poles in one frame, the sensor at its origin, z up.
struct ScanView {
  std::string title;  ///< one line, UTF-8
  PointsView points;  ///< borrowed; NaN and infinite points are not drawn
  double ground = 0;  ///< height of the ground in that frame, m: points are coloured by height
  std::vector<PoleDetection> poles;
};

/// \brief Draws the scan from above (x right, y up, equal scales): points coloured by their height
/// above the ground, a ring round each pole with its top (m) and confidence beside it.
///
/// Covers all poles with a margin, 12 to 60 m to each side. Written atomically.
/// \param size px, width and height; at least 800.
/// \throws Error when there is no point, a pole is not finite, the size is too small, or the file
///         cannot be written.
void drawScanPng(const ScanView& view, const std::filesystem::path& file, int size = 1500);

}  // namespace polemcl::report
