#pragma once
/// \file MapFiles.h
/// \brief Pole maps from and to files of any kind; the ending of the name says which.

#include <cstddef>
#include <filesystem>
#include <optional>

#include "core/mapping/MapAccumulator.h"
#include "io/map/Datum.h"
#include "io/map/PoleMapFile.h"

namespace polemcl::apps {

/// \brief `.polemap`, `.csv`, `.npz` (the authors' program's, read only), `.geojson`.
enum class MapFileKind { polemap, csv, npz, geojson };

/// \throws Error on any other ending.
MapFileKind mapFileKind(const std::filesystem::path& file);

/// \brief All that a file of some kind can hold.
struct MapContent {
  io::PoleMapData map;
  std::optional<AddedSessions> scans = {};  ///< only of a `.polemap`
  std::size_t otherFeatures = 0;            ///< of GeoJSON, no points: left out
};

/// \param datum As in readGeoJson(); not used for other kinds.
/// \throws Error naming the file: of unknown ending, or as its reader does.
MapContent readMapFile(const std::filesystem::path& file,
                       const std::optional<io::Datum>& datum = std::nullopt);

/// \brief Writes atomically what the kind can hold: everything in a `.polemap`, no candidates in
/// the others. \throws Error naming the file: of unknown ending, or as its writer does.
void writeMapFile(const std::filesystem::path& file, const MapContent& content);

}  // namespace polemcl::apps
