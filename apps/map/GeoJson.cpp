#include "map/GeoJson.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/Projections.h"
#include "io/file/AtomicFile.h"
#include "io/file/Date.h"
#include "io/file/ErrorPlace.h"
#include "io/file/ParsedJson.h"
#include "map/Inventory.h"

namespace polemcl::apps {
namespace {

using Json = nlohmann::ordered_json;

/// A number with this many decimals. (nlohmann prints 17 digits of 0.1 + 0.2.)
double rounded(double value, double steps) {
  return std::round(value * steps) / steps;
}

Json properties(const io::PoleMapData& map, std::size_t i) {
  const MapPole& p = map.poles[i];
  Json json{{"radius", p.radius},
            {"bottom", p.bottom},
            {"top", p.top},
            {"confidence", p.confidence},
            {"count", p.count}};
  json["covariance"] = {p.covariance(0, 0), p.covariance(0, 1), p.covariance(1, 1)};
  if (map.histories.empty()) return json;
  const PoleHistory& h = map.histories[i];
  json["existence"] = h.existence;
  json["seen"] = h.seen;
  json["missed"] = h.missed;
  if (h.firstSeen > 0) json["first_seen"] = io::dateText(h.firstSeen);
  if (h.lastSeen > 0) json["last_seen"] = io::dateText(h.lastSeen);
  if (h.firstSeen > 0) json["first_seen_s"] = h.firstSeen;
  if (h.lastSeen > 0) json["last_seen_s"] = h.lastSeen;
  return json;
}

/// Reads one feature; all messages name it.
class Feature {
 public:
  Feature(const Json& json, std::string where) : m_json(json), m_where(std::move(where)) {}

  const std::string& where() const { return m_where; }
  bool isPoint() const {
    if (!m_json.is_object() || !m_json.contains("geometry")) fail("no feature with a geometry");
    const Json& geometry = m_json["geometry"];
    return geometry.is_object() && (geometry.value("type", Json()) == "Point" || isOneOfMany());
  }
  Eigen::Vector2d coordinates() const {
    const Json& all = m_json["geometry"].value("coordinates", Json());
    const Json& at = isOneOfMany() ? all[0] : all;
    if (!at.is_array() || at.size() < 2 || !at[0].is_number() || !at[1].is_number())
      fail("a point needs coordinates [longitude, latitude]");
    return {at[0].get<double>(), at[1].get<double>()};
  }
  std::map<std::string, std::string> properties() const {
    std::map<std::string, std::string> texts;
    const auto found = m_json.find("properties");
    if (found == m_json.end() || !found->is_object()) return texts;
    for (const auto& [name, value] : found->items())
      texts[name] = value.is_string() ? value.get<std::string>() : value.dump();
    return texts;
  }
  Eigen::Vector2d lonLat() const {
    Eigen::Vector2d found = coordinates();
    if (!(std::abs(found.x()) <= 360 && std::abs(found.y()) <= 90))
      fail("longitude or latitude is out of range; GeoJSON has degrees, longitude first");
    return found;
  }
  Eigen::Vector2d place(const MapPlane& plane) const {
    const Eigen::Vector2d found = lonLat();
    return io::located(m_where, [&] { return plane.place(found); });
  }
  bool has(const char* name) const {
    const auto found = m_json.find("properties");
    return found != m_json.end() && found->is_object() && found->contains(name) &&
           !(*found)[name].is_null();
  }
  void take(const char* name, double& value) const {
    if (!has(name)) return;
    const Json& json = m_json["properties"][name];
    if (!json.is_number()) fail(std::string(name) + " is no number");
    value = json.get<double>();
  }
  void take(const char* name, std::uint32_t& value) const {
    if (!has(name)) return;
    const Json& json = m_json["properties"][name];
    if (!json.is_number_unsigned() || json.get<std::uint64_t>() > 0xffffffffu)
      fail(std::string(name) + " is no whole number from 0 to 4294967295");
    value = json.get<std::uint32_t>();
  }
  /// Seconds where they are told, else the day.
  void takeTime(const std::string& name, double& time) const {
    if (has((name + "_s").c_str())) return take((name + "_s").c_str(), time);
    if (!has(name.c_str())) return;
    const Json& json = m_json["properties"][name];
    if (!json.is_string()) fail(name + " is no day, YYYY-MM-DD");
    time = io::located(m_where, [&] { return io::secondsOfDate(json.get<std::string>()); });
  }
  void takeCovariance(Eigen::Matrix2d& covariance) const {
    if (!has("covariance")) return;
    const Json& json = m_json["properties"]["covariance"];
    if (!json.is_array() || json.size() != 3) fail("covariance needs three numbers, xx, xy, yy");
    for (const Json& value : json)
      if (!value.is_number()) fail("covariance needs three numbers, xx, xy, yy");
    covariance << json[0].get<double>(), json[1].get<double>(), json[1].get<double>(),
        json[2].get<double>();
  }

