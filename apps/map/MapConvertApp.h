#pragma once
/// \file MapConvertApp.h
/// \brief `pole-map convert`: pole maps from one kind of file to another.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "io/map/Datum.h"

namespace polemcl::apps {

/// \brief Files of `pole-map convert`; their endings say what they are: `.polemap`, `.csv`,
/// `.npz` (the authors' program's, input only), `.geojson`.
struct MapConvertOptions {
  std::filesystem::path input, output;
  /// Datum of the map. Needed when the input has none; otherwise both must agree.
  std::optional<io::Datum> datum = {};
};

struct MapConvertSummary {
  std::size_t poles = 0;
  std::size_t otherFeatures = 0;  ///< of GeoJSON, no points: left out
  std::size_t candidates = 0;     ///< of a `.polemap`, left out of other files
};

/// \brief Converts. From `.polemap` to `.polemap` everything is kept, so that a datum can be set.
/// \throws Error naming the file: of unknown ending, no pole in it, as readers and writers do, of
///         another datum.
MapConvertSummary convertMap(const MapConvertOptions& options);

/// \brief What the program prints.
std::string summaryText(const MapConvertSummary& summary, const MapConvertOptions& options);

}  // namespace polemcl::apps
