// Simulated streets whose poles change from day to day: a kept map against one that is not.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/evaluation/MapEvaluation.h"
#include "core/mapping/MapUpdater.h"
#include "sim/common/Random.h"
#include "sim/detections/DetectionSampler.h"

namespace polemcl::test_map_updater_on_streets {
namespace {

using Positions = std::vector<Eigen::Vector2d>;

struct Day {
  std::vector<SessionScan> scans;
  Positions poles;  ///< true ones, within 20 m of the way
};

PoleMapOptions mapping() {
  PoleMapOptions options;
  options.everyScan = true;
  options.counting = PoleCounting::run;
  options.minConfidence = 0;
  options.minCount = 5;
  options.minShare = 0.4;
  return options;
}

Day drive(std::uint64_t seed, int day) {
  sim::SimulationOptions options;
  options.world.seed = seed;
  options.world.day = day;
  options.world.length = 250;
  options.world.removedShare = options.world.addedShare = 0.15;
  const sim::World world = sim::makeWorld(options.world);
  const sim::Drive way = sim::makeDrive(world, options);
  const sim::DetectionSampler sampler(
      sim::readDetectionModel(std::string(POLEMCL_SOURCE_DIR) + "/share/models/hdl32e.json"), world,
      options);
  Day result;
  for (std::size_t i = 0; i < way.time.size(); ++i) {
    const Eigen::Isometry3d T = sim::cloudFrame(way.T_map_sensor[i], options);
    const Eigen::Vector3d ahead = T.linear().col(0);
    SessionScan scan;
    scan.time = 86400.0 * (1000 + 30 * day) + way.time[i];
    scan.pose_map_robot = {T.translation().x(), T.translation().y(),
                           std::atan2(ahead.y(), ahead.x())};
    scan.poles_robot = sampler.sample(i, way.T_map_sensor[i]);
    scan.visibilityRange = sampler.visibilityRange(way.T_map_sensor[i]);
    result.scans.push_back(scan);
  }
  for (const sim::TruePole& pole : world.poles()) {
    const bool near = std::any_of(result.scans.begin(), result.scans.end(), [&](const auto& s) {
      return std::hypot(s.pose_map_robot.x - pole.x, s.pose_map_robot.y - pole.y) < 20;
    });
    if (near) result.poles.emplace_back(pole.x, pole.y);
  }
  return result;
}

/// The poses as a survey gives them: 2 cm and 0.1° off in all of a session, another 3 cm and 0.2°
/// in each scan (standard deviations).
void err(Day& day, std::uint64_t seed) {
  sim::Random random(seed);
  const auto draw = [&](double metres, double radians) {
    return Pose2D{random.normal(0, metres), random.normal(0, metres), random.normal(0, radians)};
  };
  const Pose2D common = draw(0.02, 0.0017);
  for (SessionScan& scan : day.scans) {
    const Pose2D own = draw(0.03, 0.0035);
    Pose2D& pose = scan.pose_map_robot;
    pose = {pose.x + common.x + own.x, pose.y + common.y + own.y, pose.yaw + common.yaw + own.yaw};
  }
}

Day driveErring(std::uint64_t world, int day) {
  Day result = drive(world, day);
  err(result, 10 * world + static_cast<std::uint64_t>(day));
  return result;
}

std::vector<MapPole> built(const Day& day) {
  std::vector<MappingScan> scans;
  for (const SessionScan& scan : day.scans)
    scans.push_back({scan.pose_map_robot, scan.poles_robot, 0});
  return buildPoleMap(scans, mapping()).poles;
}

MapScore score(const Day& day, const std::vector<MapPole>& poles) {
  Positions places;
  for (const MapPole& pole : poles) places.emplace_back(pole.x, pole.y);
  return scoreMap(day.poles, places, 0.5, true);
}

// The mean of four worlds, each day with 15 % of the poles gone and as many new ones. Measured:
// day 1 and 2, kept F1 0.93 and 0.91, not kept 0.82 and 0.81, built anew that day 0.93 and 0.94.
TEST(MapUpkeepOnStreets, KeepsAMapNearlyAsGoodAsOneBuiltThatDay) {
  struct Mean {
    double precision = 0, recall = 0, f1 = 0;
    void add(const MapScore& score) {
      precision += score.precision / 4, recall += score.recall / 4, f1 += score.f1 / 4;
    }
  };
  Mean unkept[2], kept[2], anew[2];
  for (const std::uint64_t world : {31, 32, 33, 34}) {
    const Day first = driveErring(world, 0);
    const std::vector<MapPole> old = built(first);
    LandmarkMap map = withHistory(old, first.scans, mapping(), {});
    for (int day = 1; day <= 2; ++day) {
      const Day today = driveErring(world, day);
      map = updateMap(map, today.scans, mapping(), {});
      unkept[day - 1].add(score(today, old));
      kept[day - 1].add(score(today, presentPoles(map)));
      anew[day - 1].add(score(today, built(today)));
    }
  }
  for (int i = 0; i < 2; ++i) {
    SCOPED_TRACE("day " + std::to_string(i + 1) + ", F1 not kept " + std::to_string(unkept[i].f1) +
                 ", kept " + std::to_string(kept[i].f1) + ", anew " + std::to_string(anew[i].f1));
    EXPECT_GT(kept[i].precision, unkept[i].precision + 0.10);
    EXPECT_GT(kept[i].recall, unkept[i].recall + 0.05);
    EXPECT_GT(kept[i].f1, 0.90);
    EXPECT_GT(kept[i].f1, anew[i].f1 - 0.03);
  }
}

}  // namespace
}  // namespace polemcl::test_map_updater_on_streets
