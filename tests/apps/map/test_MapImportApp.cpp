#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "io/map/PoleMapFile.h"
#include "map/MapApp.h"
#include "support/TempFolder.h"

namespace polemcl::test_map_import_app {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

class MapImportApp : public testing::Test {
 protected:
  Outcome import(const std::string& name, const std::string& text,
                 const std::vector<std::string>& more = {}) {
    std::ofstream(folder / name) << text;
    return runProgram(mapMain,
                      {"import", "--input", (folder / name).string(), "--output",
                       (folder / "m.polemap").string()},
                      more);
  }
  /// Error of a run that must fail and write nothing.
  std::string failure(const std::string& name, const std::string& text,
                      const std::vector<std::string>& more = {}) {
    const Outcome outcome = import(name, text, more);
    EXPECT_EQ(outcome.code, 1) << outcome.out;
    EXPECT_FALSE(std::filesystem::exists(folder / "m.polemap"));
    return outcome.err;
  }
  io::PoleMapData map() const { return io::readPoleMap(folder / "m.polemap"); }
  TempFolder folder;
};

/// An upper-case letter of Latin-1 in UTF-8, as Norwegian columns have it.
const std::string kUtm =
    "Punkt;UTM33-Nord;UTM33-\xc3\x98st;Umfang cm\n"
    "1;7023875.719;224681.943;62.8\n2;7023852.719;224712.845;\n3;7023852.8;224712.9;10\n";
const std::vector<std::string> kUtmOptions{
    "--separator", ";", "--columns", "UTM33-\xc3\x98st,UTM33-Nord", "--crs", "EPSG:25833"};

const char* const kOsm = R"(<?xml version="1.0"?>
<osm version="0.6">
 <node id="1" lat="52.0" lon="13.0"><tag k="highway" v="street_lamp"/></node>
 <node id="2" lat="52.0001" lon="13.0"/>
 <node id="3" lat="52.0001" lon="13.0001"/>
 <node id="4" lat="52.0002" lon="13.0002"><tag k="natural" v="tree"/></node>
 <node id="5" lat="52.0003" lon="13.0"><tag k="highway" v="bus_stop"/></node>
 <node id="6" lat="52.0004" lon="13.0"><tag k="traffic_sign" v="DE:274"/></node>
 <way id="9"><nd ref="2"/><nd ref="3"/><nd ref="77"/><tag k="type" v="traffic_light"/></way>
 <way id="10"><nd ref="2"/><nd ref="3"/><tag k="type" v="line_thin"/></way>
</osm>
)";

TEST_F(MapImportApp, TablesInUtmKeepDistancesAndRadii) {
  std::vector<std::string> options = kUtmOptions;
  options.insert(options.end(), {"--radius-property", "Umfang cm", "--radius-unit", "0.00159155",
                                 "--sigma-m", "0.3"});
  const Outcome outcome = succeeded(import("a.csv", kUtm, options));
  EXPECT_HAS(outcome.out, "2 poles");
  EXPECT_HAS(outcome.out, "left out: 1");
  const auto data = map();
  ASSERT_EQ(data.poles.size(), 2u);
  // UTM is 0.9996 times the ground in its middle and more to the sides: here 1.0005 times.
  const double there = std::hypot(7023875.719 - 7023852.719, 224681.943 - 224712.845);
  const double here =
      std::hypot(data.poles[0].x - data.poles[1].x, data.poles[0].y - data.poles[1].y);
  EXPECT_NEAR(there / here, 1.0005, 0.0003);
  EXPECT_NEAR(data.poles[0].x + data.poles[1].x, 0, 0.2);
  EXPECT_NEAR(data.poles[0].radius, 0.1, 1e-4);
  EXPECT_EQ(data.poles[1].radius, 0) << "not known";
  EXPECT_NEAR(data.poles[0].covariance(0, 0), 0.09, 1e-12);
  EXPECT_EQ(data.poles[0].covariance(0, 1), 0);
  EXPECT_EQ(data.info.count("datum"), 1u);
}

