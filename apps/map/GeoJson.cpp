#include "map/GeoJson.h"

#include <mrpt/topography/conversions.h>

#include <Eigen/Geometry>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/file/AtomicFile.h"
#include "io/file/Date.h"
#include "io/file/ErrorPlace.h"
#include "io/file/ParsedJson.h"
#include "io/file/TextFile.h"

namespace polemcl {
namespace {

using Json = nlohmann::ordered_json;
using mrpt::topography::TGeodeticCoords;

constexpr double farthest = 1e5;      ///< m: a map is no continent
constexpr double closeEnough = 1e-7;  ///< m
constexpr int mostSteps = 20;

TGeodeticCoords originOf(const io::Datum& datum) {
  return {datum.latitude, datum.longitude, 0};
}

Eigen::Vector3d eastNorthUp(const TGeodeticCoords& place, const io::Datum& datum) {
  mrpt::math::TPoint3D point;
  mrpt::topography::geodeticToENU_WGS84(place, point, originOf(datum));
  return {point.x, point.y, point.z};
}

Eigen::Rotation2Dd turnOf(const io::Datum& datum) {
  return Eigen::Rotation2Dd(datum.yawDeg * M_PI / 180);
}

void requireNear(double distance, const io::Datum& datum) {
  if (!(distance < farthest))
    throw Error("a pole " + io::fixed(distance / 1000, 0) + " km from the datum " +
                io::datumText(datum) + " is not on the same map");
}

Eigen::Vector2d lengthsOfDegrees(const io::Datum& datum) {
  constexpr double metres = 111320;  // of a degree, roughly: only the way to the answer
  return {metres * std::max(0.01, std::cos(datum.latitude * M_PI / 180)), metres};
}

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

  bool isPoint() const {
    if (!m_json.is_object() || !m_json.contains("geometry")) fail("no feature with a geometry");
    const Json& geometry = m_json["geometry"];
    return geometry.is_object() && geometry.value("type", Json()) == "Point";
  }
  Eigen::Vector2d coordinates() const {
    const Json& at = m_json["geometry"].value("coordinates", Json());
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
    const Eigen::Vector2d found = coordinates();
    if (!(std::abs(found.x()) <= 360 && std::abs(found.y()) <= 90))
      fail("longitude or latitude is out of range; GeoJSON has degrees, longitude first");
    return found;
  }
  Eigen::Vector2d place(const io::Datum& datum) const {
    const Eigen::Vector2d found = lonLat();
    return io::located(m_where, [&] { return onMap(found, datum); });
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
  [[noreturn]] void fail(const std::string& what) const { throw Error(m_where + what); }
  const Json& m_json;
  std::string m_where;
};

MapPole poleOf(const Feature& feature, const io::Datum& datum) {
  MapPole pole;
  pole.radius = 0.1;
  pole.count = 1;
  const Eigen::Vector2d place = feature.place(datum);
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

PoleHistory historyOf(const Feature& feature) {
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

/// Far away as it stands, near the other way round.
void requireNotSwapped(const Eigen::Vector2d& lonLat, double distance, const io::Datum& datum) {
  const TGeodeticCoords swapped(lonLat.x(), lonLat.y(), 0);
  if (distance > farthest && eastNorthUp(swapped, datum).norm() <= farthest)
    throw Error("longitude " + io::significant(lonLat.x(), 9) + ", latitude " +
                io::significant(lonLat.y(), 9) + " is far from the datum " + io::datumText(datum) +
                ", but near it with the two swapped: longitude comes first");
}

}  // namespace

Eigen::Vector2d geographic(const Eigen::Vector2d& place, const io::Datum& datum) {
  requireNear(place.norm(), datum);
  const Eigen::Vector2d wanted = turnOf(datum) * place;
  const Eigen::Vector2d metresPerDegree = lengthsOfDegrees(datum);
  TGeodeticCoords at = originOf(datum);
  // MRPT's way from ENU to degrees is an approximation; the other way is exact, so it is inverted.
  for (int i = 0; i < mostSteps; ++i) {
    const Eigen::Vector3d found = eastNorthUp(at, datum);
    const Eigen::Vector2d off = wanted - found.head<2>();
    if (off.norm() < closeEnough && std::abs(found.z()) < closeEnough)
      return {at.lon.decimal_value, at.lat.decimal_value};
    at.lon.decimal_value += off.x() / metresPerDegree.x();
    at.lat.decimal_value += off.y() / metresPerDegree.y();
    at.height -= found.z();
  }
  throw Error("datum " + io::datumText(datum) + ": too near to a pole of the Earth");
}

Eigen::Vector2d onMap(const Eigen::Vector2d& lonLat, const io::Datum& datum) {
  TGeodeticCoords at(lonLat.y(), lonLat.x(), 0);
  Eigen::Vector3d found = eastNorthUp(at, datum);
  requireNotSwapped(lonLat, found.norm(), datum);
  requireNear(found.norm(), datum);
  for (int i = 0; i < mostSteps && std::abs(found.z()) >= closeEnough; ++i) {
    at.height -= found.z();  // up to the map's plane
    found = eastNorthUp(at, datum);
  }
  return turnOf(datum).inverse() * Eigen::Vector2d(found.head<2>());
}

void writeGeoJson(const std::filesystem::path& file, const io::PoleMapData& map) {
  const auto datum = io::datumOf(map.info, file.string() + ": ");
  if (!datum)
    throw Error("cannot write " + file.string() +
                ": the map has no datum; say where on Earth it lies with --datum");
  Json json{{"type", "FeatureCollection"}};
  for (const auto& [key, value] : map.info) json["polemcl"][key] = value;
  json["features"] = Json::array();
  for (std::size_t i = 0; i < map.poles.size(); ++i) {
    const Eigen::Vector2d at = geographic({map.poles[i].x, map.poles[i].y}, *datum);
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

std::vector<GeoJsonPoint> readGeoJsonPoints(const std::filesystem::path& file, std::size_t& left) {
  const Json json = parsed(file);
  std::vector<GeoJsonPoint> points;
  std::size_t number = 0;
  left = 0;
  for (const Json& entry : json["features"]) {
    const std::string where = file.string() + ": feature " + std::to_string(number++) + ": ";
    const Feature feature(entry, where);
    if (feature.isPoint())
      points.push_back({feature.coordinates(), feature.properties(), where});
    else
      ++left;
  }
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
  std::size_t others = 0, number = 0;
  for (const Json& entry : json["features"]) {
    const Feature feature(entry, where + "feature " + std::to_string(number++) + ": ");
    if (!feature.isPoint()) {
      ++others;
      continue;
    }
    map.poles.push_back(poleOf(feature, *origin));
    if (feature.has("existence")) map.histories.push_back(historyOf(feature));
  }
  if (map.poles.empty()) throw Error(where + "no point in it");
  if (map.histories.size() != map.poles.size()) map.histories.clear();
  if (left) *left = others;
  return map;
}

}  // namespace polemcl
