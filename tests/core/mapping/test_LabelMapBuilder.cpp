#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "core/mapping/LabelMapBuilder.h"

namespace polemcl::test_label_map_builder {
namespace {

constexpr std::uint32_t kTrunk = 71, kPole = 80, kSign = 81, kCar = 10;

/// Points with labels, gathered in the map frame, handed out as the scan of a LiDAR at a pose.
struct Scan {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::uint32_t> labels;

  void put(const Eigen::Vector3d& point, std::uint32_t label) {
    points.push_back(point);
    labels.push_back(label);
  }
  /// The side of an upright cylinder that faces the x axis, every 10 cm in height.
  void stem(double x, double y, double radius, double bottom, double top, std::uint32_t label) {
    for (double z = bottom; z <= top + 1e-9; z += 0.1)
      for (double turn = 0; turn <= M_PI; turn += M_PI / 8)
        put({x + radius * std::cos(turn), y - std::copysign(radius, y) * std::sin(turn), z}, label);
  }
  void addTo(LabelMapBuilder& map, const Eigen::Isometry3d& T_map_lidar) const {
    std::vector<float> x, y, z;
    for (const Eigen::Vector3d& point : points) {
      const Eigen::Vector3d p = T_map_lidar.inverse() * point;
      x.push_back(static_cast<float>(p.x()));
      y.push_back(static_cast<float>(p.y()));
      z.push_back(static_cast<float>(p.z()));
    }
    map.add(T_map_lidar, {x.data(), y.data(), z.data(), x.size()}, labels);
  }
};

Eigen::Isometry3d pose(double x, double yaw) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translate(Eigen::Vector3d(x, 0.5, 1.7));
  T.rotate(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  T.rotate(Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitX()));
  return T;
}

std::vector<MapPole> polesOf(const Scan& scan, int times, LabelMapOptions options = {}) {
  LabelMapBuilder map(options);
  for (int i = 0; i < times; ++i) scan.addTo(map, pose(0.5 * i, 0.3 * i));
  return map.poles();
}

TEST(LabelMapBuilder, PolesStandWhereTheirPointsAre) {
  Scan scan;
  scan.stem(10, 5, 0.1, 0, 4, kPole);
  scan.stem(4, -6, 0.2, 0.3, 3.3, kTrunk | 7u << 16);  // the upper half is an instance
  scan.stem(7, 3, 0.3, 0, 3, kCar);
  const auto poles = polesOf(scan, 5);
  ASSERT_EQ(poles.size(), 2u);
  EXPECT_NEAR(poles[0].x, 4, 0.03);
  EXPECT_NEAR(poles[0].y, -6, 0.2);  // only one side is seen
  EXPECT_GT(poles[0].y, -6.0);
  EXPECT_NEAR(poles[0].top, 3, 0.01);
  EXPECT_NEAR(poles[0].radius, 0.2, 0.1);
  EXPECT_EQ(poles[0].count, 5u);
  EXPECT_NEAR(poles[1].x, 10, 0.03);
  EXPECT_NEAR(poles[1].y, 5, 0.1);
}

TEST(LabelMapBuilder, ASignHangsOnItsPole) {
  Scan scan;
  scan.stem(10, 5, 0.05, 0, 2.5, kPole);
  for (double across = 0.1; across < 0.9; across += 0.05)
    for (double z = 2; z < 2.9; z += 0.1) scan.put({10 + across, 5, z}, kSign);
  for (double across = -0.4; across < 0.4; across += 0.05)
    for (double z = 2; z < 2.9; z += 0.1) scan.put({30 + across, 5, z}, kSign);
  const auto poles = polesOf(scan, 3);
  ASSERT_EQ(poles.size(), 2u);
  EXPECT_NEAR(poles[0].x, 10, 0.05);  // not drawn to the sign
  EXPECT_NEAR(poles[0].top, 2.9, 0.11);
  EXPECT_NEAR(poles[1].x, 30, 0.05);  // a sign by itself stands for its pole
}

TEST(LabelMapBuilder, NeighboursStayApart) {
  Scan scan;
  for (double x = 0; x < 6; x += 0.8) scan.stem(x, 5, 0.1, 0, 3, kTrunk);
  EXPECT_EQ(polesOf(scan, 3).size(), 8u);
  Scan hedge;  // one thing 4 m long: poles of at most 1.5 m
  for (double x = 0; x < 4; x += 0.1) hedge.stem(x, 5, 0.1, 0, 3, kTrunk);
  const auto poles = polesOf(hedge, 3);
  EXPECT_GE(poles.size(), 3u);
  for (std::size_t i = 1; i < poles.size(); ++i) EXPECT_GT(poles[i].x - poles[i - 1].x, 0.5);
}

TEST(LabelMapBuilder, LittleIsNoPole) {
  Scan scan;
  scan.stem(10, 5, 0.1, 0, 4, kPole);
  EXPECT_EQ(polesOf(scan, 2).size(), 0u);  // three scans are needed
  EXPECT_EQ(polesOf(scan, 3).size(), 1u);
  Scan low;
  low.stem(10, 5, 0.1, 0, 0.4, kPole);
  EXPECT_EQ(polesOf(low, 9).size(), 0u);
  Scan thin;
  for (double z = 0; z < 3; z += 0.6) thin.put({10, 5, z}, kPole);
  EXPECT_EQ(polesOf(thin, 3).size(), 0u);  // 15 points
  EXPECT_EQ(polesOf(thin, 4).size(), 1u);  // 20
  Scan far;
  far.stem(60, 5, 0.1, 0, 4, kPole);
  EXPECT_EQ(polesOf(far, 3).size(), 0u);
}

TEST(LabelMapBuilder, TheOrderOfPointsIsNobodysBusiness) {
  std::mt19937 random(2);
  Scan scan;
  for (int i = 0; i < 30; ++i)
    scan.stem(static_cast<double>(random() % 40), static_cast<double>(random() % 20) - 9.9, 0.15, 0,
              3, i % 2 ? kPole : kTrunk);
  Scan other = scan;
  std::reverse(other.points.begin(), other.points.end());
  std::reverse(other.labels.begin(), other.labels.end());
  const auto a = polesOf(scan, 3), b = polesOf(other, 3);
  ASSERT_EQ(a.size(), b.size());
  ASSERT_GT(a.size(), 15u);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(a[i].x, b[i].x, 1e-9);
    EXPECT_NEAR(a[i].y, b[i].y, 1e-9);
    EXPECT_EQ(a[i].count, b[i].count);
  }
}

