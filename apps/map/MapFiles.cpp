#include "map/MapFiles.h"

#include "io/map/PoleTables.h"
#include "map/GeoJson.h"

namespace polemcl::apps {

MapFileKind mapFileKind(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  if (ending == ".polemap") return MapFileKind::polemap;
  if (ending == ".csv") return MapFileKind::csv;
  if (ending == ".npz") return MapFileKind::npz;
  if (ending == ".geojson") return MapFileKind::geojson;
  throw Error(file.string() + ": unknown kind of map '" + ending +
              "'; allowed: .polemap, .csv, .npz, .geojson");
}

MapContent readMapFile(const std::filesystem::path& file, const std::optional<io::Datum>& datum) {
  MapContent content;
  switch (mapFileKind(file)) {
    case MapFileKind::polemap:
      content.map = io::readPoleMap(file, &content.scans);
      break;
    case MapFileKind::csv:
      content.map = io::readPoleCsv(file);
      break;
    case MapFileKind::npz:
      content.map = io::readPoleNpz(file);
      break;
    case MapFileKind::geojson:
      content.map = readGeoJson(file, datum, &content.otherFeatures);
      break;
  }
  return content;
}

void writeMapFile(const std::filesystem::path& file, const MapContent& content) {
  const io::PoleMapData& map = content.map;
  switch (mapFileKind(file)) {
    case MapFileKind::polemap:
      return io::writePoleMap(file, map, content.scans ? &*content.scans : nullptr);
    case MapFileKind::csv:
      return io::writePoleCsv(file, map.poles, map.histories);
    case MapFileKind::npz:
      throw Error(file.string() +
                  ": .npz files are read only; write .csv, or save the map in Python: "
                  "polemcl.PoleMap.load(\"MAP.polemap\").save(\"MAP.npz\")");
    case MapFileKind::geojson:
      return writeGeoJson(file, map);
  }
}

}  // namespace polemcl::apps