TEST_F(MapImportApp, PointsOfGeoJsonWithOtherPeoplesProperties) {
  const std::string json =
      R"({"type":"FeatureCollection","features":[
      {"type":"Feature","geometry":{"type":"Point","coordinates":[13,52,34]},
       "properties":{"art":"Mast","radius":"unknown"}},
      {"type":"Feature","geometry":{"type":"LineString","coordinates":[[13,52],[13,53]]}},
      {"type":"Feature","geometry":{"type":"Point","coordinates":[13.0001,52]},
       "properties":{"art":"Bank"}}]})";
  const Outcome outcome =
      succeeded(import("a.geojson", json, {"--keep", "art=Mast", "--datum", "52,12.9999,90"}));
  EXPECT_HAS(outcome.out, "not kept: 2");
  const auto data = map();
  ASSERT_EQ(data.poles.size(), 1u);
  EXPECT_NEAR(data.poles[0].x, 0, 0.01) << "x points north";
  EXPECT_NEAR(data.poles[0].y, -6.867, 0.01);
}

TEST_F(MapImportApp, LampsTreesSignsAndLightsOfOpenStreetMap) {
  ASSERT_EQ(import("a.osm", kOsm, {"--datum", "52,13"}).code, 0);
  const auto data = map();
  ASSERT_EQ(data.poles.size(), 4u);
  EXPECT_NEAR(data.poles[0].x, 0, 1e-6);
  EXPECT_NEAR(data.poles[1].y, 22.253, 0.01) << "the tree";
  EXPECT_NEAR(data.poles[2].y, 44.507, 0.01) << "the sign";
  EXPECT_NEAR(data.poles[3].x, 3.434, 0.01) << "middle of the light's known nodes";
  const Outcome outcome = import("a.osm", kOsm, {"--keep", "kind=tree", "kind=light"});
  ASSERT_EQ(outcome.code, 0);
  EXPECT_HAS(outcome.out, "found: kind: lamp (1), light (1), sign (1), tree (1)");
  EXPECT_EQ(map().poles.size(), 2u);
}

TEST_F(MapImportApp, TagsBelongToTheirNodeOrWayAlone) {
  const Outcome outcome = import("a.osm", R"(<osm>
 <node id="1" lat="52" lon="13"><tag k="natural" v="tree"/><tag k="name" v="a"/></node>
 <relation id="3"><tag k="natural" v="tree"/></relation>
 <node id="2" lat="52.001" lon="13"/></osm>)");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(map().poles.size(), 1u);
}

TEST_F(MapImportApp, WhatWasDeletedIsLeftOut) {
  const char* const osm = R"(<osm version="0.6">
 <node id="1" lat="52.0" lon="13.0"><tag k="highway" v="street_lamp"/></node>
 <node id="2" action="delete" lat="52.0" lon="13.01"><tag k="highway" v="street_lamp"/></node>
 <node id="3" visible="false"><tag k="highway" v="street_lamp"/></node>
 <way id="9" action="delete"><nd ref="1"/><tag k="type" v="pole"/></way>
</osm>)";
  ASSERT_EQ(import("a.osm", osm, {"--datum", "52,13"}).code, 0);
  EXPECT_EQ(map().poles.size(), 1u);
}

TEST_F(MapImportApp, TheOriginLiesBetweenPolesOnBothSidesOf180Degrees) {
  ASSERT_EQ(import("a.csv", "lon,lat\n179.9999,-16.8\n-179.9997,-16.8\n").code, 0);
  ASSERT_EQ(map().poles.size(), 2u);
  EXPECT_NEAR(map().poles[0].x, -21.3, 0.1);
  EXPECT_NEAR(map().poles[1].x, 21.3, 0.1);
}

TEST_F(MapImportApp, OptionsThatTheInventoryHasNoUseForAreRefused) {
  EXPECT_HAS(failure("a.osm", kOsm, {"--crs", "EPSG:25833"}), "a.osm: places of OpenStreetMap");
  EXPECT_HAS(failure("a.osm", kOsm, {"--separator", ";"}), "are for CSV files");
  EXPECT_HAS(failure("a.csv", "lon,lat,girth\n13,52,3\n", {"--radius-property", "typo"}),
             "--radius-property: no entry has 'typo', but");
}

