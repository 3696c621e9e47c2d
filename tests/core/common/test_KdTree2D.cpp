#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include <polemcl/core/common/Types.h>
#include "core/common/KdTree2D.h"

namespace polemcl::test_kd_tree2_d {
namespace {

std::vector<Eigen::Vector2d> randomPoints(std::mt19937_64& random, std::size_t count,
                                          double extent) {
  std::uniform_real_distribution<double> coordinate(-extent, extent);
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < count; ++i)
    points.emplace_back(coordinate(random), coordinate(random));
  return points;
}

/// Points of a grid: many exact duplicates and many queries at exactly the same distance of
/// several.
std::vector<Eigen::Vector2d> latticePoints(std::mt19937_64& random, std::size_t count) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < count; ++i)
    points.emplace_back(double(random() % 9), double(random() % 9));
  return points;
}

std::vector<PointHit> bruteWithin(const std::vector<Eigen::Vector2d>& points, double x, double y,
                                  double radius) {
  std::vector<PointHit> hits;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const double dx = x - points[i].x(), dy = y - points[i].y();
    if (dx * dx + dy * dy < radius * radius) hits.push_back({i, dx * dx + dy * dy});
  }
  return hits;
}

void expectEqualsBruteForce(const std::vector<Eigen::Vector2d>& points, double x, double y,
                            double radius) {
  const KdTree2D tree(points);
  const std::vector<PointHit> expected = bruteWithin(points, x, y, radius);
  std::vector<PointHit> found;
  tree.within(x, y, radius, found);
  ASSERT_EQ(found.size(), expected.size());
  PointHit best;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(found[i].index, expected[i].index);
    EXPECT_EQ(found[i].squaredDistance, expected[i].squaredDistance);
    if (!best || expected[i].squaredDistance < best.squaredDistance) best = expected[i];
  }
  const PointHit nearest = tree.nearest(x, y, radius);
  EXPECT_EQ(nearest.index, best.index);
  EXPECT_EQ(nearest.squaredDistance, best.squaredDistance);
}

TEST(KdTree2D, EqualsBruteForceOnRandomPoints) {
  std::mt19937_64 random(1);
  const auto points = randomPoints(random, 300, 20);
  for (int i = 0; i < 200; ++i) {
    const auto query = randomPoints(random, 1, 25).front();
    expectEqualsBruteForce(points, query.x(), query.y(), 0.1 + 0.05 * i);
  }
}

TEST(KdTree2D, EqualsBruteForceOnDuplicatesAndTies) {
  std::mt19937_64 random(2);
  const auto points = latticePoints(random, 400);
  for (int i = 0; i < 200; ++i) {
    const double x = 0.5 * (random() % 18), y = 0.5 * (random() % 18);
    expectEqualsBruteForce(points, x, y, 0.5 * (1 + random() % 6));
  }
}

TEST(KdTree2D, RadiusIsStrict) {
  const KdTree2D tree({{3, 4}});
  EXPECT_FALSE(tree.nearest(0, 0, 5));
  EXPECT_TRUE(tree.nearest(0, 0, std::nextafter(5.0, 6.0)));
}

TEST(KdTree2D, EndsASearchThatFindsTooMany) {
  std::mt19937_64 random(3);
  const auto points = randomPoints(random, 300, 20);
  const KdTree2D tree(points);
  const std::vector<PointHit> expected = bruteWithin(points, 1, 2, 10);
  ASSERT_GT(expected.size(), 30u);
  std::vector<PointHit> hits;
  EXPECT_TRUE(tree.withinUnlessMore(1, 2, 10, expected.size(), hits));
  EXPECT_EQ(hits.size(), expected.size());
  for (const std::size_t most : {expected.size() - 1, std::size_t{20}, std::size_t{0}}) {
    EXPECT_FALSE(tree.withinUnlessMore(1, 2, 10, most, hits));
    EXPECT_EQ(hits.size(), most + 1) << "it went on";
  }
}

TEST(KdTree2D, EmptyFindsNothing) {
  const KdTree2D tree({});
  std::vector<PointHit> hits(3);
  tree.within(0, 0, 10, hits);
  EXPECT_TRUE(hits.empty());
  EXPECT_FALSE(tree.nearest(0, 0, 10));
  EXPECT_EQ(tree.size(), 0u);
}

TEST(KdTree2D, QueryThatIsNotANumberFindsNothing) {
  const KdTree2D tree({{0, 0}});
  const double nan = std::nan("");
  EXPECT_FALSE(tree.nearest(nan, 0, 10));
  EXPECT_FALSE(tree.nearest(0, std::numeric_limits<double>::infinity(), 10));
  EXPECT_FALSE(tree.nearest(0, 0, nan));
  EXPECT_FALSE(tree.nearest(0, 0, -1));
}

TEST(KdTree2D, RefusesPointsThatAreNotFinite) {
  EXPECT_THROW(KdTree2D({{0, 0}, {std::nan(""), 1}}), Error);
  EXPECT_THROW(KdTree2D({{0, std::numeric_limits<double>::infinity()}}), Error);
}

}  // namespace
}  // namespace polemcl::test_kd_tree2_d
