#include "map/MapImportApp.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "cli/Projections.h"
#include "cli/Version.h"
#include "core/common/KdTree2D.h"
#include "io/file/ErrorPlace.h"
#include "io/file/TextFile.h"
#include "io/map/PoleMapFile.h"
#include "map/GeoJson.h"
#include "map/Inventory.h"

namespace polemcl::apps {
namespace {

constexpr double kConfidence = 0.9;  ///< inventories hold poles that are gone

/// Options that the kind of inventory has no use for.
void requireFitting(const MapImportOptions& options, const std::string& ending) {
  const std::string file = options.input.string();
  const MapImportOptions usual;
  const bool isOsm = ending == ".osm" || ending == ".xml";
  if (!isOsm && ending != ".geojson" && ending != ".json") return;
  if (!options.columns.empty() || options.separator != usual.separator)
    throw Error(file + ": --columns and --separator are for CSV files");
  if (isOsm && options.coordinates != usual.coordinates)
    throw Error(file + ": places of OpenStreetMap are in WGS 84; leave out --crs");
}

std::vector<InventoryEntry> readInventory(const MapImportOptions& options, std::size_t& left) {
  const std::string ending = options.input.extension().string();
  requireFitting(options, ending);
  if (ending == ".csv") return readCsvInventory(options.input, options.columns, options.separator);
  if (ending == ".geojson" || ending == ".json") return readGeoJsonInventory(options.input, left);
  if (ending == ".osm" || ending == ".xml") return readOsmInventory(options.input);
  throw Error(options.input.string() + ": unknown kind of inventory '" + ending +
              "'; allowed: .csv, .geojson, .json, .osm, .xml");
}

bool isKept(const InventoryEntry& entry, const std::vector<std::string>& keep) {
  if (keep.empty()) return true;
  for (const std::string& wanted : keep) {
    const auto equals = wanted.find('=');
    const auto found = entry.properties.find(wanted.substr(0, equals));
    if (found != entry.properties.end() && found->second == wanted.substr(equals + 1)) return true;
  }
  return false;
}

/// The first of them with their counts: "lamp (12), tree (3), …".
std::string listed(const std::map<std::string, std::size_t>& counts) {
  constexpr std::size_t kMost = 10;
  std::string text;
  std::size_t number = 0;
  for (const auto& [name, count] : counts) {
    if (number++ > 0) text += ", ";
    if (number > kMost) return text + "…";
    text += name + " (" + std::to_string(count) + ")";
  }
  return text;
}

/// What the entries have for the properties that --keep names: "kind: lamp (12), tree (3)"; for one
/// that none has, the names that they do have.
std::string found(const std::vector<InventoryEntry>& entries,
                  const std::vector<std::string>& keep) {
  std::set<std::string> wanted;
  for (const std::string& assignment : keep)
    wanted.insert(assignment.substr(0, assignment.find('=')));
  std::string text;
  for (const std::string& name : wanted) {
    std::map<std::string, std::size_t> values, names;
    for (const InventoryEntry& entry : entries)
      for (const auto& [property, value] : entry.properties) {
        ++names[property];
        if (property == name) ++values[value];
      }
    if (!text.empty()) text += "; ";
    text += values.empty() ? "no entry has '" + name + "', but " + listed(names)
                           : name + ": " + listed(values);
  }
  return text;
}

void requireRadii(const std::vector<InventoryEntry>& entries, const MapImportOptions& options) {
  const std::string& name = options.radiusProperty;
  if (name.empty() || std::any_of(entries.begin(), entries.end(), [&](const InventoryEntry& entry) {
        return entry.properties.count(name) > 0;
      }))
    return;
  throw Error(options.input.string() + ": --radius-property: " + found(entries, {name + "="}));
}

double radiusOf(const InventoryEntry& entry, const MapImportOptions& options) {
  if (options.radiusProperty.empty()) return 0;
  const auto found = entry.properties.find(options.radiusProperty);
  if (found == entry.properties.end() || found->second.empty()) return 0;  // not known
  const auto value = io::parseNumber(found->second);
  const double radius = value ? *value * options.radiusUnit : -1;
  if (!(radius >= 0 && radius <= 5))
    throw Error(entry.where + options.radiusProperty + " = '" + found->second +
                "' is no radius; with --radius-unit it must be from 0 to 5 m");
  return radius;
}

/// Middle of the box round the places, to a millionth of a degree; also across 180 degrees.
io::Datum middleOf(const std::vector<Eigen::Vector2d>& lonLats) {
  Eigen::Vector2d low = lonLats.front(), high = low;
  for (Eigen::Vector2d at : lonLats) {
    at.x() = lonLats.front().x() + std::remainder(at.x() - lonLats.front().x(), 360);
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  const Eigen::Vector2d middle = (low + high) / 2;
  io::Datum datum;
  datum.longitude = std::round(std::remainder(middle.x(), 360) * 1e6) / 1e6;
  datum.latitude = std::round(middle.y() * 1e6) / 1e6;
  return datum;
}

/// Whether each place stays: no earlier one that stays lies nearer than a distance.
std::vector<bool> withoutDoubles(const std::vector<Eigen::Vector2d>& places, double distance) {
  const KdTree2D tree(places);
  std::vector<bool> stays(places.size(), true);
  std::vector<PointHit> hits;
  for (std::size_t i = 0; i < places.size(); ++i) {
    tree.within(places[i].x(), places[i].y(), 1.001 * distance, hits);  // wider: rounding
    stays[i] = std::none_of(hits.begin(), hits.end(), [&](const PointHit& hit) {
      return hit.index < i && stays[hit.index] && (places[hit.index] - places[i]).norm() < distance;
    });
  }
  return stays;
}

std::vector<Eigen::Vector2d> lonLatsOf(const std::vector<InventoryEntry>& entries,
                                       const std::string& coordinates) {
  const CoordinateSystem system(coordinates);
  std::vector<Eigen::Vector2d> lonLats;
  lonLats.reserve(entries.size());
  for (const InventoryEntry& entry : entries)
    lonLats.push_back(io::located(entry.where, [&] { return system.lonLat(entry.place); }));
  return lonLats;
}

MapPole poleAt(const Eigen::Vector2d& place, double radius, double sigma) {
  MapPole pole;
  pole.x = place.x();
  pole.y = place.y();
  pole.radius = radius;
  pole.confidence = kConfidence;
  pole.covariance = Eigen::Matrix2d::Identity() * sigma * sigma;
  pole.count = 1;
  return pole;
}

}  // namespace

MapImportSummary importMap(const MapImportOptions& options) {
  if (options.output.extension() != ".polemap")
    throw Error(options.output.string() + ": the map to write must end in .polemap");
  MapImportSummary summary;
  std::vector<InventoryEntry> entries = readInventory(options, summary.others);
  if (entries.empty())
    throw Error(options.input.string() + ": no pole in it" + othersText(summary.others));
  requireRadii(entries, options);
  summary.found = found(entries, options.keep);
  const auto kept =
      std::remove_if(entries.begin(), entries.end(),
                     [&](const InventoryEntry& entry) { return !isKept(entry, options.keep); });
  summary.others += static_cast<std::size_t>(entries.end() - kept);
  entries.erase(kept, entries.end());
  if (entries.empty())
    throw Error(options.input.string() + ": no pole in it that --keep keeps; there is " +
                summary.found);
  const std::vector<Eigen::Vector2d> lonLats = lonLatsOf(entries, options.coordinates);
  summary.datum = options.datum ? *options.datum : middleOf(lonLats);

  io::PoleMapData map;
  const MapPlane plane(summary.datum);
  std::vector<Eigen::Vector2d> places;
  for (std::size_t i = 0; i < entries.size(); ++i)
    places.push_back(io::located(entries[i].where, [&] { return plane.place(lonLats[i]); }));
  const std::vector<bool> stays = withoutDoubles(places, options.merge);
  for (std::size_t i = 0; i < entries.size(); ++i)
    if (stays[i])
      map.poles.push_back(poleAt(places[i], radiusOf(entries[i], options), options.sigma));
  summary.poles = map.poles.size();
  summary.doubles = entries.size() - map.poles.size();
  io::setDatum(map.info, summary.datum, options.input.string() + ": ");
  map.info["program"] = std::string("pole-map ") + version();
  map.info["build"] = buildIdentity();
  map.info["imported_from"] = options.input.filename().string();
  map.info["sigma_m"] = io::significant(options.sigma, 9);
  io::writePoleMap(options.output, map);
  return summary;
}

std::string summaryText(const MapImportSummary& summary, const MapImportOptions& options) {
  std::ostringstream out;
  out << options.output.string() << ": " << summary.poles << " poles, datum "
      << io::datumText(summary.datum) << '\n';
  if (summary.others > 0)
    out << "entries that are no points or not kept: " << summary.others << '\n';
  if (!summary.found.empty()) out << "found: " << summary.found << '\n';
  if (summary.doubles > 0)
    out << "entries nearer than " << io::significant(options.merge, 6)
        << " m to an earlier one, left out: " << summary.doubles << '\n';
  return out.str();
}

}  // namespace polemcl::apps