TEST_F(MapImportApp, BadInventoriesAreRefusedWithTheirPlace) {
  EXPECT_HAS(failure("a.txt", ""), "allowed: .csv, .geojson, .json, .osm, .xml");
  EXPECT_HAS(failure("a.csv", kUtm), "--columns EAST,NORTH");
  EXPECT_HAS(failure("a.csv", kUtm, {"--separator", ";", "--columns", "UTM33-Nord,Punkt"}),
             "a.csv:2: the place 7023875.72 1 is not in the coordinate system EPSG:4326; --crs");
  EXPECT_HAS(failure("a.csv", "lon,lat\n", {"--crs", "EPSG:1"}), "no pole in it");
  EXPECT_HAS(
      failure("a.osm", kOsm, {"--keep", "kind=lamps"}),
      "no pole in it that --keep keeps; there is kind: lamp (1), light (1), sign (1), tree (1)");
  EXPECT_HAS(failure("a.osm", kOsm, {"--keep", "art=lamp"}), "no entry has 'art', but ");
  EXPECT_HAS(failure("a.csv", "lon,lat\n13,120\n"), "are longitude and latitude swapped?");
  EXPECT_HAS(
      failure("a.csv", "lon,lat\n52,13\n", {"--datum", "52,13"}),
      "a.csv:2: longitude 52, latitude 13 is far from the datum 52,13,0, but near it with the");
  EXPECT_HAS(failure("a.csv", "lon,lat\n1,1\n", {"--crs", "EPSG:1"}), "unknown coordinate system");
  EXPECT_HAS(failure("a.csv", "lon,lat\n1,1\n3,3\n"), "km from the datum");
  EXPECT_HAS(failure("a.csv", "lon,lat,r\n1,1,thick\n", {"--radius-property", "r"}),
             "a.csv:2: r = 'thick' is no radius");
  EXPECT_HAS(failure("a.osm", "<osm><node id='1' lat='1' lon='1'>"), "is no OSM XML");
  EXPECT_HAS(failure("a.osm", "<gpx></gpx>"), "no element osm");
  EXPECT_HAS(failure("a.osm", "<osm>\n<node id='1' lat='91' lon='1'/></osm>"),
             "a.osm:2: a node needs id, lon and lat");
  EXPECT_HAS(failure("a.osm", "<osm><way><nd ref='1'/><tag k='type' v='pole'/></way></osm>"),
             "has no node of this file");
  EXPECT_HAS(failure("a.osm",
                     "<!DOCTYPE osm [<!ENTITY a 'aaaa'>\n<!ENTITY b '&a;&a;'>]>\n<osm>"
                     "<node id='1' lat='1' lon='1'><tag k='&b;' v=''/></node></osm>"),
             "a.osm:1: declares the entity a; in OSM XML there are none");
  EXPECT_HAS(
      failure("a.osm", "<osm>\n<node id='1' lat='1' lon='1'>\n<node id='2' lat='1' lon='1'/>"),
      "a.osm:3: a node inside a node");
  EXPECT_HAS(failure("a.osm", "<osm><way><nd ref='1'/><way/></way></osm>"), "a way inside a way");
  EXPECT_HAS(failure("a.csv", "lon,lat," + std::string(257, 'n') + "\n1,1,1\n"),
             "a.csv: the name of a column has 257 bytes; at most 256 are allowed");
  EXPECT_HAS(failure("a.json", "{}"), "is no GeoJSON FeatureCollection");
  EXPECT_HAS(failure("a.json", R"({"type":"FeatureCollection","features":[{"type":"Feature",
             "geometry":{"type":"MultiPoint","coordinates":[[8,50],[8,51]]}}]})"),
             "no pole in it; features that are no points: 1");
  EXPECT_EQ(import("a.csv", kUtm, {"--keep", "tree"}).code, 2);
  EXPECT_EQ(import("a.csv", kUtm, {"--columns", "a"}).code, 2);
}

}  // namespace
}  // namespace polemcl::test_map_import_app
