#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/common/KdTree2D.h"
#include "core/common/PoleGrid.h"

namespace polemcl::test_pole_grid {
namespace {

double uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

void expectEqual(const PoleGrid& grid, const KdTree2D& oracle, double x, double y, double radius) {
  const PointHit expected = oracle.nearest(x, y, radius),
                 found = grid.nearest(x, y, radius * radius);
  ASSERT_EQ(found.index, expected.index) << x << ' ' << y << ' ' << radius;
  ASSERT_EQ(found.squaredDistance, expected.squaredDistance);
}

/// Points at random, their queries at random and at the borders of cells.
void compareOnRandomPoints(std::size_t count, double extent, double offset, double radius) {
  std::mt19937_64 random(count);
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.emplace_back(offset + uniform(random, 0, extent), offset + uniform(random, 0, extent));
  }
  const PoleGrid grid(points, radius);
  const KdTree2D oracle(points);
  for (int i = 0; i < 20000; ++i) {
    const double x = offset + uniform(random, -2 * radius, extent + 2 * radius);
    const double y = offset + uniform(random, -2 * radius, extent + 2 * radius);
    expectEqual(grid, oracle, x, y, i % 2 ? radius : uniform(random, 0, radius));
  }
  for (const Eigen::Vector2d& p : points) {
    for (int i = 0; i < 8; ++i) {  // as far as the radius reaches, in all directions
      const double angle = i * M_PI / 4, reach = radius * (1 - 1e-9);
      expectEqual(grid, oracle, p.x() + reach * std::cos(angle), p.y() + reach * std::sin(angle),
                  radius);
    }
  }
}

TEST(PoleGrid, EqualsTheTree) {
  compareOnRandomPoints(500, 200, -100, 1);     // sparse poles
  compareOnRandomPoints(3000, 20, 0, 1);        // crowded poles
  compareOnRandomPoints(60, 10, 3, 30);         // the radius spans the map
  compareOnRandomPoints(500, 100, 5.4e6, 0.5);  // far from the origin
  compareOnRandomPoints(100, 4e7, -2e7, 0.01);  // over a vast area
}

TEST(PoleGrid, TiesAndDuplicatesGoToTheLowerIndex) {
  std::mt19937_64 random(3);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 300; ++i) points.emplace_back(double(random() % 12), double(random() % 12));
  const PoleGrid grid(points, 1.5);
  const KdTree2D oracle(points);
  for (int i = 0; i < 27 * 4; ++i) {
    for (int j = 0; j < 27 * 4; ++j) expectEqual(grid, oracle, -1 + 0.125 * i, -1 + 0.125 * j, 1.5);
  }
}

TEST(PoleGrid, RadiusIsStrict) {
  const PoleGrid grid({{1, 0}}, 1);
  EXPECT_FALSE(grid.nearest(0, 0, 1));
  EXPECT_TRUE(grid.nearest(1e-15, 0, 1));
  EXPECT_TRUE(grid.nearest(0.5, 0, 1));
  EXPECT_FALSE(grid.nearest(0.5, 0, 0.25));
}

TEST(PoleGrid, EmptyAndAQueryThatIsNotANumberFindNothing) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(PoleGrid({}, 1).nearest(0, 0, 1));
  const PoleGrid grid({{0, 0}}, 1);
  EXPECT_FALSE(grid.nearest(nan, 0, 1));
  EXPECT_FALSE(grid.nearest(0, nan, 1));
  EXPECT_FALSE(grid.nearest(infinity, -infinity, 1));
}

TEST(PoleGrid, CandidatesOfARectangleHoldTheNearestOfEachPlaceInIt) {
  std::mt19937_64 random(11);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 400; ++i)
    points.emplace_back(uniform(random, 0, 100), uniform(random, 0, 100));
  const PoleGrid grid(points, 1);
  std::vector<PoleGrid::Place> candidates;
  int listed = 0, filled = 0;
  for (int i = 0; i < 3000; ++i) {
    const double lowX = uniform(random, -5, 105), lowY = uniform(random, -5, 105);
    const double width = uniform(random, 0, 10), height = uniform(random, 0, 10);
    if (!grid.candidatesIn(lowX, lowY, lowX + width, lowY + height, candidates)) continue;
    ++listed;
    filled += !candidates.empty();
    for (std::size_t k = 1; k < candidates.size(); ++k)
      ASSERT_LT(candidates[k - 1].index, candidates[k].index);
    for (int j = 0; j < 50; ++j) {
      const double x = lowX + width * (j < 2 ? j : uniform(random, 0, 1));
      const double y = lowY + height * (j < 2 ? j : uniform(random, 0, 1));
      const PoleGrid::Place* expected = grid.find(x, y, 1);
      double least = 1;
      std::uint32_t nearest = 400;
      for (const PoleGrid::Place& place : candidates) {
        const double squared = (place.x - x) * (place.x - x) + (place.y - y) * (place.y - y);
        if (squared < least) least = squared, nearest = place.index;
      }
      ASSERT_EQ(nearest, expected ? expected->index : 400u) << x << ' ' << y;
    }
  }
  EXPECT_GT(listed, 2000);
  EXPECT_GT(filled, 1000);
}

TEST(PoleGrid, CandidatesOfARectangleThatIsTooWideOrNoneAreNotListed) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 30; ++i) points.emplace_back(0.1 * i, 0);
  const PoleGrid grid(points, 1);
  std::vector<PoleGrid::Place> candidates;
  EXPECT_FALSE(grid.candidatesIn(0, 0, 3, 0, candidates));  // too many of them
  EXPECT_FALSE(grid.candidatesIn(std::nan(""), 0, 1, 1, candidates));
  EXPECT_FALSE(PoleGrid({{0, 0}, {1000, 1000}}, 1).candidatesIn(0, 0, 999, 999, candidates));
  EXPECT_TRUE(grid.candidatesIn(50, 50, 51, 51, candidates));  // beyond reach
  EXPECT_TRUE(candidates.empty());
  EXPECT_TRUE(PoleGrid({}, 1).candidatesIn(0, 0, 1, 1, candidates));
  EXPECT_TRUE(candidates.empty());
}

}  // namespace
}  // namespace polemcl::test_pole_grid
