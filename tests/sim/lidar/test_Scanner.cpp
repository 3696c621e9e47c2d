#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include <polemcl/core/common/Types.h>
#include "sim/drive/Drive.h"
#include "sim/lidar/Scanner.h"

namespace polemcl::test_scanner {
namespace {

using namespace polemcl::sim;
using V = Eigen::Vector3d;

/// A flat empty place with the given objects; the road runs along x.
World emptyPlace(std::vector<WorldObject> objects) {
  WorldOptions options;
  options.relief = 0;
  const Street street(std::vector<Eigen::Vector2d>{{-60, 0}, {60, 0}});
  Terrain terrain(options, street, {});
  return World(options, street, terrain, std::move(objects), {});
}
WorldObject post(double x, double y, double radius, double height, std::uint32_t id) {
  ObjectBuilder builder(Kind::lampPost, Site{V(x, y, 0), 0});
  builder.post(V(0, 0, -0.2), V(0, 0, height), radius, radius, materials::kMetal);
  return builder.build(id);
}
Eigen::Isometry3d at(double x, double y, double z, double yaw = 0) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(yaw, V::UnitZ()).toRotationMatrix();
  pose.translation() = V(x, y, z);
  return pose;
}
/// Points of an object in the map frame.
std::vector<V> pointsOf(const SimulatedScan& scan, std::uint32_t id,
                        const Eigen::Isometry3d& pose) {
  std::vector<V> points;
  for (std::size_t i = 0; i < scan.size(); ++i)
    if (scan.label[i] == id) points.push_back(pose * V(scan.x[i], scan.y[i], scan.z[i]));
  return points;
}
TEST(Scanner, SameSeedGivesTheSameScan) {
  SimulationOptions options;
  options.world.length = 60;
  const World world = makeWorld(options.world);
  const Drive drive = makeDrive(world, options);
  const Scanner scanner(world, makeLidar("vlp16"));
  const SimulatedScan a = scanner.scan(drive.T_map_sensor[20], 5),
                      b = scanner.scan(drive.T_map_sensor[20], 5),
                      c = scanner.scan(drive.T_map_sensor[20], 6);
  EXPECT_GT(a.size(), 5000u);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.z, b.z);
  EXPECT_EQ(a.intensity, b.intensity);
  EXPECT_EQ(a.label, b.label);
  EXPECT_NE(a.x, c.x);
}

TEST(Scanner, PointsLieOnThePostWithinTheNoiseFromEveryHeading) {
  const World world = emptyPlace({post(8, 2, 0.15, 4, 3)});
  for (const char* name :
       {"hdl64e", "hdl32e", "vlp16", "os1_64", "os1_64_gen2", "os1_128", "os0_64"})
    for (const double yaw : {0.0, 2.0, 3.1}) {
      const LidarModel lidar = makeLidar(name);
      const Eigen::Isometry3d pose = at(0, 0, 1.5, yaw);
      const auto points = pointsOf(Scanner(world, lidar).scan(pose, 1), 3, pose);
      ASSERT_GT(points.size(), 25u) << name;
      double error = 0;
      std::size_t far = 0;  // merged with the ground behind the foot
      for (const V& point : points) {
        const double off = std::hypot(point.x() - 8, point.y() - 2) - 0.15;
        error += off;
        far += std::abs(off) > 0.08;
        EXPECT_LT(std::abs(off), lidar.pulseLength) << name;
        EXPECT_GT(point.z(), -0.1) << name;
        EXPECT_LT(point.z(), 4.1) << name;
      }
      EXPECT_LT(static_cast<double>(far), 0.04 * static_cast<double>(points.size())) << name;
      EXPECT_NEAR(error / static_cast<double>(points.size()), 0, 0.02) << name;
    }
}

TEST(Scanner, GroundLiesWhereItIs) {
  const World world = emptyPlace({});
  const LidarModel lidar = makeLidar("hdl32e");
  const SimulatedScan result = Scanner(world, lidar).scan(at(0, 0, 2), 1);
  double sum = 0, square = 0;
  std::size_t onRoad = 0;
  for (std::size_t i = 0; i < result.size(); ++i) {
    EXPECT_EQ(result.label[i], 0u);
    if (std::hypot(result.x[i], result.y[i]) > 6 || std::abs(result.y[i]) > 4.5) continue;
    sum += result.z[i] + 2;
    square += std::pow(result.z[i] + 2, 2);
    ++onRoad;
  }
  ASSERT_GT(onRoad, 5000u);
  EXPECT_NEAR(sum / static_cast<double>(onRoad), 0, 0.005);
  EXPECT_LT(std::sqrt(square / static_cast<double>(onRoad)), 0.02);
}

TEST(Scanner, RangeNoiseIsThatOfTheLidar) {
  ObjectBuilder builder(Kind::wall, Site{});
  Material smooth = materials::kPlaster;
  smooth.roughness = 0;
  builder.box(V(10.5, 0, 0), V(0.5, 5, 8), smooth);
  const World world = emptyPlace({builder.build(1)});
  LidarModel lidar = makeLidar("hdl32e");
  for (Beam& beam : lidar.beams) beam.rangeBias = beam.elevationError = 0;
  const SimulatedScan result = Scanner(world, lidar).scan(at(0, 0, 3), 1);
  double sum = 0, square = 0;
  int count = 0;
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (result.label[i] != 1 || std::abs(result.y[i]) > 2 || std::abs(result.z[i]) > 1.5) continue;
    const double range =
        std::sqrt(std::pow(result.x[i], 2) + std::pow(result.y[i], 2) + std::pow(result.z[i], 2));
    const double off = (result.x[i] - 10) * range / result.x[i];  // along the ray
    sum += off;
    square += off * off;
    ++count;
  }
  ASSERT_GT(count, 300);
  EXPECT_NEAR(sum / count, 0, 0.004);
  EXPECT_NEAR(std::sqrt(square / count), lidar.rangeNoise, 0.1 * lidar.rangeNoise);
}

