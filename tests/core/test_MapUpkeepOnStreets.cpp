/// \file test_MapUpkeepOnStreets.cpp
/// \brief Simulated streets whose poles change from day to day: a kept map against one that is not.

#include <gtest/gtest.h>
#include <polemcl/core/Evaluation.h>
#include <polemcl/core/MapUpkeep.h>
#include <polemcl/sim/DetectionModelFile.h>
#include <polemcl/sim/DetectionSampler.h>

#include <algorithm>
#include <cmath>

using namespace polemcl;

namespace {

using Positions = std::vector<Eigen::Vector2d>;

struct Day {
  std::vector<SessionScan> scans;
  Positions poles;  ///< true ones, within 20 m of the way
};

PoleMapOptions mapping() {
  PoleMapOptions options;
  options.everyScan = true;
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
    scan.freeRange = sampler.freeRange(way.T_map_sensor[i]);
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

}  // namespace

TEST(MapUpkeepOnStreets, keepsAMapAsGoodAsOnItsFirstDay) {
  const Day first = drive(31, 0);
  const std::vector<MapPole> old = built(first);
  KeptMap kept = withHistory(old, first.scans, mapping(), {});
  const double asNew = score(first, old).f1;
  for (int day = 1; day <= 2; ++day) {
    SCOPED_TRACE("day " + std::to_string(day));
    const Day today = drive(31, day);
    kept = updateMap(kept, today.scans, mapping(), {});
    const MapScore without = score(today, old), with = score(today, presentPoles(kept));
    RecordProperty("precision", std::to_string(with.precision));
    RecordProperty("recall", std::to_string(with.recall));
    EXPECT_GT(with.precision, without.precision + 0.03);
    EXPECT_GT(with.recall, without.recall + 0.03);
    EXPECT_GT(with.f1, asNew - 0.04);
  }
}
