#include <cmath>

#include "core/mapping/MapAccumulator.h"
#include "io/map/PoleMapFile.h"
#include "io/map/PoleTables.h"
#include "map/MapApp.h"
#include "support/DiskCalls.h"
#include "support/TempFolder.h"

namespace polemcl::test_map_convert_app {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

class MapConvertApp : public testing::Test {
 protected:
  MapConvertApp() {
    io::PoleMapData map;
    for (int i = 0; i < 5; ++i) {
      MapPole pole;
      pole.x = 10.5 * i;
      pole.y = 3.25 - i;
      pole.radius = 0.125;
      pole.top = 4;
      pole.count = 7;
      map.poles.push_back(pole);
      map.histories.push_back({7, 1, 0.9375, 1326585600, 1331942400});
    }
    map.candidates.push_back({map.poles.front(), map.histories.front(), false});
    map.info = {{"program", "pole-map 1"}};
    scans.sessions.push_back({"one.rawlog", {SessionScan()}, {true}});
    io::writePoleMap(folder / "m.polemap", map, &scans);
  }
  Outcome convert(const std::string& from, const std::string& to,
                  const std::vector<std::string>& more = {}) {
    return runProgram(
        mapMain, {"convert", (folder / from).string(), "--output", (folder / to).string()}, more);
  }
  TempFolder folder;
  AddedSessions scans;
};

TEST_F(MapConvertApp, GoesThroughEveryKindOfFile) {
  const std::vector<std::string> datum{"--datum", "42.25,-83.5,12"};
  std::string from = "m.polemap";
  for (const std::string to :
       {"a.geojson", "b.csv", "c.polemap", "d.csv", "e.geojson", "f.polemap"}) {
    SCOPED_TRACE(to);
    const bool needsDatum = to == "a.geojson" || to == "e.geojson";
    const Outcome outcome =
        succeeded(convert(from, to, needsDatum ? datum : std::vector<std::string>()));
    EXPECT_NE(outcome.out.find(to + ": 5 poles"), std::string::npos) << outcome.out;
    from = to;
  }
  for (const char* name : {"c.polemap", "d.csv", "f.polemap"}) {
    const auto places = io::readPolePositions(folder / name);
    ASSERT_EQ(places.size(), 5u);
    for (int i = 0; i < 5; ++i)
      EXPECT_LT(std::hypot(places[i].x() - 10.5 * i, places[i].y() - 3.25 + i), 1e-4) << name;
  }
  const auto map = io::readPoleMap(folder / "c.polemap");  // through GeoJSON and CSV
  ASSERT_EQ(map.histories.size(), 5u);
  EXPECT_EQ(map.histories[2].existence, 0.9375);
  EXPECT_EQ(map.histories[2].lastSeen, 1331942400);
  EXPECT_EQ(map.poles[2].radius, 0.125);
  EXPECT_EQ(map.poles[2].count, 7u);
  EXPECT_EQ(map.info.at("converted_from"), "b.csv");
  EXPECT_EQ(io::readPoleMap(folder / "f.polemap").poles[2].radius, 0.125);
}

TEST_F(MapConvertApp, ReadsMapAndScansAtOnceAsAnotherMayReplaceThem) {
  const testing_disk::DiskCalls calls;
  ASSERT_EQ(convert("m.polemap", "n.polemap").code, 0);
  EXPECT_EQ(calls.of("open m.polemap").size(), 1u);
  std::optional<AddedSessions> kept;
  io::readPoleMap(folder / "n.polemap", &kept);
  EXPECT_TRUE(kept);
}

TEST_F(MapConvertApp, GivesAMapItsDatumAndKeepsTheRest) {
  const Outcome outcome = succeeded(convert("m.polemap", "m.polemap", {"--datum", "50,8"}));
  std::optional<AddedSessions> kept;
  const auto map = io::readPoleMap(folder / "m.polemap", &kept);
  EXPECT_EQ(map.info.at("datum"), "50,8,0");
  EXPECT_EQ(map.info.at("program"), "pole-map 1");
  EXPECT_EQ(map.info.count("converted_from"), 0u);
  EXPECT_EQ(map.candidates.size(), 1u);
  ASSERT_TRUE(kept);
  EXPECT_EQ(convert("m.polemap", "m.geojson").code, 0);  // it knows where it is now
  expectFailure(convert("m.polemap", "n.polemap", {"--datum", "50,9"}), {"m.polemap", "50,8,0"});
}

TEST_F(MapConvertApp, TellsWhatIsLeftOut) {
  const auto outcome = convert("m.polemap", "m.csv");
  EXPECT_HAS(outcome.out, "candidates, which are not on the map, left out: 1");
  EXPECT_EQ(convert("m.polemap", "m.csv", {"--quiet"}).out, "");
}

TEST_F(MapConvertApp, RefusesWhatItCannotConvert) {
  expectFailure(convert("m.polemap", "m.geojson"), {"m.geojson", "--datum"});
  expectFailure(convert("m.polemap", "m.kml"), {"m.kml", ".geojson"});
  expectFailure(convert("m.kml", "m.csv"), {"m.kml", ".geojson"});
  expectFailure(convert("none.npz", "m.csv"), {"none.npz"});
  expectFailure(convert("m.polemap", "m.npz"), {"m.npz", "write .csv", "polemcl.PoleMap.load("});
  writeText(folder / "empty.csv", "x,y\n");
  expectFailure(convert("empty.csv", "m.polemap"), {"empty.csv", "no pole"});
  writeText(folder / "bad.csv", "x,y,radius\n1,2,3\n1,2,-3\n");
  expectFailure(convert("bad.csv", "new.polemap"), {"new.polemap", "pole 1", "radius"});
  EXPECT_FALSE(fs::exists(folder / "new.polemap"));
  EXPECT_FALSE(fs::exists(folder / "m.geojson"));
}

TEST_F(MapConvertApp, WrongUsage) {
  expectUsageError(runProgram(mapMain, {"convert", "a.csv"}));
  expectUsageError(runProgram(mapMain, {"convert", "--output", "c.csv"}));
  expectUsageError(runProgram(mapMain, {"convert", "a.csv", "--output", "c", "--config", "b"}));
}

}  // namespace
}  // namespace polemcl::test_map_convert_app
