#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "cli/JsonFile.h"
#include "io/data/Trajectory.h"
#include "io/map/PoleMapFile.h"
#include "map/MapApp.h"
#include "support/StreetTest.h"

namespace polemcl::test_map_update_app {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

/// A street on the day of the map; on the next day one pole is gone, one has come, one has moved.
class MapUpdateApp : public StreetTest {
 protected:
  MapUpdateApp() {
    yesterday = streetPoles();
    today = yesterday;
    for (auto& pole : today)
      if (pole.x == 9 && pole.y == 6) pole.y = 7;  // moved by a metre
    today.erase(std::find_if(today.begin(), today.end(),
                             [](const auto& p) { return p.x == 13 && p.y == -7; }));
    today.push_back({5, 9});
  }
  void drive(const std::string& name, const std::vector<StreetPole>& poles) {
    writeStreet(folder / name, 25, poles, 50, 0);
    import(name);
  }
  void mapYesterday() {
    drive("day0", yesterday);
    const Outcome outcome =
        succeeded(runProgram(mapMain, {"build", "--config", config(), "--input", at("day0.rawlog"),
                                       "--truth", at("day0.tum"), "--date", "2026-03-01",
                                       "--output", at("day0.polemap"), "--csv", at("m.csv")}));
  }
  void mapYesterdayAndDriveToday() {
    mapYesterday();
    drive("day1", today);
  }
  Outcome update(const std::vector<std::string>& more = {}) {
    return runProgram(
        mapMain,
        {"update", "--config", config(), "--map", at("day0.polemap"), "--input", at("day1.rawlog"),
         "--truth", at("day1.tum"), "--output", at("day1.polemap")},
        more);
  }
  Outcome updateByRun(const std::vector<std::string>& more = {}) {
    return runProgram(
        mapMain,
        {"update", "--config", config(), "--map", at("day0.polemap"), "--input", at("day1.rawlog"),
         "--estimate", at("run_00.tum"), "--output", at("day1.polemap")},
        more);
  }
  /// Files of a run of pole-localize over day1 that estimated the true poses.
  /// \param state From scan `doubtful` on; `lost` before. \param shift Added to all times, s.
  void writeRun(const std::string& state, double variance, int doubtful = 0, double shift = 0) {
    std::ostringstream cov, health;
    cov << std::fixed << std::setprecision(9)
        << "scan,timestamp,x_m,y_m,yaw_rad,xx,xy,xyaw,yy,yyaw,yawyaw\n";
    health << "scan,timestamp,state\n";
    int scan = 0;
    for (const auto& [time, pose] : io::planar(io::readTum(folder / "day1.tum"))) {
      cov << scan << ',' << time + shift << ',' << pose.x << ',' << pose.y << ',' << pose.yaw << ','
          << variance << ",0,0," << variance << ",0," << variance / 100 << '\n';
      health << scan << ',' << time << ',' << (scan < doubtful ? "lost" : state) << '\n';
      ++scan;
    }
    writeText(folder / "run_00_cov.csv", cov.str());
    writeText(folder / "run_00_health.csv", health.str());
  }
  static bool has(const std::vector<MapPole>& poles, double x, double y) {
    return std::any_of(poles.begin(), poles.end(), [&](const MapPole& pole) {
      return std::hypot(pole.x - x, pole.y - y) < 0.1;
    });
  }
  std::vector<StreetPole> yesterday, today;
};

TEST_F(MapUpdateApp, AFreshMapTellsWhenItsPolesWereSeen) {
  mapYesterday();
  const auto map = io::readPoleMap(folder / "day0.polemap");
  ASSERT_EQ(map.histories.size(), map.poles.size());
  for (const auto& history : map.histories) {
    EXPECT_NEAR(history.firstSeen, 1772323200, 100);  // date -u -d 2026-03-01 +%s
    EXPECT_GE(history.lastSeen, history.firstSeen);
  }
  EXPECT_NE(readText(folder / "m.csv").find(",2026-03-01,2026-03-01\n"), std::string::npos);
}

TEST_F(MapUpdateApp, TheMapFollowsTheStreet) {
  mapYesterdayAndDriveToday();
  const Outcome outcome = succeeded(
      update({"--date", "2026-03-02", "--csv", at("new.csv"), "--scene", at("new.3Dscene")}));
  const auto before = io::readPoleMap(folder / "day0.polemap").poles;
  const auto after = io::readPoleMap(folder / "day1.polemap");
  ASSERT_TRUE(has(before, 9, 6) && has(before, 13, -7));
  EXPECT_TRUE(has(after.poles, 9, 7));
  EXPECT_FALSE(has(after.poles, 9, 6)) << "a ghost";
  EXPECT_FALSE(has(after.poles, 13, -7)) << "it is gone";
  EXPECT_TRUE(has(after.poles, 5, 9));
  EXPECT_TRUE(has(after.poles, 4, -7)) << "it stands";
  EXPECT_EQ(after.info.at("updates"), "day1.rawlog");
  EXPECT_EQ(after.info.at("f_map.day1"), "1.000000");  // all its scans count
  EXPECT_NE(outcome.out.find("1 vanished, 1 moved"), std::string::npos) << outcome.out;
  EXPECT_TRUE(fs::exists(folder / "new.3Dscene"));
  EXPECT_NE(readText(folder / "new.csv").find(",2026-03-01,2026-03-02\n"), std::string::npos);
}

TEST_F(MapUpdateApp, ListsAndDrawsWhatChanged) {
  mapYesterdayAndDriveToday();
  ASSERT_EQ(update().code, 0);
  const Outcome outcome = succeeded(
      runProgram(mapMain, {"diff", at("day0.polemap"), at("day1.polemap"), "--png", at("d.png"),
                           "--scene", at("d.3Dscene"), "--csv", at("d.csv")}));
  EXPECT_NE(outcome.out.find("1 vanished, 1 moved"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("(1.0"), std::string::npos) << outcome.out;
  const std::string csv = readText(folder / "d.csv");
  EXPECT_EQ(csv.rfind("change,x,y,x_before,y_before,distance\n", 0), 0u);
  EXPECT_NE(csv.find("\nvanished,"), std::string::npos);
  EXPECT_NE(csv.find("\nmoved,"), std::string::npos);
  EXPECT_NE(csv.find("\nnew,"), std::string::npos);
  EXPECT_GT(fs::file_size(folder / "d.png"), 5000u);
  EXPECT_GT(fs::file_size(folder / "d.3Dscene"), 1000u);
}

TEST_F(MapUpdateApp, MapsOfDifferentDatumsAreNotCompared) {
  for (const std::string name : {"a", "b"}) {
    io::PoleMapData map;
    map.poles.push_back({});
    map.info["datum"] = name == "a" ? "52,13" : "52,13,90";
    io::writePoleMap(folder / (name + ".polemap"), map);
  }
  expectFailure(runProgram(mapMain, {"diff", at("a.polemap"), at("b.polemap")}),
                {"b.polemap: its datum is 52,13,90, but that of ", "a.polemap is 52,13,0;"});
  EXPECT_EQ(runProgram(mapMain, {"diff", at("a.polemap"), at("a.polemap")}).code, 0);
}

TEST_F(MapUpdateApp, RefusesASessionOfAnotherPlace) {
  mapYesterday();
  auto elsewhere = yesterday;
  for (auto& pole : elsewhere) pole.x += 3.3;
  for (auto& pole : elsewhere) pole.y += pole.y > 0 ? 3 : -3;
  drive("day1", elsewhere);
  writeText(folder / "day1.polemap", "old");
  expectFailure(update(), {"day1.rawlog", "poles of", "were found", "datum"});
  EXPECT_EQ(readText(folder / "day1.polemap"), "old");
}

TEST_F(MapUpdateApp, RefusesASessionInAnotherFrame) {
  mapYesterdayAndDriveToday();
  auto truth = io::planar(io::readTum(folder / "day1.tum"));
  for (auto& pose : truth) pose.pose.y += 20000;
  io::writeTum(folder / "day1.tum", truth);
  expectFailure(update(), {"day1.rawlog", "20 km from the poles of", "datum"});
}

TEST_F(MapUpdateApp, RefusesASessionOfAnEarlierDay) {
  mapYesterdayAndDriveToday();
  expectFailure(update({"--date", "2026-02-28"}),
                {"day1.rawlog", "is of 2026-02-28", "day0.polemap of 2026-03-01", "--date"});
  EXPECT_EQ(update({"--date", "2026-03-01"}).code, 0);
}

TEST_F(MapUpdateApp, RefusesBadFilesAndDates) {
  drive("day1", today);
  expectFailure(update(), {"day0.polemap"});
  mapYesterday();
  expectFailure(update({"--date", "2026-02-30"}), {"2026-02-30", "YYYY-MM-DD"});
  expectFailure(runProgram(mapMain, {"diff", at("day0.polemap"), at("no.polemap")}),
                {"no.polemap"});
}

// The run of a localizer serves instead of the truth. Where it was not ok, nothing changes.
TEST_F(MapUpdateApp, TakesTheLocalizersOwnPoses) {
  mapYesterdayAndDriveToday();
  ASSERT_EQ(update({"--json", at("truth.json")}).code, 0);
  const std::string byTruth = readText(folder / "day1.polemap");
  writeRun("ok", 1e-6);
  const Outcome outcome = succeeded(updateByRun({"--json", at("update.json")}));
  const auto after = io::readPoleMap(folder / "day1.polemap");
  EXPECT_TRUE(has(after.poles, 9, 7));
  EXPECT_FALSE(has(after.poles, 13, -7));
  EXPECT_TRUE(has(after.poles, 5, 9));
  EXPECT_EQ(after.info.at("poses.day1"), "estimate");
  const Json json = readJson(folder / "update.json");
  EXPECT_EQ(json.at("sessions").at(0).at("poses"), "estimate");
  EXPECT_EQ(json.at("sessions").at(0).at("scans"), 25);
  EXPECT_EQ(json.at("sessions").at(0).at("vanished"), 1);
  EXPECT_EQ(readJson(folder / "truth.json").at("sessions").at(0).at("poses"), "truth");
}

TEST_F(MapUpdateApp, DoubtfulPosesDoNotChangeTheMap) {
  mapYesterdayAndDriveToday();
  writeRun("degraded", 1e-6);
  expectFailure(updateByRun(), {"day1.rawlog", "25 at which the localizer was not ok"});
  writeRun("ok", 0.09);  // 0.3 m
  expectFailure(updateByRun(), {"day1.rawlog", "all 25 poses", "above 0.25 m"});
  writeRun("ok", 1e-6, 7);
  const Outcome outcome = succeeded(updateByRun());
  EXPECT_NE(outcome.out.find("not ok, not used: 7"), std::string::npos) << outcome.out;
  writeRun("ok", 1e-6, 0, 5);
  expectFailure(updateByRun(), {"run_00.tum", "scan 0", "is it a run over this rawlog"});
  fs::remove(folder / "run_00_health.csv");
  expectFailure(updateByRun(), {"run_00_health.csv"});
}

// An inventory is off by 0.4 m, and knows a pole far away; a drive localized in it makes it exact.
TEST_F(MapUpdateApp, AnInventoryBecomesAsExactAsTheLidar) {
  drive("day1", today);
  writeRun("ok", 1e-6);
  io::PoleMapData inventory;
  for (const auto& [x, y] : today) {
    MapPole pole;
    pole.x = x + 0.4 * std::cos(x + y);
    pole.y = y + 0.4 * std::sin(x + y);
    pole.covariance = Eigen::Matrix2d::Identity() * 0.25;
    inventory.poles.push_back(pole);
  }
  inventory.poles.front().x = -400;
  inventory.info = {{"datum", "52,13,0"}};
  io::writePoleMap(folder / "inventory.polemap", inventory);
  const std::vector<std::string> build{"build",
                                       "--config",
                                       config(),
                                       "--input",
                                       at("day1.rawlog"),
                                       "--inventory",
                                       at("inventory.polemap"),
                                       "--output",
                                       at("exact.polemap")};
  auto arguments = build;
  arguments.insert(arguments.end(), {"--estimate", at("run_00.tum")});
  const Outcome outcome = succeeded(runProgram(mapMain, arguments));
  EXPECT_NE(outcome.out.find("out of sight, kept: 1"), std::string::npos) << outcome.out;
  const auto map = io::readPoleMap(folder / "exact.polemap");
  EXPECT_EQ(map.info.at("datum"), "52,13,0");
  EXPECT_EQ(map.info.count("pose_sigma_m"), 1u);
  EXPECT_TRUE(has(map.poles, -400, inventory.poles.front().y));
  // Distances between poles are those of the street, wherever the whole stands.
  const auto nearest = [&](const StreetPole& to) {
    const auto found =
        std::min_element(map.poles.begin(), map.poles.end(), [&](const auto& a, const auto& b) {
          return std::hypot(a.x - to.x, a.y - to.y) < std::hypot(b.x - to.x, b.y - to.y);
        });
    return Eigen::Vector2d(found->x, found->y);
  };
  for (std::size_t i = 4; i < 12; ++i) {
    const double right = std::hypot(today[i].x - today[3].x, today[i].y - today[3].y);
    EXPECT_NEAR((nearest(today[i]) - nearest(today[3])).norm(), right, 0.05) << i;
  }
  expectUsageError(runProgram(mapMain, build));
  arguments = build;
  arguments.insert(arguments.end(), {"--truth", at("day1.tum")});
  expectUsageError(runProgram(mapMain, arguments));

  fs::remove(folder / "day1" / "odometry.txt");
  import("day1");
  arguments = build;
  arguments.insert(arguments.end(), {"--estimate", at("run_00.tum")});
  expectFailure(runProgram(mapMain, arguments),
                {"day1.rawlog", "only 0 of 25 scans have odometry", "--inventory needs it"});
}

TEST_F(MapUpdateApp, WarnsWhenManyPolesHaveMoved) {
  mapYesterdayAndDriveToday();  // 1 of about 12 moved
  const Outcome outcome = succeeded(update({"--quiet", "--json", at("update.json")}));
  EXPECT_NE(outcome.err.find("pole-map: warning: "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("seem to have moved"), std::string::npos) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
  EXPECT_EQ(readJson(folder / "update.json").at("warnings").size(), 1u);
  EXPECT_EQ(io::readPoleMap(folder / "day1.polemap").info.count("warnings"), 1u);
  drive("day1", yesterday);
  const auto same = update({"--json", at("update.json")});
  EXPECT_EQ(same.err, "");
  EXPECT_EQ(readJson(folder / "update.json").at("warnings").size(), 0u);
  EXPECT_EQ(io::readPoleMap(folder / "day1.polemap").info.count("warnings"), 0u);
}

TEST_F(MapUpdateApp, WrongUsage) {
  const std::vector<std::string> right{"update", "--config", "c", "--map",    "m",        "--input",
                                       "a",      "--truth",  "a", "--output", "m.polemap"};
  for (const std::vector<std::string>& more : {std::vector<std::string>{"--keep-scans"},
                                               {"--add", "a"},
                                               {"--date", "d", "e"},
                                               {"--json", "m.polemap"},
                                               {"--estimate", "a"},
                                               {"--csv", "m.polemap"}}) {
    SCOPED_TRACE(more.front());
    auto arguments = right;
    arguments.insert(arguments.end(), more.begin(), more.end());
    expectUsageError(runProgram(mapMain, arguments));
  }
  expectUsageError(runProgram(mapMain, {right.begin(), right.end() - 2}));
  expectUsageError(runProgram(mapMain, {"diff", "a.polemap"}));
  expectUsageError(runProgram(mapMain, {"diff", "a", "b", "--set", "map_update.moved_m=1"}));
  expectUsageError(runProgram(mapMain, {"diff", "a", "b", "--csv", "c", "--png", "./c"}));
}

}  // namespace
}  // namespace polemcl::test_map_update_app
