#pragma once
/// \file MapPicture.h
/// \brief The drive from above as a PNG, drawn with Cairo: no display, no graphics card.

#include <filesystem>

#include "report/picture/MapView.h"

namespace polemcl::report {

/// \brief Draws the map from above (x right, y up, equal scales, axes in metres) with poles, truth
/// and estimate, a legend and a scale bar; and below it, when truth and estimate are both given,
/// the position and heading errors over the distance driven.
///
/// Written atomically. Same input, same bytes on one machine (fonts are the machine's).
/// \param width,height px; at least 1200 × 750.
/// \throws Error when there is nothing to show, a coordinate is not finite, the size is too small,
///         truth and estimate do not overlap in time (evaluateTrajectory()), or the file cannot be
///         written.
void drawMapPng(const MapView& view, const std::filesystem::path& file, int width = 1600,
                int height = 1000);

}  // namespace polemcl::report
