#pragma once
/// \file DiffPicture.h
/// \brief What changed between two maps, from above, as a PNG drawn with Cairo.

#include <filesystem>
#include <string>

#include "core/mapping/MapDiff.h"

namespace polemcl::report {

/// \brief Draws what stayed in grey, what is new in green, what vanished as an orange ring, and
/// what moved in blue with a line from its old place; a legend with the counts. x right, y up, m.
///
/// Written atomically. Same input, same bytes on one machine.
/// \param width,height px; at least 1200 × 750.
/// \throws Error when both maps are empty, a coordinate is not finite, the size is too small, or
///         the file cannot be written.
void drawDiffPng(const MapDiff& diff, const std::string& title, const std::filesystem::path& file,
                 int width = 1600, int height = 1000);

}  // namespace polemcl::report
