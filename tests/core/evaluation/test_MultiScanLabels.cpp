#include <gtest/gtest.h>

#include <cmath>

#include "core/evaluation/MultiScanLabels.h"

namespace polemcl::test_multi_scan_labels {
namespace {

using Points = std::vector<Eigen::Vector3f>;

/// Points of a thing at (x, y) on flat ground, as a sensor at `sensor` sees them.
void ground(Points& points, double x, double y) {
  for (double u = -0.7; u <= 0.7; u += 0.1)
    for (double v = -0.7; v <= 0.7; v += 0.1)
      points.emplace_back(static_cast<float>(x + u), static_cast<float>(y + v), 0.02f);
}
void post(Points& points, const Eigen::Vector3d& sensor, double x, double y, double radius,
          double top, double lean = 0) {
  const double bearing = std::atan2(sensor.y() - y, sensor.x() - x);
  for (double z = 0.05; z < top; z += 0.07)
    for (double turn = -1.2; turn <= 1.2; turn += 0.3)
      points.emplace_back(static_cast<float>(x + lean * z + radius * std::cos(bearing + turn)),
                          static_cast<float>(y + radius * std::sin(bearing + turn)),
                          static_cast<float>(z));
}
void wall(Points& points, double x, double y, double top = 3) {
  for (double along = -3; along <= 3; along += 0.04)
    for (double z = 0.05; z < top; z += 0.07)
      points.emplace_back(static_cast<float>(x + along), static_cast<float>(y),
                          static_cast<float>(z));
}

/// A post of 3 by 3 voxels of 0.05 m at (10, 5), and a thin board that begins `gap` voxels beside
/// it.
void postAndBoard(Points& points, int gap, const Eigen::Vector2d& towards) {
  const Eigen::Vector2d across(-towards.y(), towards.x());
  const auto fill = [&](int u, int v) {
    const Eigen::Vector2d at = Eigen::Vector2d(10, 5) + 0.05 * (u * towards + v * across);
    for (double z = 0.05; z < 3; z += 0.07)
      points.emplace_back(static_cast<float>(at.x()), static_cast<float>(at.y()),
                          static_cast<float>(z));
  };
  for (int u = -1; u <= 1; ++u)
    for (int v = -1; v <= 1; ++v) fill(u, v);
  for (int u = 1 + gap; u <= 15; ++u) fill(u, 0);
}

/// Drives along x past the place (10, 5); `scene` gives the points that scan i has.
template <class Scene>
Standing judged(Scene scene, int scans = 12, float height = 0) {
  MultiScanLabels labels({{10, 5}});
  for (int i = 0; i < scans; ++i) {
    const Eigen::Vector3d sensor(20.0 * i / scans, 0, 1.7);
    Points points;
    ground(points, 10, 5);
    scene(points, sensor, i);
    for (Eigen::Vector3f& point : points) point.z() += height;
    labels.add(points, sensor + Eigen::Vector3d(0, 0, height), 0.2);
  }
  return labels.judge().front();
}

TEST(MultiScanLabels, AFreePostIsAPole) {
  EXPECT_EQ(judged([](Points& p, const auto& at, int) { post(p, at, 10, 5, 0.1, 4); }),
            Standing::pole);
  EXPECT_EQ(judged([](Points& p, const auto& at, int) { post(p, at, 10, 5, 0.3, 4); }),
            Standing::pole);  // a trunk
  EXPECT_EQ(judged([](Points& p, const auto& at, int) { post(p, at, 10, 5, 0.1, 4); }, 12, 600),
            Standing::pole);  // on a mountain
  EXPECT_EQ(judged([](Points& p, const auto& at, int) {
              post(p, at, 10, 5, 0.05, 4);
              post(p, at, 10.4, 5, 0.05, 4);
            }),
            Standing::pole);  // one of two
}

TEST(MultiScanLabels, APostOnAFenceIsAPoleAndAWallWithACornerIsUnsure) {
  EXPECT_EQ(judged([](Points& p, const auto& at, int) {
              post(p, at, 10, 5, 0.05, 4);
              wall(p, 10, 5, 1.1);
            }),
            Standing::pole);
  EXPECT_EQ(judged([](Points& p, const auto& at, int) {
              post(p, at, 10, 5, 0.05, 4);
              wall(p, 10, 5, 2);
            }),
            Standing::unsure);
}

TEST(MultiScanLabels, AThingNearerThanTwentyCentimetresBelongsToThePost) {
  for (const Eigen::Vector2d& towards : {Eigen::Vector2d(1, 0), Eigen::Vector2d(-1, 0),
                                         Eigen::Vector2d(0, 1), Eigen::Vector2d(0, -1)}) {
    SCOPED_TRACE(testing::Message() << towards.transpose());
    const auto with = [&](int gap) {
      return judged([&](Points& p, const auto&, int) { postAndBoard(p, gap, towards); });
    };
    EXPECT_EQ(with(4), Standing::pole);
    EXPECT_EQ(with(3), Standing::unsure);
  }
}

TEST(MultiScanLabels, AWallAndALowPostAreOthers) {
  EXPECT_EQ(judged([](Points& p, const auto&, int) { wall(p, 10, 5.1); }), Standing::other);
  EXPECT_EQ(judged([](Points& p, const auto& at, int) { post(p, at, 10, 5, 0.1, 1.0); }),
            Standing::other);
}

TEST(MultiScanLabels, WhatWasThereOnceIsOther) {
  EXPECT_EQ(judged([](Points& p, const auto& at, int i) {
              if (i == 5) post(p, at, 10, 5, 0.2, 1.8);
            }),
            Standing::other);
}

TEST(MultiScanLabels, FewSidesFewScansAndLeaningThingsAreUnsure) {
  EXPECT_EQ(judged([](Points& p, const auto& at, int) {
              post(p, at, 10 - 0.2 * 1.4, 5, 0.05, 2.6, 0.2);
            }),
            Standing::unsure);  // at half its height it stands at the place
  EXPECT_EQ(judged([](Points& p, const auto& at, int) { post(p, at, 10, 5, 0.1, 4); }, 2),
            Standing::unsure);
  MultiScanLabels fromOneSide({{10, 5}});
  for (int i = 0; i < 10; ++i) {
    Points points;
    ground(points, 10, 5);
    post(points, Eigen::Vector3d(0, 0, 1.7), 10, 5, 0.1, 4);
    fromOneSide.add(points, Eigen::Vector3d(0, 0, 1.7), 0.2);
  }
  EXPECT_EQ(fromOneSide.judge().front(), Standing::unsure);
}

}  // namespace
}  // namespace polemcl::test_multi_scan_labels
