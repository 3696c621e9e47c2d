#include "map/MapConvertApp.h"

#include <sstream>

#include <polemcl/io/map/PoleMapFile.h>
#include "cli/Version.h"
#include "core/mapping/MapAccumulator.h"
#include "io/map/PolePositions.h"
#include "io/map/PoleTables.h"
#include "map/GeoJson.h"

namespace polemcl::apps {
namespace {

enum class Kind { polemap, csv, npz, geojson };

Kind kindOf(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  if (ending == ".polemap") return Kind::polemap;
  if (ending == ".csv") return Kind::csv;
  if (ending == ".npz") return Kind::npz;
  if (ending == ".geojson") return Kind::geojson;
  throw Error(file.string() + ": unknown kind of map '" + ending +
              "'; allowed: .polemap, .csv, .npz, .geojson");
}

io::PoleMapData readMap(const MapConvertOptions& options, MapConvertSummary& summary) {
  const auto& file = options.input;
  switch (kindOf(file)) {
    case Kind::polemap:
      return io::readPoleMap(file);
    case Kind::csv:
      return io::readPoleCsv(file);
    case Kind::npz:
      return io::readPoleNpz(file);
    case Kind::geojson:
      break;
  }
  return readGeoJson(file, options.datum, &summary.otherFeatures);
}

void writeMap(const MapConvertOptions& options, const io::PoleMapData& map) {
  switch (kindOf(options.output)) {
    case Kind::polemap: {
      std::optional<AddedSessions> scans;
      if (kindOf(options.input) == Kind::polemap) scans = io::readMapScans(options.input);
      return io::writePoleMap(options.output, map, scans ? &*scans : nullptr);
    }
    case Kind::csv:
      return io::writePoleCsv(options.output, map.poles, map.histories);
    case Kind::npz:
      return io::writePoleNpz(options.output, map.poles);
    case Kind::geojson:
      return writeGeoJson(options.output, map);
  }
}

}  // namespace

MapConvertSummary convertMap(const MapConvertOptions& options) {
  kindOf(options.output);  // before anything is read
  MapConvertSummary summary;
  io::PoleMapData map = readMap(options, summary);
  if (map.poles.empty()) throw Error(options.input.string() + ": no pole in it");
  if (options.datum) io::setDatum(map.info, *options.datum, options.input.string() + ": ");
  if (map.info.count("program") == 0) {
    map.info["program"] = std::string("pole-map ") + version();
    map.info["build"] = buildIdentity();
    map.info["converted_from"] = options.input.filename().string();
  }
  writeMap(options, map);
  summary.poles = map.poles.size();
  if (kindOf(options.output) != Kind::polemap) summary.candidates = map.candidates.size();
  return summary;
}

std::string summaryText(const MapConvertSummary& summary, const MapConvertOptions& options) {
  std::ostringstream out;
  out << options.output.string() << ": " << summary.poles << " poles\n";
  if (summary.otherFeatures > 0)
    out << "features that are no points, left out: " << summary.otherFeatures << '\n';
  if (summary.candidates > 0)
    out << "candidates, which are not on the map, left out: " << summary.candidates << '\n';
  return out.str();
}

}  // namespace polemcl::apps