 private:
  /// A MultiPoint of one point, as some programs write all points.
  bool isOneOfMany() const {
    const Json& geometry = m_json["geometry"];
    const Json& points = geometry.value("coordinates", Json());
    return geometry.value("type", Json()) == "MultiPoint" && points.is_array() &&
           points.size() == 1;
  }
  [[noreturn]] void fail(const std::string& what) const { throw Error(m_where + what); }
  const Json& m_json;
  std::string m_where;
};

MapPole poleOf(const Feature& feature, const MapPlane& plane) {
  MapPole pole;
  pole.radius = 0.1;
  pole.count = 1;
  const Eigen::Vector2d place = feature.place(plane);
  pole.x = place.x();
  pole.y = place.y();
  feature.take("radius", pole.radius);
  feature.take("bottom", pole.bottom);
  feature.take("top", pole.top);
  feature.take("confidence", pole.confidence);
  feature.take("count", pole.count);
  feature.takeCovariance(pole.covariance);
  return pole;
}

/// A pole without one, drawn by hand, has that of a pole of a map without histories.
PoleHistory historyOf(const Feature& feature, const MapPole& pole) {
  if (!feature.has("existence")) return landmarksFrom({pole}).poles.front().history;
  PoleHistory history;
  feature.take("existence", history.existence);
  feature.take("seen", history.seen);
  feature.take("missed", history.missed);
  feature.takeTime("first_seen", history.firstSeen);
  feature.takeTime("last_seen", history.lastSeen);
  return history;
}

Json parsed(const std::filesystem::path& file) {
  Json json;
  try {
    json = io::parsedJson<Json>(file);
  } catch (const Json::exception& error) {
    throw Error(file.string() + ": is no JSON: " + error.what());
  }
  if (!json.is_object() || json.value("type", Json()) != "FeatureCollection" ||
      !json.contains("features") || !json["features"].is_array())
    throw Error(file.string() + ": is no GeoJSON FeatureCollection");
  return json;
}

/// Calls take(feature) for each point. \return The number of other features.
template <class Take>
std::size_t forEachPoint(const Json& json, const std::filesystem::path& file, const Take& take) {
  std::size_t number = 0, others = 0;
  for (const Json& entry : json["features"]) {
    const Feature feature(entry, file.string() + ": feature " + std::to_string(number++) + ": ");
    if (feature.isPoint())
      take(feature);
    else
      ++others;
  }
  return others;
}

std::map<std::string, std::string> infoOf(const Json& json, const std::string& where) {
  std::map<std::string, std::string> info;
  const auto own = json.find("polemcl");
  if (own == json.end()) return info;
  if (!own->is_object()) throw Error(where + "polemcl must hold the map's info, texts by name");
  for (const auto& [key, value] : own->items()) {
    if (!value.is_string()) throw Error(where + "polemcl must hold the map's info, texts by name");
    info[key] = value.get<std::string>();
  }
  return info;
}

}  // namespace

void writeGeoJson(const std::filesystem::path& file, const io::PoleMapData& map) {
  const auto datum = io::datumOf(map.info, file.string() + ": ");
  if (!datum)
    throw Error("cannot write " + file.string() +
                ": the map has no datum; say where on Earth it lies with --datum");
  const MapPlane plane(*datum);
  Json json{{"type", "FeatureCollection"}};
  for (const auto& [key, value] : map.info) json["polemcl"][key] = value;
  json["features"] = Json::array();
  for (std::size_t i = 0; i < map.poles.size(); ++i) {
    const Eigen::Vector2d at = plane.lonLat({map.poles[i].x, map.poles[i].y});
    Json feature{{"type", "Feature"}, {"id", i}};
    feature["geometry"] = {{"type", "Point"},
                           {"coordinates", {rounded(at.x(), 1e10), rounded(at.y(), 1e10)}}};
    feature["properties"] = properties(map, i);
    json["features"].push_back(std::move(feature));
  }
  io::AtomicFile output(file);
  // One line a pole, so that maps can be compared as text.
  const Json features = std::move(json["features"]);
  json.erase("features");
  const std::string head = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  output.stream() << head.substr(0, head.size() - 1) << ",\"features\":[";
  for (std::size_t i = 0; i < features.size(); ++i)
    output.stream() << (i == 0 ? "\n" : ",\n") << features[i].dump();
  output.stream() << "\n]}\n";
  output.commit();
}

std::string othersText(std::size_t others) {
  return others == 0
             ? ""
             : "; features that are no points: " + std::to_string(others) + "; make points of them";
}

std::vector<InventoryEntry> readGeoJsonInventory(const std::filesystem::path& file,
                                                 std::size_t& left) {
  std::vector<InventoryEntry> points;
  left = forEachPoint(parsed(file), file, [&](const Feature& feature) {
    points.push_back({feature.coordinates(), feature.properties(), feature.where()});
  });
  return points;
}

io::PoleMapData readGeoJson(const std::filesystem::path& file,
                            const std::optional<io::Datum>& datum, std::size_t* left) {
  const std::string where = file.string() + ": ";
  const Json json = parsed(file);
  io::PoleMapData map;
  map.info = infoOf(json, where);
  if (datum) io::setDatum(map.info, *datum, where);
  const auto origin = io::datumOf(map.info, where);
  if (!origin) throw Error(where + "no datum in it; say where the map's origin is with --datum");
  const MapPlane plane(*origin);
  bool hasHistories = false;
  const std::size_t others = forEachPoint(json, file, [&](const Feature& feature) {
    map.poles.push_back(poleOf(feature, plane));
    map.histories.push_back(historyOf(feature, map.poles.back()));
    hasHistories |= feature.has("existence");
  });
  if (map.poles.empty()) throw Error(where + "no point in it" + othersText(others));
  if (!hasHistories) map.histories.clear();
  if (left) *left = others;
  return map;
}

}  // namespace polemcl::apps
