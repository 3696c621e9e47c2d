// pole-map with several sessions: the paper's protocol, and sessions added one by one.

#include "extract/ExtractApp.h"
#include "io/file/Bytes.h"
#include "io/map/PoleMapFile.h"
#include "map/MapApp.h"
#include "support/DiskCalls.h"
#include "support/StreetTest.h"

namespace polemcl::test_map_sessions {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

/// Three sessions on one street: along half of it, a bit farther, all of it and beyond.
class MapSessions : public StreetTest {
 protected:
  MapSessions() {
    for (const auto& [name, text] :
         {std::pair("all.ini", ""), std::pair("paper.ini", "unvisited_m = 10\n"),
          std::pair("near.ini", "unvisited_m = 4\n")})
      writeText(folder / name, std::string("[sensor]\nmodel = hdl32e\nheight_m = 1.0\n[map]\n"
                                           "section_length_m = 1.5\nmin_count = 2\n"
                                           "every_scan = false\nmin_share = 0\n") +
                                   text);
    drive("one", 12, 0);
    drive("two", 10, 8);    // 8 … 17 m
    drive("three", 20, 8);  // 8 … 27 m
  }
  /// Scans become poles at once: what is tested here does not depend on it, and is quicker so.
  void drive(const std::string& name, std::size_t scans, double startX) {
    writeStreet(folder / (name + "-scans"), scans, streetPoles(), 50, startX);
    import(name + "-scans");
    ExtractOptions extract;
    extract.input = folder / (name + "-scans.rawlog");
    extract.output = folder / (name + ".rawlog");
    extractPoles(extract, settings());
    fs::rename(folder / (name + "-scans.tum"), folder / (name + ".tum"));
  }
  Outcome map(const std::string& ini, const std::vector<std::string>& inputs,
              const std::string& output, const std::vector<std::string>& more = {},
              const std::string& command = "build") {
    std::vector<std::string> arguments{command,    "--config", at(ini),
                                       "--output", at(output), "--input"};
    for (const auto& name : inputs) arguments.push_back(at(name + ".rawlog"));
    arguments.push_back("--truth");
    for (const auto& name : inputs) arguments.push_back(at(name + ".tum"));
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(mapMain, arguments);
  }
  /// The bytes of a chunk of a map.
  std::string chunk(const std::string& name, const std::string& wanted) const {
    const std::string bytes = readText(folder / name);
    io::ByteReader payload(std::string_view(bytes).substr(24), name);
    while (payload.remaining() > 0) {
      const std::string tag(payload.getRaw(4));
      const auto size = payload.get<std::uint64_t>();
      const std::string content(payload.getRaw(size));
      if (tag == wanted) return content;
    }
    return "";
  }
};

TEST_F(MapSessions, ThePaperTakesLaterSessionsWhereNobodyHasBeen) {
  const Outcome outcome = succeeded(map("paper.ini", {"one", "two", "three"}, "m.polemap"));
  const auto info = io::readPoleMap(folder / "m.polemap").info;
  // One ends at 11 m: two has nothing beyond 21 m; two ends at 17 m: three is new beyond 27 m.
  EXPECT_EQ(info.at("f_map.one"), "1.000000");
  EXPECT_EQ(info.at("f_map.two"), "0.000000");
  EXPECT_EQ(info.at("f_map.three"), "0.000000");
  EXPECT_EQ(info.at("scans"), "12");
  EXPECT_HAS(outcome.out, "two.rawlog: 0 of 10 scans used, f_map 0.0000");
  ASSERT_EQ(map("paper.ini", {"one", "three"}, "m.polemap").code, 0);
  // 22 … 27 m of 20 scans, whose first is at 8 m.
  EXPECT_EQ(io::readPoleMap(folder / "m.polemap").info.at("f_map.three"), "0.300000");
  EXPECT_EQ(io::readPoleMap(folder / "m.polemap").info.at("scans"), "18");
}

TEST_F(MapSessions, EverythingIsUsedUnlessAsked) {
  const Outcome outcome = succeeded(map("all.ini", {"one", "three"}, "m.polemap"));
  EXPECT_EQ(io::readPoleMap(folder / "m.polemap").info.at("f_map.three"), "1.000000");
  EXPECT_EQ(chunk("m.polemap", "SCAN"), "");
}

TEST_F(MapSessions, AddedOneByOneTheyGiveTheMapOfAllAtOnce) {
  for (const std::string ini : {"all.ini", "near.ini", "paper.ini"}) {
    SCOPED_TRACE(ini);
    const std::vector<std::string> days{"--date", "2026-03-01", "2026-03-02", "2026-04-01"};
    ASSERT_EQ(map(ini, {"one", "three", "two"}, "all.polemap", days).code, 0);
    ASSERT_EQ(map(ini, {"one"}, "m.polemap", {"--keep-scans", "--date", days[1]}).code, 0);
    ASSERT_EQ(map(ini, {"three"}, "m.polemap", {"--add", at("m.polemap"), "--date", days[2]}).code,
              0);
    const Outcome last =
        succeeded(map(ini, {"two"}, "m.polemap", {"--add", at("m.polemap"), "--date", days[3]}));
    EXPECT_EQ(chunk("m.polemap", "POLE"), chunk("all.polemap", "POLE"));
    EXPECT_EQ(chunk("m.polemap", "INFO"), chunk("all.polemap", "INFO"));
    EXPECT_GT(chunk("m.polemap", "POLE").size(), 500u);
    ASSERT_EQ(map(ini, {"one", "three", "two"}, "all.polemap",
                  {"--keep-scans", days[0], days[1], days[2], days[3]})
                  .code,
              0);
    EXPECT_EQ(readText(folder / "m.polemap"), readText(folder / "all.polemap"));
  }
}

TEST_F(MapSessions, RefusesWhatItCannotAddTo) {
  ASSERT_EQ(map("paper.ini", {"one"}, "bare.polemap").code, 0);
  expectFailure(map("paper.ini", {"two"}, "m.polemap", {"--add", at("bare.polemap")}),
                {"bare.polemap", "keeps no scans", "--keep-scans"});
  ASSERT_EQ(map("paper.ini", {"one"}, "kept.polemap", {"--keep-scans"}).code, 0);
  expectFailure(map("all.ini", {"two"}, "m.polemap", {"--add", at("kept.polemap")}),
                {"kept.polemap", "unvisited_m = 0", "10"});
  EXPECT_FALSE(fs::exists(folder / "m.polemap"));
}

TEST_F(MapSessions, ADriveIsNotTakenTwice) {
  const std::string known = "two.rawlog: all its scans are those of the session two.rawlog";
  expectFailure(map("all.ini", {"one", "two", "two"}, "twice.polemap"), {known});
  ASSERT_EQ(map("all.ini", {"one", "two"}, "kept.polemap", {"--keep-scans"}).code, 0);
  expectFailure(map("all.ini", {"two"}, "added.polemap", {"--add", at("kept.polemap")}), {known});
}

TEST_F(MapSessions, WhereScansAreFarApartItSaysThatFewerAreNeeded) {
  EXPECT_HAS(map("all.ini", {"one"}, "a.polemap").out, "a pole needs 2 sections of one run");
  EXPECT_HAS(map("all.ini", {"one"}, "b.polemap", {"--set", "map.section_length_m=0.8"}).out,
             "(min_count = 2, less as scans are far apart)");
}

TEST_F(MapSessions, SessionsThatDisagreeOnTheDatumAreRefused) {
  const std::vector<std::string> here{"--keep-scans", "--datum", "42.25,-83.5,-1"};
  ASSERT_EQ(map("all.ini", {"one"}, "m.polemap", here).code, 0);
  EXPECT_EQ(io::readPoleMap(folder / "m.polemap").info.at("datum"), "42.25,-83.5,-1");
  for (const auto& [command, option] :
       {std::pair<std::string, std::string>("build", "--add"), {"update", "--map"}}) {
    SCOPED_TRACE(command);
    expectFailure(map("all.ini", {"two"}, "n.polemap",
                      {option, at("m.polemap"), "--datum", "42.25,-83.5,0"}, command),
                  {"m.polemap", "42.25,-83.5,-1", "42.25,-83.5,0"});
    EXPECT_FALSE(fs::exists(folder / "n.polemap"));
    ASSERT_EQ(map("all.ini", {"two"}, "o.polemap", {option, at("m.polemap")}, command).code, 0);
    EXPECT_EQ(io::readPoleMap(folder / "o.polemap").info.at("datum"), "42.25,-83.5,-1");
  }
  EXPECT_EQ(chunk("o.polemap", "SCAN"), "");  // an updated map is not what its scans say
  expectFailure(map("all.ini", {"one"}, "n.polemap", {"--datum", "91,0"}), {"--datum", "91,0"});
}

TEST_F(MapSessions, AnUpdateInPlaceDoesNotTakeTheScansAway) {
  ASSERT_EQ(map("all.ini", {"one"}, "m.polemap", {"--keep-scans"}).code, 0);
  const std::string before = readText(folder / "m.polemap");
  expectFailure(map("all.ini", {"two"}, "m.polemap", {"--map", at("m.polemap")}, "update"),
                {"m.polemap: keeps the scans it was made of", "--output"});
  EXPECT_EQ(readText(folder / "m.polemap"), before);
}

TEST_F(MapSessions, ReadTheMapOnceAsAnotherMayReplaceIt) {
  ASSERT_EQ(map("all.ini", {"one"}, "m.polemap", {"--keep-scans"}).code, 0);
  const testing_disk::DiskCalls calls;
  ASSERT_EQ(map("all.ini", {"three"}, "n.polemap", {"--add", at("m.polemap")}).code, 0);
  EXPECT_EQ(calls.of("open m.polemap").size(), 1u);
}

TEST_F(MapSessions, WrongUsage) {
  expectUsageError(map("all.ini", {"one"}, "m.polemap", {"--add", "a", "--map", "b"}));
  expectUsageError(runProgram(mapMain, {"build", "--add", "a.polemap"}));
}

}  // namespace
}  // namespace polemcl::test_map_sessions
