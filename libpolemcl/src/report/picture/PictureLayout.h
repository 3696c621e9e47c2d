#pragma once
/// \file PictureLayout.h
/// \brief Where the parts of the picture go, so that the map is as large as its shape allows.

#include "report/picture/Canvas.h"
#include "report/picture/MapView.h"

namespace polemcl::report {

/// \brief Frames of the plots, px, labels outside of them. Without errors the strips are empty.
struct PictureLayout {
  Rect map, position, heading;
};

/// \throws Error naming the file when the picture is smaller than 1200 x 750 px.
void requireSize(int width, int height, const std::filesystem::path& file);

/// \brief The strips of errors go below the map (long streets) or to its right (others), whichever
/// shows the map larger. The uppermost 96 px are left to title and legend.
PictureLayout layoutPicture(int width, int height, const Bounds& bounds, bool withErrors);

}  // namespace polemcl::report