TEST(LabelMapBuilder, KeepsColumnsNotPoints) {
  Scan scan;
  scan.stem(10, 5, 0.1, 0, 4, kPole);
  LabelMapBuilder map;
  for (int i = 0; i < 50; ++i) scan.addTo(map, pose(0, 0));
  EXPECT_EQ(map.points(), 50 * scan.points.size());
  EXPECT_EQ(map.scans(), 50u);
  EXPECT_LT(map.columns(), 12u);
}

TEST(LabelMapBuilder, RefusesWhatCannotBe) {
  LabelMapBuilder map;
  const float value = 1;
  EXPECT_THROW(map.add(pose(0, 0), {&value, &value, &value, 1}, {}), Error);
  EXPECT_THROW(map.add(pose(std::numeric_limits<double>::quiet_NaN(), 0), {}, {}), Error);
  EXPECT_THROW(map.add(pose(1e6, 0), {}, {}), Error);
  EXPECT_TRUE(map.poles().empty());
  const auto refused = [](auto change) {
    LabelMapOptions options;
    change(options);
    EXPECT_THROW(LabelMapBuilder{options}, Error);
  };
  refused([](auto& o) { o.stems = o.signs = {}; });
  refused([](auto& o) { o.cell = 0; });
  refused([](auto& o) { o.link = -1; });
  refused([](auto& o) { o.maxWidth = 0; });
  refused([](auto& o) { o.maxRange = 0; });
  refused([](auto& o) { o.minHeight = -1; });
  refused([](auto& o) { o.minScans = 0; });
  refused([](auto& o) { o.minPoints = 0; });
}

}  // namespace
}  // namespace polemcl::test_label_map_builder