TEST(Scanner, WhatStandsInFrontHidesWhatIsBehind) {
  ObjectBuilder builder(Kind::wall, Site{});
  builder.box(V(5, 0, 2), V(0.2, 3, 3), materials::kBrick);
  const World world =
      emptyPlace({builder.build(1), post(10, 0, 0.2, 4, 2), post(0, 10, 0.2, 4, 3)});
  const Eigen::Isometry3d pose = at(0, 0, 1.5);
  const SimulatedScan result = Scanner(world, makeLidar("hdl32e")).scan(pose, 1);
  EXPECT_GT(pointsOf(result, 1, pose).size(), 1000u);
  EXPECT_TRUE(pointsOf(result, 2, pose).empty());
  EXPECT_GT(pointsOf(result, 3, pose).size(), 30u);
}

TEST(Scanner, PartsOfAPulseMeltAtNearStepsOnly) {
  // The front of the post is at 11.85 m; the wall behind it at 12.6 m or 15 m.
  for (const double wall : {12.6, 15.0}) {
    ObjectBuilder builder(Kind::wall, Site{});
    builder.box(V(wall + 0.1, 0, 2), V(0.1, 6, 4), materials::kPlaster);
    const World world = emptyPlace({builder.build(1), post(11.9, 0, 0.05, 5, 2)});
    int between = 0;
    for (int turn = 0; turn < 8; ++turn) {  // so that rays hit the post at many places
      const Eigen::Isometry3d pose = at(0, 0, 2, 0.0101 * turn);
      const SimulatedScan result = Scanner(world, makeLidar("os1_64")).scan(pose, 1);
      for (const std::uint32_t id : {1u, 2u})
        for (const V& point : pointsOf(result, id, pose))
          between += point.z() > 0.5 && std::abs(point.y()) < 0.3 && point.x() > 11.94 &&
                     point.x() < wall - 0.06;
    }
    if (wall < 13)
      EXPECT_GT(between, 3);
    else
      EXPECT_EQ(between, 0);
  }
}

TEST(Scanner, PointsComeInFiringOrderWithinTheRangeOfTheLidar) {
  SimulationOptions options;
  options.world.length = 100;
  const World world = makeWorld(options.world);
  const Drive drive = makeDrive(world, options);
  const LidarModel lidar = makeLidar("hdl32e");
  const SimulatedScan result = Scanner(world, lidar).scan(drive.T_map_sensor[60], 2);
  std::set<std::uint32_t> ids{0};
  for (const WorldObject& object : world.objects()) ids.insert(object.id);
  double turned = 0;  // clockwise from the back, one turn
  for (std::size_t i = 0; i < result.size(); ++i) {
    const double range = V(result.x[i], result.y[i], result.z[i]).norm();
    ASSERT_GE(range, lidar.minRange - 1e-3);
    ASSERT_LE(range, lidar.maxRange + 1e-3);
    ASSERT_TRUE(ids.count(result.label[i] & ~kFoliageBit));
    ASSERT_GE(result.intensity[i], 0);
    ASSERT_LE(result.intensity[i], 1);
    const double azimuth = M_PI - std::atan2(result.y[i], result.x[i]);
    const bool seam = azimuth < 0.1 || azimuth > 2 * M_PI - 0.1;
    if (i > 0 && !seam) {
      ASSERT_GT(azimuth, turned - 0.01);
    }
    turned = azimuth;
  }
}

TEST(Scanner, AHangingSensorSeesTheOtherElevations) {
  const World world = emptyPlace({post(5, 0, 0.2, 6, 1)});
  const Eigen::Isometry3d pose = at(0, 0, 1.5);
  double upright = 0, hanging = 0;
  for (const V& point : pointsOf(Scanner(world, makeLidar("hdl32e")).scan(pose, 1), 1, pose))
    upright = std::max(upright, point.z());
  for (const V& point : pointsOf(Scanner(world, makeLidar("hdl32e", true)).scan(pose, 1), 1, pose))
    hanging = std::max(hanging, point.z());
  EXPECT_NEAR(upright, 1.5 + 4.8 * std::tan(10.67 * M_PI / 180), 0.1);
  EXPECT_NEAR(hanging, 1.5 + 4.8 * std::tan(30.67 * M_PI / 180), 0.15);
}

TEST(Scanner, MotionShiftsPointsByTheWayOfTheSensorWithinTheTurn) {
  // Clockwise from the back: azimuth a is fired (pi - a) / 2 pi - 1/2 revolutions after the middle.
  // Left: a quarter of a revolution before it.
  const World world = emptyPlace({post(0, 8, 0.1, 4, 1), post(8, 0, 0.1, 4, 2)});
  const Eigen::Isometry3d pose = at(0, 0, 1.5);
  Motion motion;
  motion.velocity = V(10, 0, 0);
  const SimulatedScan result = Scanner(world, makeLidar("hdl32e")).scan(pose, 1, motion);
  const auto meanX = [&](std::uint32_t id) {
    double sum = 0;
    const auto points = pointsOf(result, id, pose);
    for (const V& point : points) sum += point.x() / static_cast<double>(points.size());
    return sum;
  };
  EXPECT_NEAR(meanX(1), 0.25, 0.02) << "the sensor was 0.25 m behind";
  EXPECT_NEAR(meanX(2), 7.9, 0.03) << "fired in the middle of the turn";
}

}  // namespace
}  // namespace polemcl::test_scanner
