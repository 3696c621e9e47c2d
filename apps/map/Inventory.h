#pragma once
/// \file Inventory.h
/// \brief Poles as cities and OpenStreetMap publish them: places with properties, no scans.

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace polemcl::apps {

/// \brief One entry of an inventory.
struct InventoryEntry {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< as in the file: its coordinate system
  /// Columns, OSM tags, or GeoJSON properties: texts as they are, others as JSON.
  std::map<std::string, std::string> properties;
  std::string where;  ///< "FILE:LINE: " or "FILE: feature N: ", for messages
};

/// \brief Reads a CSV with a header.
/// \param columns Names of the columns of the place; empty: `lon` and `lat`, `longitude` and
/// `latitude`, or `x` and `y`, the first pair that is there.
/// \param separator Between fields.
/// \throws Error with file and line: no such columns, not a number; a name of more than 256 bytes.
std::vector<InventoryEntry> readCsvInventory(const std::filesystem::path& file,
                                             const std::vector<std::string>& columns,
                                             char separator);

/// \brief Reads the points of a GeoJSON FeatureCollection.
/// \param left Gets the number of features that are no points.
/// \throws Error naming the feature: not GeoJSON, coordinates that are none.
std::vector<InventoryEntry> readGeoJsonInventory(const std::filesystem::path& file,
                                                 std::size_t& left);

/// \brief Reads poles from OSM XML, Lanelet2's maps among it; longitude and latitude. Poles are
/// nodes with `highway=street_lamp`, `power=pole`, `man_made=utility_pole`, `natural=tree`,
/// `traffic_sign=…`, `highway=traffic_signals`, `barrier=bollard`, and ways with `type=pole`,
/// `traffic_sign` or `traffic_light` (Lanelet2), which stand in their middle. The property `kind`
/// is `lamp`, `pole`, `tree`, `sign`, `light` or `bollard`.
/// \throws Error with file and line: not XML, a node without a place, a way with unknown nodes
/// only, a node or way inside another.
std::vector<InventoryEntry> readOsmInventory(const std::filesystem::path& file);

}  // namespace polemcl::apps
