#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "core/mapping/MapAccumulator.h"
#include "support/Poles.h"
#include "support/Refusal.h"

namespace polemcl::test_map_accumulator {
namespace {

using tests::expectSame;

const double kNan = std::numeric_limits<double>::quiet_NaN();

/// A scan at (x, y) that sees the poles within 12 m, without error.
SessionScan scanAt(double x, double y, const std::vector<Eigen::Vector2d>& poles, double time = 0) {
  SessionScan scan;
  scan.time = time;
  scan.pose_map_robot = {x, y, 0};
  scan.visibilityRange.assign(256, 12.0f);
  for (const Eigen::Vector2d& p : poles) {
    if (std::hypot(p.x() - x, p.y() - y) > 12) continue;
    scan.poles_robot.push_back(tests::detectionAt(p.x() - x, p.y() - y));
  }
  return scan;
}

/// One scan a metre along y = `y`.
std::vector<SessionScan> drive(double fromX, double toX, double y,
                               const std::vector<Eigen::Vector2d>& poles = {}) {
  std::vector<SessionScan> scans;
  for (double x = fromX; x <= toX; x += 1)
    scans.push_back(scanAt(x, y, poles, 1000 + static_cast<double>(scans.size())));
  return scans;
}

std::vector<Eigen::Vector2d> somePoles() {
  std::mt19937 random(3);
  std::vector<Eigen::Vector2d> poles;
  for (int i = 0; i < 60; ++i) {
    const double y = static_cast<double>(random() % 300) / 5 - 20;
    poles.emplace_back(static_cast<double>(random() % 1000) / 5, y);
  }
  return poles;
}

PoleMapOptions mapping(double unvisited) {
  PoleMapOptions options;
  options.sectionLength = 1;
  options.everyScan = false;
  options.minShare = 0;
  options.minCount = 2;
  options.unvisited = unvisited;
  return options;
}

MapAccumulator fresh(double unvisited) {
  return {mapping(unvisited), {}};
}

std::vector<bool> chosen(MapAccumulator& map, const std::vector<SessionScan>& scans) {
  return map.add("s", scans).used;
}

TEST(MapAccumulator, UsesEverythingUnlessAsked) {
  const auto poles = somePoles();
  const auto first = drive(0, 100, 0, poles), second = drive(50, 150, 2, poles);
  MapAccumulator map = fresh(0);
  EXPECT_EQ(map.add("one", first).usedShare(), 1);
  EXPECT_EQ(map.add("two", second).usedShare(), 1);
  std::vector<MappingScan> scans;
  std::vector<SessionScan> all;
  for (const auto& scan : first) scans.push_back({scan.pose_map_robot, scan.poles_robot, 4});
  for (const auto& scan : second) scans.push_back({scan.pose_map_robot, scan.poles_robot, 9});
  for (const auto& scan : first) all.push_back(scan);
  for (const auto& scan : second) all.push_back(scan);
  const PoleMapResult expected = buildPoleMap(scans, mapping(0));
  ASSERT_GT(expected.poles.size(), 20u);
  expectSame(map.build().poles, expected.poles);
  const LandmarkMap histories = withHistory(expected.poles, all, mapping(0), {});
  const LandmarkMap found = map.withHistories(expected.poles);
  ASSERT_EQ(found.poles.size(), histories.poles.size());
  for (std::size_t i = 0; i < found.poles.size(); ++i) {
    EXPECT_EQ(found.poles[i].history.seen, histories.poles[i].history.seen);
    EXPECT_EQ(found.poles[i].history.lastSeen, histories.poles[i].history.lastSeen);
  }
}

TEST(MapAccumulator, PlacesOfScansThatAreNotUsedAreVisitedToo) {
  MapAccumulator map = fresh(10);
  chosen(map, {scanAt(0, 0, {})});
  EXPECT_EQ(chosen(map, {scanAt(8, 0, {})}), std::vector<bool>{false});
  EXPECT_EQ(chosen(map, {scanAt(16, 0, {})}), std::vector<bool>{false});  // 8 m from the second
  EXPECT_EQ(chosen(map, {scanAt(27, 0, {})}), std::vector<bool>{true});
}

TEST(MapAccumulator, AsFarAsThatIsNotFarther) {
  for (const double distance : {10.0, 0.1, 7.3}) {
    MapAccumulator map = fresh(distance);
    chosen(map, {scanAt(0, 0, {})});
    EXPECT_EQ(chosen(map, {scanAt(distance, 0, {}), scanAt(0, distance * (1 + 1e-12), {})}),
              (std::vector<bool>{false, true}));
  }
}

TEST(MapAccumulator, WhatIsLeftOutChangesNothing) {
  const auto poles = somePoles();
  MapAccumulator map = fresh(10), other = fresh(10);
  map.add("one", drive(0, 80, 0, poles));
  other.add("one", drive(0, 80, 0, poles));
  auto second = drive(20, 160, 1, poles);
  map.add("two", second);
  for (auto& scan : second)
    if (scan.pose_map_robot.x < 85) scan.poles_robot.clear();
  const AddedSession& added = other.add("two", second);
  EXPECT_EQ(added.usedCount(), 71u);  // from x = 90 on, 10.05 m from the end of the first
  EXPECT_NEAR(added.usedShare(), 71.0 / 141, 1e-12);
  EXPECT_TRUE(added.scans.front().poles_robot.empty() &&
              added.scans.front().visibilityRange.empty());
  ASSERT_GT(map.build().poles.size(), 20u);
  expectSame(map.build().poles, other.build().poles);
}

TEST(MapAccumulator, ASessionOfWhichNothingIsUsedChangesNothing) {
  const auto poles = somePoles();
  PoleMapOptions options = mapping(10);
  options.minCount = 4;
  MapAccumulator map(options, {});
  auto first = drive(0, 80, 0, poles);
  for (auto& scan : first)
    for (auto& pole : scan.poles_robot) pole.confidence = 0.25;
  map.add("one", first);
  const auto before = map.build().poles;
  EXPECT_EQ(map.add("two", drive(0, 80, 1, poles)).usedCount(), 0u);
  expectSame(map.build().poles, before);
}

TEST(MapAccumulator, GoesOnAsIfItHadNeverStopped) {
  const auto poles = somePoles();
  const std::vector<std::vector<SessionScan>> sessions{
      drive(0, 80, 0, poles), drive(40, 130, 3, poles), drive(0, 190, 14, poles)};
  MapAccumulator whole = fresh(10);
  AddedSessions kept;
  kept.unvisited = 10;
  for (const auto& session : sessions) {
    whole.add("s", session);
    MapAccumulator today(mapping(10), {}, kept);
    today.add("s", session);
    kept = today.added();
    expectSame(today.build().poles, whole.build().poles);
  }
  EXPECT_EQ(kept.scans(), 81u + 91u + 191u);
}

TEST(MapAccumulator, RefusesWhatItCannotGoOnFrom) {
  AddedSessions kept;
  kept.unvisited = 10;
  const auto message = [&](double unvisited) -> std::string {
    return tests::messageOf([&] { MapAccumulator map(mapping(unvisited), {}, kept); });
  };
  EXPECT_HAS(message(5), "unvisited_m = 5, but the scans of the map were chosen with 10");
  EXPECT_EQ(message(10), "no error");
  EXPECT_THROW(fresh(-1), Error);
  EXPECT_THROW(fresh(kNan), Error);
  MapAccumulator map = fresh(10);
  EXPECT_THROW(map.add("s", {scanAt(0, kNan, {})}), Error);
}

TEST(MapAccumulator, RefusesASessionInAnotherFrame) {
  MapAccumulator map = fresh(0);
  map.add("one", drive(0, 100, 0));
  map.add("near", drive(9000, 9100, 0));
  EXPECT_REFUSED(map.add("utm", drive(9000, 9100, 25000)), "session utm: its poses are 25 km");
  EXPECT_EQ(map.added().sessions.size(), 2u);
  EXPECT_NO_THROW(map.add("farther", drive(19000, 19050, 0)));  // near one of them
}

}  // namespace
}  // namespace polemcl::test_map_accumulator
