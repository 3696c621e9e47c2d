#include "core/mapping/MapSession.h"
#include "fuzz/Fuzz.h"
#include "io/file/Npz.h"
#include "io/map/PoleMapFile.h"
#include "io/map/PoleTables.h"
#include "map/GeoJson.h"
#include "map/Inventory.h"
#include "map/MapFiles.h"
#include "support/NumpyFiles.h"

namespace polemcl::fuzz {
namespace {

void readPolemap(std::string_view bytes) {
  const auto file = fileOf("a.polemap", bytes);
  std::optional<AddedSessions> scans;
  io::readPoleMap(file, &scans);
}

void readNpz(std::string_view bytes) {
  const auto file = fileOf("a.npz", bytes);
  static const Readers readers{[](auto) {
                                 const io::NpzFile npz(folder() / "a.npz");
                                 for (const std::string& name : npz.names()) npz.array(name);
                               },
                               [](auto) { io::readPoleNpz(folder() / "a.npz"); },
                               [](auto) { io::readPolePositions(folder() / "a.npz"); }};
  readWithOne(readers, bytes.substr(bytes.empty() ? 0 : bytes.size() - 1));
}

std::vector<std::string> npzSeeds() {
  using namespace io::test;
  const auto array = [](const std::string& shape, std::size_t numbers) {
    return npy(dictionary("<f8", "False", shape), std::string(8 * numbers, '\x3f'));
  };
  std::vector<std::string> seeds;
  for (const char last : {'\0', '\1', '\2'})  // chooses the reader, and may be behind the archive
    seeds.push_back(zip({{"polemeans.npy", array("(2, 3)", 6)}, {"scale.npy", array("()", 1)}},
                        std::string(1, last)));
  return seeds;
}

void readGeoJson(std::string_view bytes) {
  const auto file = fileOf("a.geojson", bytes);
  std::size_t left = 0;
  apps::readGeoJsonInventory(file, left);
  apps::readGeoJson(file, io::Datum{50.5, 7.25, 0});
}

std::vector<std::string> geoJsonSeeds() {
  return {made("street.geojson"),
          R"({"type":"FeatureCollection","polemcl":{"datum":"50.5 7.25 0"},"features":[
{"type":"Feature","geometry":{"type":"Point","coordinates":[7.2501,50.5001]},"properties":
{"radius":0.1,"top":4,"count":3,"covariance":[0.01,0,0.02],"existence":0.9,"first_seen":"2012-01-08"}},
{"type":"Feature","geometry":{"type":"LineString","coordinates":[[7,50],[8,51]]},"properties":null}]})"};
}

void readOsm(std::string_view bytes) {
  apps::readOsmInventory(fileOf("a.osm", bytes));
}

std::vector<std::string> osmSeeds() {
  return {
      R"(<?xml version="1.0"?><osm version="0.6"><node id="1" lat="50.5" lon="7.25"><tag k="highway" v="street_lamp"/></node>
<node id="2" lat="50.6" lon="7.25"/><node id="3" lat="50.6" lon="7.26"/><way id="9"><nd ref="2"/><nd ref="3"/><tag k="type" v="pole"/></way></osm>)",
      "<!DOCTYPE osm [<!ENTITY a \"b\">]><osm><node id='1' lat='1' lon='2'><tag k='natural' "
      "v='tree'/><tag k='name' v='&a;&#x20;'/></node></osm>"};
}

}  // namespace

std::vector<Target> mapTargets() {
  const auto polemaps = [] {
    return std::vector<std::string>{made("street.polemap"), made("session.polemap")};
  };
  return {{"polemap", readPolemap, polemaps},
          {"npz", readNpz, npzSeeds},
          {"geojson", readGeoJson, geoJsonSeeds},
          {"osm", readOsm, osmSeeds}};
}

}  // namespace polemcl::fuzz
