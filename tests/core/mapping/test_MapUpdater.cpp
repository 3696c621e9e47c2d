// Maps kept true in scenes made by hand, and in simulated streets whose poles change.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/common/Binder.h"
#include "core/mapping/MapSession.h"
#include "core/mapping/MapUpdater.h"
#include "support/Poles.h"
#include "support/Refusal.h"

namespace polemcl::test_map_updater {
namespace {

using tests::messageOf;

struct Place {
  double x, y;
};

MapPole poleAt(double x, double y) {
  return tests::mapPoleAt(x, y, 1e-4);
}

/// A drive along x, a scan a metre from 0 to 40 m, heading 90° to the left, so that frames matter.
/// Every scan sees all of `places` within 30 m; free all around to 40 m.
std::vector<SessionScan> drive(const std::vector<Place>& places, double day = 10) {
  std::vector<SessionScan> scans;
  for (int i = 0; i <= 40; ++i) {
    SessionScan scan;
    scan.time = 86400 * day + i;
    scan.pose_map_robot = {static_cast<double>(i), 0, M_PI / 2};
    scan.visibilityRange.assign(256, 40);
    for (const Place& place : places) {
      if (std::hypot(place.x - i, place.y) > 30) continue;
      // Robot frame: x forward is the map's y.
      scan.poles_robot.push_back(tests::detectionAt(place.y, i - place.x, 4e-4));
      scan.poles_robot.back().confidence = 0.9;
    }
    scans.push_back(scan);
  }
  return scans;
}

LandmarkMap kept(const std::vector<Place>& places) {
  std::vector<MapPole> poles;
  for (const Place& place : places) poles.push_back(poleAt(place.x, place.y));
  return landmarksFrom(poles);
}

/// The one kept pole within 0.1 m of a place; null if no pole is there.
const LandmarkRecord* find(const LandmarkMap& map, double x, double y) {
  const LandmarkRecord* found = nullptr;
  for (const LandmarkRecord& pole : map.poles)
    if (std::hypot(pole.pole.x - x, pole.pole.y - y) < 0.1) found = &pole;
  return found;
}

/// The same; it must be there.
const LandmarkRecord& at(const LandmarkMap& map, double x, double y) {
  const LandmarkRecord* const found = find(map, x, y);
  if (!found) throw Error("no pole is there");
  return *found;
}

struct Updated {
  LandmarkMap map;
  MapUpdateCounts counts;
};
Updated updated(const LandmarkMap& map, const std::vector<SessionScan>& scans) {
  Updated result;
  result.map = updateMap(map, scans, {}, {}, &result.counts);
  return result;
}
LandmarkMap updatedBy(const LandmarkMap& map, const std::vector<SessionScan>& scans,
                      MapUpdateCounts* counts = nullptr) {
  return updateMap(map, scans, {}, {}, counts);
}

TEST(MapUpdater, WhatIsSeenStays) {
  const auto [map, counts] = updated(kept({{10, 5}, {30, -6}}), drive({{10, 5}, {30, -6}}));
  ASSERT_EQ(map.poles.size(), 2u);
  for (const LandmarkRecord& pole : map.poles) {
    EXPECT_TRUE(pole.present);
    EXPECT_NEAR(pole.history.existence, 0.99, 1e-9);
    EXPECT_EQ(pole.history.missed, 0u);
    EXPECT_NEAR(pole.history.lastSeen, 86400 * 10 + 40, 11);
  }
  // (10, 5) lies within 20 m of the scans from 0 to 29 (hypot(20, 5) > 20).
  EXPECT_EQ(map.poles[0].history.seen, 30u + 30u) << "30 of the old map's count";
  EXPECT_EQ(map.poles[0].pole.count, 30u + 40u) << "within 30 m: from 0 to 39";
  EXPECT_EQ(counts.expectedOnMap, 2u);
  EXPECT_EQ(counts.foundOnMap, 2u);
  EXPECT_EQ(counts.entered + counts.left + counts.moved + counts.candidates, 0u);
}

TEST(MapUpdater, WhatIsMissedInFreeViewFades) {
  const auto [map, counts] = updated(kept({{10, 5}, {30, -6}}), drive({{10, 5}}));
  EXPECT_EQ(counts.left, 1u);
  EXPECT_EQ(counts.foundOnMap, 1u);
  EXPECT_EQ(presentPoles(map).size(), 1u);
  EXPECT_TRUE(at(map, 10, 5).present);
}

// It stands 19.5 m ahead of the last scan, and more than 20 m, where nothing is expected, of the
// others.
TEST(MapUpdater, ASingleSightingIsNoCandidate) {
  const std::vector<SessionScan> seen = drive({{59.5, 0}});
  std::vector<SessionScan> scans = drive({});
  scans[40].poles_robot = seen[40].poles_robot;
  EXPECT_TRUE(updatedBy(kept({}), scans).poles.empty());
  scans[39].poles_robot = seen[39].poles_robot;
  EXPECT_EQ(updatedBy(kept({}), scans).poles.size(), 1u);
}

TEST(MapUpdater, WhatIsHiddenStays) {
  std::vector<SessionScan> scans = drive({{10, 5}});
  const std::size_t half = 128;
  // A lorry all along the right: nothing is seen farther than 4 m with y < 0. The robot heads to
  // +y, so that is behind it.
  for (SessionScan& scan : scans)
    for (std::size_t i = 0; i < 256; ++i)
      if (i < half / 2 || i >= half + half / 2) scan.visibilityRange[i] = 4;
  const LandmarkMap map = updatedBy(kept({{10, 5}, {30, -6}}), scans);
  EXPECT_TRUE(at(map, 30, -6).present);
  EXPECT_EQ(at(map, 30, -6).history.missed, 0u);
  EXPECT_NEAR(at(map, 30, -6).history.existence, 0.9, 1e-9);
}

TEST(MapUpdater, VisibilityRangesStandInTheSensorsFrame) {
  std::vector<SessionScan> scans = drive({{10, 5}});
  // The sensor looks along +x of the map: what lies to its right is hidden.
  for (SessionScan& scan : scans) {
    scan.pose_robot_sensor = {0, 0, -M_PI / 2};
    for (std::size_t i = 0; i < 128; ++i) scan.visibilityRange[i] = 4;
  }
  const LandmarkMap map = updatedBy(kept({{10, 5}, {30, -6}}), scans);
  EXPECT_EQ(at(map, 30, -6).history.missed, 0u);
  // And to its left it is not.
  for (SessionScan& scan : scans) scan.pose_robot_sensor.yaw = M_PI / 2;
  EXPECT_EQ(presentPoles(updatedBy(kept({{10, 5}, {30, -6}}), scans)).size(), 1u);
}

TEST(MapUpdater, WithoutVisibilityRangesNothingIsMissed) {
  std::vector<SessionScan> scans = drive({{10, 5}});
  for (SessionScan& scan : scans) scan.visibilityRange.clear();
  const auto [map, counts] = updated(kept({{10, 5}, {30, -6}}), scans);
  EXPECT_EQ(counts.withoutVisibility, 41u);
  EXPECT_EQ(presentPoles(map).size(), 2u);
  // Zero is unknown.
  for (SessionScan& scan : scans) scan.visibilityRange.assign(256, 0);
  EXPECT_EQ(presentPoles(updatedBy(kept({{10, 5}, {30, -6}}), scans)).size(), 2u);
}

TEST(MapUpdater, NewPolesEarnTheirPlace) {
  std::vector<SessionScan> scans = drive({{10, 5}, {20, -8}});
  const auto [map, counts] = updated(kept({{10, 5}}), scans);
  EXPECT_TRUE(at(map, 20, -8).present);
  EXPECT_EQ(counts.entered, 1u);
  EXPECT_NEAR(at(map, 20, -8).history.firstSeen, 86400 * 10, 1e-6);
  // Seen in two scans of one place only, it is a candidate, or nothing.
  for (std::size_t i = 0; i < scans.size(); ++i)
    if (i != 20 && i != 21)
      scans[i].poles_robot.resize(std::min<std::size_t>(
          scans[i].poles_robot.size(), std::hypot(10.0 - static_cast<double>(i), 5) <= 30));
  const LandmarkMap other = updatedBy(kept({{10, 5}}), scans);
  EXPECT_EQ(presentPoles(other).size(), 1u);
}

TEST(MapUpdater, CandidatesAreKeptUntilTheNextSession) {
  // Seen from the far end of the drive only, for 4 scans: too little for the map.
  std::vector<SessionScan> scans = drive({{10, 5}});
  const std::vector<SessionScan> both = drive({{10, 5}, {55, 4}});
  for (std::size_t i = 37; i <= 40; ++i) scans[i] = both[i];
  const auto [first, counts] = updated(kept({{10, 5}}), scans);
  EXPECT_EQ(counts.candidates, 1u);
  EXPECT_EQ(presentPoles(first).size(), 1u);
  EXPECT_FALSE(at(first, 55, 4).present);
  for (SessionScan& scan : scans) scan.time += 86400;
  const LandmarkMap second = updatedBy(first, scans);
  EXPECT_TRUE(at(second, 55, 4).present);
  EXPECT_NEAR(at(second, 55, 4).history.firstSeen, 86400 * 10 + 37, 1e-6);
  EXPECT_NEAR(at(second, 55, 4).history.lastSeen, 86400 * 11 + 40, 1e-6);
}

TEST(MapUpdater, APoleMovedAsideLeavesNoGhost) {
  const auto [map, counts] = updated(kept({{10, 5}, {30, -6}}), drive({{10, 5}, {30.9, -6}}));
  EXPECT_FALSE(find(map, 30, -6));
  EXPECT_TRUE(at(map, 30.9, -6).present);
  EXPECT_EQ(map.poles.size(), 2u);
  EXPECT_EQ(counts.moved, 1u);
  EXPECT_EQ(counts.left, 0u);
}

TEST(MapUpdater, AGhostGoesEvenIfHardlyLookedAt) {
  // The old place is hidden from all but two scans, the new one is in view all along.
  std::vector<SessionScan> scans = drive({{10, 5}, {30.9, -6}});
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (i == 28 || i == 29) continue;
    const double bearing = std::atan2(-(30.0 - static_cast<double>(i)), -6);  // robot frame
    for (int k = -2; k <= 2; ++k)
      scans[i].visibilityRange[static_cast<std::size_t>(
                                   std::floor((bearing + M_PI) / (2 * M_PI) * 256 + k + 256)) %
                               256] = 2;
  }
  const LandmarkMap map = updatedBy(kept({{10, 5}, {30, -6}}), scans);
  EXPECT_FALSE(find(map, 30, -6));
  EXPECT_TRUE(at(map, 30.9, -6).present);
}

TEST(MapUpdater, APoleMovedWithinTheGateTakesItsNewPlace) {
  const auto [map, counts] = updated(kept({{10, 5}, {30, -6}}), drive({{10, 5}, {30.4, -6}}));
  ASSERT_EQ(map.poles.size(), 2u);
  EXPECT_NEAR(map.poles[1].pole.x, 30.4, 0.01) << "not the middle";
  EXPECT_EQ(counts.moved, 1u);
  EXPECT_NEAR(map.poles[1].history.firstSeen, 86400 * 10, 1e-6) << "another pole, or another place";
}

// 0.4 m are 4.4 or 3.2 sigmas of the difference; the ellipse of 99.9 % ends at 3.7. Of the session,
// 0.02 m and little noise add to the pole's own.
TEST(MapUpdater, APoleHasMovedWhenItLeavesItsEllipse) {
  const auto movedWith = [](double sigma) {
    LandmarkMap map = kept({{10, 5}});
    map.poles[0].pole.covariance = sigma * sigma * Eigen::Matrix2d::Identity();
    MapUpdateCounts counts;
    updatedBy(map, drive({{10.4, 5}}), &counts);
    return counts.moved;
  };
  EXPECT_EQ(movedWith(0.088), 1u);
  EXPECT_EQ(movedWith(0.122), 0u);
}

TEST(MapUpdater, PlacesAreAveragedByTheirCovariances) {
  LandmarkMap map = kept({{10, 5}});
  map.poles[0].pole.covariance = Eigen::Vector2d(4e-4, 1e-4).asDiagonal();
  MapUpdateOptions upkeep;
  upkeep.sessionSigma = 0.02;
  const LandmarkMap after = updateMap(map, drive({{10.05, 5.05}}), {}, upkeep);
  ASSERT_EQ(after.poles.size(), 1u);
  const MapPole& pole = after.poles[0].pole;
  // 40 observations of 2 cm and more make less than 4 mm; 2 cm of the session stay.
  const double today = 4e-4;
  EXPECT_NEAR(pole.x, 10 + 0.05 * 4e-4 / (4e-4 + today), 1.5e-3);
  EXPECT_NEAR(pole.y, 5 + 0.05 * 1e-4 / (1e-4 + today), 1.5e-3);
  EXPECT_NEAR(pole.covariance(0, 0), 2e-4, 2e-5);
  EXPECT_NEAR(pole.covariance(1, 1), 0.8e-4, 1e-5);
}

TEST(MapUpdater, AScanGivesAPoleOneDetection) {
  // Two stand in one gate, and every scan shows both: two poles.
  const LandmarkMap map = updatedBy(kept({{10, 5}}), drive({{10, 5}, {10.4, 5}}));
  EXPECT_EQ(presentPoles(map).size(), 2u);
  EXPECT_EQ(at(map, 10, 5).pole.count, 30u + 40u);
}

TEST(MapUpdater, CountsEndAtTheGreatestNumber) {
  constexpr auto kAll = std::numeric_limits<std::uint32_t>::max();
  LandmarkMap map = kept({{10, 5}});
  map.poles[0].pole.count = map.poles[0].history.seen = kAll - 3;
  const LandmarkMap after = updatedBy(map, drive({{10, 5}}));
  ASSERT_EQ(after.poles.size(), 1u);
  EXPECT_EQ(after.poles[0].pole.count, kAll);
  EXPECT_EQ(after.poles[0].history.seen, kAll);
}

TEST(MapUpdater, TwoKeptPolesInOneGateBecomeOne) {
  // The old map has the pole twice; scans show one, now nearer to the one, now to the other, so
  // that each is found often enough to stay.
  std::vector<SessionScan> scans = drive({{10, 5}});
  const std::vector<SessionScan> others = drive({{10.3, 5}});
  for (std::size_t i = 0; i < scans.size(); i += 2) scans[i] = others[i];
  MapUpdateCounts counts;
  const LandmarkMap map = updateMap(kept({{10, 5}, {10.3, 5}}), scans, {}, {}, &counts);
  EXPECT_EQ(map.poles.size(), 1u);
  EXPECT_EQ(counts.left, 1u);
}

/// Scans that see a pole of which only the first knows how far it sees.
std::vector<SessionScan> glimpses(const Place& pole, const std::vector<std::size_t>& places,
                                  double day) {
  const std::vector<SessionScan> all = drive({pole}, day);
  std::vector<SessionScan> scans;
  for (const std::size_t place : places) {
    scans.push_back(all[place]);
    if (scans.size() > 1) scans.back().visibilityRange.clear();
  }
  return scans;
}

TEST(MapUpdater, AMovedPoleLeavesWhenTheNewOneEnters) {
  const std::vector<std::size_t> few{2, 8, 14, 20}, more{2, 8, 9, 14, 15, 20};
  MapUpdateCounts counts;
  LandmarkMap map = kept({{10, 5}});
  map.poles[0].history.existence = 0.99;
  map = updatedBy(map, glimpses({10.9, 5}, few, 11), &counts);
  EXPECT_EQ(counts.candidates, 1u);  // four scans are too few to enter
  ASSERT_EQ(presentPoles(map).size(), 1u);
  EXPECT_NEAR(presentPoles(map)[0].x, 10, 1e-9);
  map = updatedBy(map, glimpses({10.9, 5}, more, 12), &counts);
  EXPECT_EQ(counts.entered, 1u);
  ASSERT_EQ(presentPoles(map).size(), 1u);
  EXPECT_NEAR(presentPoles(map)[0].x, 10.9, 0.05);
}

TEST(MapUpdater, ANeighbourThatIsNotSeenStays) {
  // 0.42 m apart, both mapped; the far one is out of the range in which a pole is expected.
  MapUpdateOptions upkeep;
  upkeep.range = 5.2;
  const LandmarkMap before = kept({{10, 5}, {10, 5.42}});
  MapUpdateCounts counts;
  const LandmarkMap map = updateMap(before, drive({{10, 5}}), {}, upkeep, &counts);
  EXPECT_EQ(map.poles.size(), 2u);
  EXPECT_EQ(counts.left, 0u);
}

TEST(MapUpdater, CountsPolesNearToScansThatKnowNotHowFarTheySee) {
  std::vector<SessionScan> scans = drive({{10, 5}});
  MapUpdateCounts counts;
  updatedBy(kept({{10, 5}, {30, -4}, {30, 12}}), scans, &counts);
  EXPECT_EQ(counts.nearOnMap, 0u);
  for (SessionScan& scan : scans) scan.visibilityRange.clear();
  updatedBy(kept({{10, 5}, {30, -4}, {30, 12}}), scans, &counts);
  EXPECT_EQ(counts.nearOnMap, 2u);  // within 5 m of the path
  EXPECT_EQ(counts.expectedOnMap, 1u);
  EXPECT_EQ(counts.foundOnMap, 1u);
}

TEST(MapUpdater, WhatIsOutOfReachIsLeftAlone) {
  const LandmarkMap before = kept({{10, 5}, {300, 5}});
  const LandmarkMap map = updatedBy(before, drive({{10, 5}}));
  EXPECT_TRUE(at(map, 300, 5).present);
  EXPECT_EQ(at(map, 300, 5).history.existence, before.poles[1].history.existence);
}

TEST(MapUpdater, TimeMakesUnsure) {
  LandmarkMap map = kept({{10, 5}, {300, 5}});
  map.poles[1].history.lastSeen = 86400 * 10;
  MapUpdateOptions upkeep;
  upkeep.lifetimeDays = 365;
  const LandmarkMap after = updateMap(map, drive({{10, 5}}, 375), {}, upkeep);
  EXPECT_NEAR(at(after, 300, 5).history.existence, 0.9 / M_E, 0.02)
      << "clamped by nothing seen, decayed by a year";
}

TEST(MapUpdater, TimeCountsOnce) {
  // A year in twelve sessions is no longer than a year in one.
  LandmarkMap map = kept({{10, 5}, {300, 5}});
  for (LandmarkRecord& pole : map.poles) pole.history.lastSeen = 86400 * 10;
  MapUpdateOptions upkeep;
  upkeep.lifetimeDays = 365;
  for (int month = 1; month <= 12; ++month)
    map = updateMap(map, drive({{10, 5}}, 10 + month * 365.0 / 12), {}, upkeep);
  EXPECT_NEAR(at(map, 300, 5).history.existence, 0.9 / M_E, 0.001);
}

TEST(MapUpdater, ClocksOfDrivesAreNoDates) {
  // Simulated drives begin at 0; a later one with a date does not make the map 50 years old.
  LandmarkMap map = updatedBy(kept({{10, 5}, {300, 5}}), drive({{10, 5}}, 0));
  EXPECT_EQ(at(map, 10, 5).history.lastSeen, 0);
  EXPECT_EQ(at(map, 10, 5).history.firstSeen, 0);
  const double before = at(map, 300, 5).history.existence;
  map = updatedBy(map, drive({{10, 5}}, 20000));
  EXPECT_EQ(at(map, 300, 5).history.existence, before);
  EXPECT_EQ(at(map, 10, 5).history.firstSeen, 86400.0 * 20000);
}

TEST(MapUpdater, TheOrderOfDetectionsDoesNotMatter) {
  const LandmarkMap before = kept({{10, 5}, {30, -6}, {25, 7}});
  std::vector<SessionScan> scans = drive({{10, 5}, {30.4, -6}, {20, -8}, {20.45, -8}});
  const LandmarkMap a = updatedBy(before, scans);
  for (SessionScan& scan : scans) std::reverse(scan.poles_robot.begin(), scan.poles_robot.end());
  const LandmarkMap b = updatedBy(before, scans);
  ASSERT_EQ(a.poles.size(), b.poles.size());
  for (std::size_t i = 0; i < a.poles.size(); ++i) {
    EXPECT_EQ(a.poles[i].pole.x, b.poles[i].pole.x);
    EXPECT_EQ(a.poles[i].pole.y, b.poles[i].pole.y);
    EXPECT_EQ(a.poles[i].history.existence, b.poles[i].history.existence);
  }
}

TEST(MapUpdater, AFreshMapGetsItsHistoryFromItsScans) {
  const LandmarkMap map = withHistory({poleAt(10, 5), poleAt(30, -6)}, drive({{10.01, 5}}), {}, {});
  ASSERT_EQ(map.poles.size(), 2u);
  EXPECT_EQ(map.poles[0].pole.x, 10) << "places stay";
  EXPECT_EQ(map.poles[0].history.seen, 30u);
  EXPECT_NEAR(map.poles[0].history.firstSeen, 86400 * 10, 1e-6);
  EXPECT_NEAR(map.poles[0].history.lastSeen, 86400 * 10 + 39, 1e-6);
  EXPECT_NEAR(map.poles[0].history.existence, 0.99, 1e-9);
  EXPECT_EQ(map.poles[1].history.seen, 0u);
  EXPECT_EQ(map.poles[1].history.missed, 30u) << "within 20 m: from 11 to 40";
  EXPECT_TRUE(map.poles[1].present) << "the builder decided";
}

TEST(MapUpdater, RefusesBadScansAndOptions) {
  std::vector<SessionScan> scans = drive({{10, 5}});
  scans[3].visibilityRange[7] = -1;
  EXPECT_REFUSED(updatedBy({}, scans), "visibility range of " + nameOf(scans[3]));
  scans = drive({{10, 5}});
  scans[4].pose_map_robot.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_REFUSED(updatedBy({}, scans), "pose of " + nameOf(scans[4]));
  const auto refused = [](auto field, auto value) {
    MapUpdateOptions o;
    o.*field = value;
    return messageOf([&] { checkOptions(o); });
  };
  EXPECT_EQ(messageOf([] { checkOptions(MapUpdateOptions()); }), "no error");
  EXPECT_NE(refused(&MapUpdateOptions::range, 0.0).find("range_m"), std::string::npos);
  EXPECT_NE(refused(&MapUpdateOptions::minSeen, 0).find("min_seen"), std::string::npos);
  EXPECT_HAS(refused(&MapUpdateOptions::sessionSigma, -1.0), "session_sigma_m");
  EXPECT_NE(refused(&MapUpdateOptions::moved, 0.0).find("moved_m"), std::string::npos);
}

TEST(MapUpdater, NothingComesOfNothing) {
  EXPECT_TRUE(updatedBy({}, {}).poles.empty());
  EXPECT_EQ(updatedBy(kept({{10, 5}}), {}).poles.size(), 1u);
}

}  // namespace
}  // namespace polemcl::test_map_updater
