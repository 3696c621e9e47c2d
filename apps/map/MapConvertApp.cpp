#include "map/MapConvertApp.h"

#include <sstream>

#include "cli/Version.h"
#include "map/MapFiles.h"

namespace polemcl::apps {
MapConvertSummary convertMap(const MapConvertOptions& options) {
  const MapFileKind written = mapFileKind(options.output);  // before anything is read
  MapContent content = readMapFile(options.input, options.datum);
  io::PoleMapData& map = content.map;
  if (map.poles.empty()) throw Error(options.input.string() + ": no pole in it");
  if (options.datum) io::setDatum(map.info, *options.datum, options.input.string() + ": ");
  if (map.info.count("program") == 0) {
    map.info["program"] = std::string("pole-map ") + version();
    map.info["build"] = buildIdentity();
    map.info["converted_from"] = options.input.filename().string();
  }
  writeMapFile(options.output, content);
  MapConvertSummary summary;
  summary.poles = map.poles.size();
  summary.otherFeatures = content.otherFeatures;
  if (written != MapFileKind::polemap) summary.candidates = map.candidates.size();
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
