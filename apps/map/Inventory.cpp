#include "map/Inventory.h"

#include <polemcl/core/common/Types.h>
#include "io/file/CsvTable.h"
#include "map/GeoJson.h"

namespace polemcl::apps {
namespace {

using Columns = std::vector<std::string>;

Columns columnsOf(const io::CsvTable& table, const Columns& asked,
                  const std::filesystem::path& file) {
  if (!asked.empty()) return asked;
  for (const Columns& usual : {Columns{"lon", "lat"}, {"longitude", "latitude"}, {"x", "y"}})
    if (table.find(usual[0]) && table.find(usual[1])) return usual;
  throw Error(file.string() +
              ": no columns lon and lat, longitude and latitude, or x and y; say which hold the "
              "place with --columns EAST,NORTH, and what is between fields with --separator");
}

}  // namespace

std::vector<InventoryEntry> readCsvInventory(const std::filesystem::path& file,
                                             const Columns& asked, char separator) {
  const io::CsvTable table(file, separator);
  const Columns columns = columnsOf(table, asked, file);
  const std::size_t x = table.column(columns[0]), y = table.column(columns[1]);
  std::vector<InventoryEntry> entries;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    InventoryEntry entry{{table.number(row, x), table.number(row, y)}, {}, table.at(row)};
    for (std::size_t c = 0; c < table.names().size(); ++c)
      entry.properties[table.names()[c]] = table.text(row, c);
    entries.push_back(std::move(entry));
  }
  return entries;
}

std::vector<InventoryEntry> readGeoJsonInventory(const std::filesystem::path& file,
                                                 std::size_t& left) {
  std::vector<InventoryEntry> entries;
  for (GeoJsonPoint& point : readGeoJsonPoints(file, left))
    entries.push_back({point.coordinates, std::move(point.properties), std::move(point.where)});
  return entries;
}

}  // namespace polemcl::apps
