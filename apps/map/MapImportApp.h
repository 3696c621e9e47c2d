#pragma once
/// \file MapImportApp.h
/// \brief `pole-map import`: pole maps from inventories of cities and from OpenStreetMap.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/map/Datum.h"

namespace polemcl::apps {

/// \brief Files and options of `pole-map import`. The ending of the input says what it is: `.csv`,
/// `.geojson` or `.json`, `.osm` or `.xml`.
struct MapImportOptions {
  std::filesystem::path input, output;
  std::string coordinates = "EPSG:4326";  ///< coordinate system of the places; see CoordinateSystem
  std::vector<std::string> columns = {};  ///< CSV: names of the two columns of a place, or none
  char separator = ',';                   ///< CSV
  std::vector<std::string> keep = {};     ///< NAME=VALUE: entries that have one of them; none: all
  std::string radiusProperty = {};        ///< holds the radius; empty: radii are not known
  double radiusUnit = 1;                  ///< m per unit of that property
  double sigma = 0.5;                     ///< standard deviation of the places along an axis, m
  double merge = 0.5;                     ///< entries nearer to an earlier one are left out, m
  std::optional<io::Datum> datum = {};    ///< of the map; none: the middle of the poles
};

struct MapImportSummary {
  std::size_t poles = 0;
  std::size_t others = 0;   ///< features that are no points, or not kept
  std::size_t doubles = 0;  ///< left out, as a pole stands there already
  io::Datum datum;
  std::string found;  ///< values of the properties that `keep` names, with counts
};

/// \brief Reads an inventory and writes a `.polemap`. Poles have the covariance `sigma`², the
/// confidence 0.9 and, unless told, the radius 0: not known.
/// \throws Error naming file and place: as the readers do; no pole left; a pole 100 km and more
///         from the datum; a radius that is no number, or out of range.
MapImportSummary importMap(const MapImportOptions& options);

/// \brief What the program prints.
std::string summaryText(const MapImportSummary& summary, const MapImportOptions& options);

}  // namespace polemcl::apps
