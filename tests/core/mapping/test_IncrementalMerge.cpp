#include <gtest/gtest.h>

#include <cmath>

#include "core/mapping/IncrementalMerge.h"

namespace polemcl::test_incremental_merge {
namespace {

PoleDetection at(double x, double y) {
  PoleDetection pole;
  pole.x = x;
  pole.y = y;
  pole.radius = 0.1;
  pole.bottom = 0.5;
  pole.top = 3;
  return pole;
}

TEST(IncrementalMerge, FirstScanBecomesThePoles) {
  std::vector<MapPole> poles;
  mergeScan(poles, PoleIndex(poles), {at(1, 2), at(1.1, 2)}, 0.5);
  ASSERT_EQ(poles.size(), 2u);  // both of one scan: two poles, however near
  EXPECT_EQ(poles[0].x, 1);
  EXPECT_EQ(poles[1].x, 1.1);
  EXPECT_EQ(poles[0].count, 1u);
  EXPECT_EQ(poles[0].radius, 0.1);
}

TEST(IncrementalMerge, MeansOfManyScans) {
  std::vector<MapPole> poles;
  const double xs[] = {1.0, 1.2, 0.9, 1.05};
  double sum = 0;
  for (const double x : xs) {
    PoleDetection seen = at(x, 2 * x);
    seen.radius = x / 10;
    seen.confidence = x / 2;
    seen.bottom = x;
    seen.top = x + 1;
    seen.covariance = Eigen::Matrix2d::Identity() * 0.04;
    mergeScan(poles, PoleIndex(poles), {seen}, 0.5);
    sum += x;
  }
  ASSERT_EQ(poles.size(), 1u);
  EXPECT_EQ(poles[0].count, 4u);
  EXPECT_NEAR(poles[0].x, sum / 4, 1e-12);
  EXPECT_NEAR(poles[0].y, sum / 2, 1e-12);
  EXPECT_NEAR(poles[0].radius, sum / 40, 1e-12);
  EXPECT_NEAR(poles[0].confidence, sum / 8, 1e-12);
  EXPECT_EQ(poles[0].bottom, 0.9);
  EXPECT_EQ(poles[0].top, 2.2);
  EXPECT_NEAR(poles[0].covariance(0, 0), 0.01, 1e-12);  // 0.04 / 4
  EXPECT_NEAR(poles[0].covariance(0, 1), 0, 1e-12);
}

TEST(IncrementalMerge, OneDetectionPerPoleNearestFirst) {
  std::vector<MapPole> poles;
  mergeScan(poles, PoleIndex(poles), {at(0, 0)}, 0.5);
  mergeScan(poles, PoleIndex(poles), {at(0.4, 0), at(-0.1, 0)}, 0.5);
  ASSERT_EQ(poles.size(), 2u);
  EXPECT_NEAR(poles[0].x, -0.05, 1e-12);  // took the nearer one
  EXPECT_EQ(poles[0].count, 2u);
  EXPECT_EQ(poles[1].x, 0.4);
}

TEST(IncrementalMerge, TheGateIsOpen) {
  std::vector<MapPole> poles;
  mergeScan(poles, PoleIndex(poles), {at(0, 0)}, 0.5);
  mergeScan(poles, PoleIndex(poles), {at(0.5, 0)}, 0.5);
  EXPECT_EQ(poles.size(), 2u);
  mergeScan(poles, PoleIndex(poles), {at(0.25 - 1e-9, 0)}, 0.5);
  EXPECT_EQ(poles.size(), 2u);
  EXPECT_EQ(poles[0].count, 2u);
}

}  // namespace
}  // namespace polemcl::test_incremental_merge
