#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "map/GeoJson.h"
#include "support/ExpectHas.h"
#include "support/Poles.h"
#include "support/Refusal.h"
#include "support/Samples.h"

namespace polemcl::test_geo_json {
namespace {

using namespace polemcl::apps;

io::PoleMapData sample() {
  io::PoleMapData map;
  std::mt19937 random(4);
  for (int i = 0; i < 50; ++i) {
    MapPole pole;
    pole.x = static_cast<double>(random()) / 1e6 - 2000;
    pole.y = static_cast<double>(random()) / 1e6 - 2000;
    pole.radius = 0.05 + static_cast<double>(random() % 100) / 700;
    pole.bottom = 0.25;
    pole.top = 2 + static_cast<double>(random() % 100) / 30;
    pole.confidence = static_cast<double>(random() % 100) / 99;
    pole.covariance << 0.04, 0.01, 0.01, 0.09;
    pole.count = static_cast<std::uint32_t>(random());
    map.poles.push_back(pole);
    map.histories.push_back({static_cast<std::uint32_t>(random() % 99), 7,
                             static_cast<double>(random() % 100) / 99, i == 3 ? 0 : 1326652795.25,
                             1.4e9 + 1.0 / 3});
  }
  map.info = {{"program", "pole-map 1"}, {"datum", "42.293227,-83.709657,30"}, {"odd \"", "\n ü"}};
  return map;
}

class GeoJson : public testing::Test {
 protected:
  std::string write(const std::string& text) const {
    const std::string file = folder / "m.geojson";
    std::ofstream(file) << text;
    return file;
  }
  std::string refusal(const std::string& text,
                      const std::optional<io::Datum>& datum = std::nullopt) const {
    const std::string file = write(text);
    const std::string message = tests::messageOf([&] { readGeoJson(file, datum); });
    EXPECT_EQ(message.rfind(file, 0), 0u) << message;
    return message;
  }
  testing_apps::TempFolder folder;
};

std::string multiPoint(const std::string& places) {
  return R"({"type":"Feature","geometry":{"type":"MultiPoint","coordinates":[)" + places + "]}}";
}

std::string points(const std::string& features) {
  return R"({"type":"FeatureCollection","features":[)" + features + "]}";
}
std::string point(const std::string& coordinates, const std::string& properties = "null") {
  return R"({"type":"Feature","geometry":{"type":"Point","coordinates":[)" + coordinates +
         R"(]},"properties":)" + properties + "}";
}

const io::Datum home{50, 8, 0};

TEST_F(GeoJson, MapsComeBackBelowAMillimetre) {
  const io::PoleMapData before = sample();
  const std::string file = folder / "m.geojson";
  writeGeoJson(file, before);
  const io::PoleMapData after = readGeoJson(file);
  EXPECT_EQ(after.info, before.info);
  ASSERT_EQ(after.poles.size(), before.poles.size());
  ASSERT_EQ(after.histories.size(), before.histories.size());
  for (std::size_t i = 0; i < after.poles.size(); ++i) {
    const MapPole& b = before.poles[i];
    MapPole a = after.poles[i];
    EXPECT_LT(std::hypot(a.x - b.x, a.y - b.y), 2e-5);
    a.x = b.x;
    a.y = b.y;
    tests::expectSame(a, b);
    EXPECT_EQ(after.histories[i].seen, before.histories[i].seen);
    EXPECT_EQ(after.histories[i].missed, before.histories[i].missed);
    EXPECT_EQ(after.histories[i].existence, before.histories[i].existence);
    EXPECT_EQ(after.histories[i].firstSeen, before.histories[i].firstSeen);
    EXPECT_EQ(after.histories[i].lastSeen, before.histories[i].lastSeen);
  }
}

TEST_F(GeoJson, IsWhatRfc7946Asks) {
  writeGeoJson(folder / "m.geojson", sample());
  std::ifstream stream(folder / "m.geojson");
  const auto json = nlohmann::json::parse(stream);
  EXPECT_EQ(json["type"], "FeatureCollection");
  EXPECT_FALSE(json.contains("crs"));  // it is WGS 84, and nothing else may be said
  ASSERT_EQ(json["features"].size(), 50u);
  const auto& feature = json["features"][7];
  EXPECT_EQ(feature["type"], "Feature");
  EXPECT_EQ(feature["geometry"]["type"], "Point");
  ASSERT_EQ(feature["geometry"]["coordinates"].size(), 2u);
  EXPECT_NEAR(feature["geometry"]["coordinates"][0].get<double>(), -83.7, 0.1);  // longitude first
  EXPECT_EQ(feature["properties"]["first_seen"], "2012-01-15");
  EXPECT_FALSE(json["features"][3]["properties"].contains("first_seen"));
  EXPECT_EQ(json["polemcl"]["datum"], "42.293227,-83.709657,30");
}

TEST_F(GeoJson, ReadsPointsOfOthers) {
  const std::string file = write(
      points(point("8.001, 50.001, 120") + "," +
             R"({"type":"Feature","geometry":{"type":"LineString","coordinates":[[1,2],[3,4]]}})" +
             "," + R"({"type":"Feature","geometry":null,"properties":{}},)" +
             multiPoint("[8, 50.002], [8, 50.003]") + "," + multiPoint("[8, 50.002]") + "," +
             point("8, 50", R"({"radius":0.25,"top":5,"name":"lamp","first_seen":"2020-02-03"})")));
  std::size_t left = 0;
  const auto map = readGeoJson(file, home, &left);
  EXPECT_EQ(left, 3u);
  ASSERT_EQ(map.poles.size(), 3u);
  EXPECT_NEAR(map.poles[0].x, 71.7, 0.1);
  EXPECT_NEAR(map.poles[0].y, 111.2, 0.1);
  EXPECT_EQ(map.poles[0].radius, 0.1);
  EXPECT_EQ(map.poles[0].count, 1u);
  EXPECT_NEAR(map.poles[1].y, 222.5, 0.1) << "many points that are one";
  EXPECT_NEAR(map.poles[2].x, 0, 1e-6);
  EXPECT_EQ(map.poles[2].radius, 0.25);
  EXPECT_EQ(map.poles[2].top, 5);
  EXPECT_TRUE(map.histories.empty());
  EXPECT_EQ(map.info.at("datum"), "50,8,0");
}

TEST_F(GeoJson, APoleAddedByHandKeepsTheOtherHistories) {
  const std::string file =
      write(points(point("8, 50", R"({"existence":0.95,"seen":7,"missed":2})") + "," +
                   point("8.001, 50", R"({"count":3,"existence":null})")));
  const auto map = readGeoJson(file, home);
  ASSERT_EQ(map.histories.size(), 2u);
  EXPECT_EQ(map.histories[0].existence, 0.95);
  EXPECT_EQ(map.histories[0].missed, 2u);
  EXPECT_EQ(map.histories[1].existence,
            landmarksFrom({map.poles[1]}).poles.front().history.existence);
  EXPECT_EQ(map.histories[1].seen, 3u);
}

TEST_F(GeoJson, RefusesWhatItCannotPlace) {
  EXPECT_HAS(refusal(points(point("8, 50"))), "--datum");
  writeGeoJson(folder / "m.geojson", sample());
  EXPECT_THROW(readGeoJson(folder / "m.geojson", home), Error);  // it has another one
  EXPECT_HAS(refusal(points(point("50, 8")), home), "but near it with the two swapped");
  EXPECT_HAS(refusal(points(point("50, 9.5")), home), "km from the datum");
  EXPECT_HAS(refusal(points(point("8, 91")), home), "feature 0: longitude or latitude");
  auto map = sample();
  map.info.erase("datum");
  EXPECT_THROW(writeGeoJson(folder / "n.geojson", map), Error);
  EXPECT_FALSE(std::ifstream(folder / "n.geojson").good());
}

TEST_F(GeoJson, RefusesWhatIsNone) {
  EXPECT_HAS(refusal(""), "is no JSON");
  EXPECT_HAS(refusal(std::string(100000, '[') + std::string(100000, ']')), "nested more than 64");
  std::string keys = "{\"a\":{\"b\":1},\"c\":[";
  for (int i = 0; i < 10001; ++i) keys += (i == 0 ? "{" : ",") + ('"' + std::to_string(i)) + "\":0";
  EXPECT_HAS(refusal(keys + "}]}"), "one of its objects has more than 10000 keys");
  EXPECT_HAS(refusal("[1]"), "FeatureCollection");
  EXPECT_HAS(refusal(R"({"type":"FeatureCollection"})"), "FeatureCollection");
  EXPECT_HAS(refusal(points(""), home), "no point in it");
  EXPECT_HAS(refusal(points(multiPoint("[8, 50], [8, 51]")), home),
             "no point in it; features that are no points: 1; make points of them");
  EXPECT_HAS(refusal(points(multiPoint("8")), home), "[longitude, latitude]");
  EXPECT_HAS(refusal(points("3"), home), "feature 0");
  EXPECT_HAS(refusal(points(point("8")), home), "[longitude, latitude]");
  EXPECT_HAS(refusal(points(point("8,\"50\"")), home), "[longitude, latitude]");
  EXPECT_HAS(refusal(points(point("8,50", R"({"radius":"x"})")), home), "radius is no number");
  EXPECT_HAS(refusal(points(point("8,50", R"({"count":-1})")), home), "count is no whole number");
  EXPECT_HAS(refusal(points(point("8,50", R"({"covariance":[1,2]})")), home), "three numbers");
  EXPECT_HAS(refusal(points(point("8,50", R"({"existence":1,"last_seen":5})")), home), "no day");
  EXPECT_HAS(refusal(R"({"type":"FeatureCollection","polemcl":{"a":1},"features":[]})", home),
             "texts by name");
}

}  // namespace
}  // namespace polemcl::test_geo_json
