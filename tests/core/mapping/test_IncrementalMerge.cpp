#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "core/mapping/IncrementalMerge.h"
#include "support/Poles.h"

namespace polemcl::test_incremental_merge {

using namespace polemcl::tests;

namespace {

TEST(IncrementalMerge, FirstScanBecomesThePoles) {
  std::vector<MapPole> poles;
  IncrementalMerge merge(poles, 0.5);
  merge.insertScan(poles, {detectionAt(1, 2), detectionAt(1.1, 2)});
  ASSERT_EQ(poles.size(), 2u);  // both of one scan: two poles, however near
  EXPECT_EQ(poles[0].x, 1);
  EXPECT_EQ(poles[1].x, 1.1);
  EXPECT_EQ(poles[0].count, 1u);
  EXPECT_EQ(poles[0].radius, 0.1);
}

TEST(IncrementalMerge, MeansOfManyScans) {
  std::vector<MapPole> poles;
  IncrementalMerge merge(poles, 0.5);
  const double xs[] = {1.0, 1.2, 0.9, 1.05};
  double sum = 0;
  for (const double x : xs) {
    PoleDetection seen = detectionAt(x, 2 * x);
    seen.radius = x / 10;
    seen.confidence = x / 2;
    seen.bottom = x;
    seen.top = x + 1;
    seen.covariance = Eigen::Matrix2d::Identity() * 0.04;
    merge.insertScan(poles, {seen});
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
  IncrementalMerge merge(poles, 0.5);
  merge.insertScan(poles, {detectionAt(0, 0)});
  merge.insertScan(poles, {detectionAt(0.4, 0), detectionAt(-0.1, 0)});
  ASSERT_EQ(poles.size(), 2u);
  EXPECT_NEAR(poles[0].x, -0.05, 1e-12);  // took the nearer one
  EXPECT_EQ(poles[0].count, 2u);
  EXPECT_EQ(poles[1].x, 0.4);
}

TEST(IncrementalMerge, TheGateIsOpen) {
  std::vector<MapPole> poles;
  IncrementalMerge merge(poles, 0.5);
  merge.insertScan(poles, {detectionAt(0, 0)});
  merge.insertScan(poles, {detectionAt(0.5, 0)});
  EXPECT_EQ(poles.size(), 2u);
  merge.insertScan(poles, {detectionAt(0.25 - 1e-9, 0)});
  EXPECT_EQ(poles.size(), 2u);
  EXPECT_EQ(poles[0].count, 2u);
}

// The numbers of such cells are beyond all integers.
TEST(IncrementalMerge, FarPolesAndTinyDistances) {
  std::vector<MapPole> poles;
  IncrementalMerge merge(poles, 1e-12);
  for (int scan = 0; scan < 2; ++scan)
    merge.insertScan(poles, {detectionAt(9e8, -9e8), detectionAt(-9e8, 8e8)});
  ASSERT_EQ(poles.size(), 2u);
  EXPECT_EQ(poles[0].count, 2u);
  EXPECT_EQ(poles[1].count, 2u);
}

TEST(IncrementalMerge, CountsEndAtTheGreatestNumber) {
  std::vector<MapPole> poles(1);
  poles[0].count = std::numeric_limits<std::uint32_t>::max();
  IncrementalMerge(poles, 0.5).insertScan(poles, {detectionAt(0.1, 0)});
  ASSERT_EQ(poles.size(), 1u);
  EXPECT_EQ(poles[0].count, std::numeric_limits<std::uint32_t>::max());
  EXPECT_NEAR(poles[0].x, 0, 1e-9);
}

// Poles drift from cell to cell; a merge that begins with the poles of now is the oracle.
TEST(IncrementalMerge, FollowsPolesThatMove) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(-8, 8);
  std::vector<MapPole> poles;
  IncrementalMerge merge(poles, 0.5);
  for (int scan = 0; scan < 200; ++scan) {
    std::vector<PoleDetection> seen;
    for (int i = 0; i < 10; ++i) seen.push_back(detectionAt(anywhere(random), anywhere(random)));
    std::vector<MapPole> expected = poles;
    IncrementalMerge(expected, 0.5).insertScan(expected, seen);
    merge.insertScan(poles, seen);
    ASSERT_EQ(poles.size(), expected.size());
    for (std::size_t i = 0; i < poles.size(); ++i) {
      ASSERT_EQ(poles[i].x, expected[i].x) << scan;
      ASSERT_EQ(poles[i].count, expected[i].count) << scan;
    }
  }
  EXPECT_LT(poles.size(), 800u);
}

}  // namespace
}  // namespace polemcl::test_incremental_merge
