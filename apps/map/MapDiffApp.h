#pragma once
/// \file MapDiffApp.h
/// \brief `pole-map diff`: what changed between two maps, listed and drawn.

#include <filesystem>
#include <optional>
#include <string>

#include "core/mapping/MapDiff.h"

namespace polemcl::apps {

/// \brief Files of `pole-map diff`.
struct MapDiffFiles {
  std::filesystem::path before, after;         ///< `.polemap`
  std::optional<std::filesystem::path> csv;    ///< the changes as a table, when given
  std::optional<std::filesystem::path> png;    ///< seen from above, when given
  std::optional<std::filesystem::path> scene;  ///< `.3Dscene`, when given
};

/// \brief Compares, and writes what was asked for. The table has the columns
/// `change,x,y,x_before,y_before,distance`: map frame, m; change is new, vanished or moved; a
/// vanished pole has its place in x, y; the last three are empty unless it moved.
/// \throws Error as readPoleMap() and diffMaps(); when a file cannot be written; a picture of two
///         empty maps.
MapDiff diffMapFiles(const MapDiffFiles& files, const MapDiffOptions& options);

/// \brief One line a change, then the counts.
std::string summaryText(const MapDiff& diff);

}  // namespace polemcl::apps
