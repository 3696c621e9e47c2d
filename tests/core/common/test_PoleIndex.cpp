#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/common/PoleIndex.h"
#include "support/Poles.h"
#include "support/Refusal.h"

namespace polemcl::test_pole_index {
namespace {

using namespace polemcl::tests;

std::vector<MapPole> randomPoles(std::mt19937_64& random, std::size_t count, double extent) {
  std::uniform_real_distribution<double> coordinate(-extent, extent);
  std::vector<MapPole> poles;
  for (std::size_t i = 0; i < count; ++i)
    poles.push_back(mapPoleAt(coordinate(random), coordinate(random)));
  return poles;
}

/// All poles nearer than the radius, by distance then index.
std::vector<PoleIndex::Neighbour> brute(const std::vector<MapPole>& poles, double x, double y,
                                        double radius) {
  std::vector<PoleIndex::Neighbour> found;
  for (std::size_t i = 0; i < poles.size(); ++i) {
    const double distance = std::hypot(poles[i].x - x, poles[i].y - y);
    if (distance < radius) found.push_back({i, distance});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.distance < b.distance; });
  return found;
}

TEST(PoleIndex, EqualsBruteForceInsideAndBeyondThePreparedRadius) {
  std::mt19937_64 random(11);
  const auto poles = randomPoles(random, 400, 30);
  const PoleIndex index(poles, 2.0);
  std::uniform_real_distribution<double> coordinate(-35, 35);
  int found = 0;
  for (int i = 0; i < 2000; ++i) {
    const double x = coordinate(random), y = coordinate(random), radius = 0.005 * i;
    const auto expected = brute(poles, x, y, radius);
    const auto nearest = index.nearest(x, y, radius);
    ASSERT_EQ(nearest.has_value(), !expected.empty());
    if (nearest) {
      ++found;
      EXPECT_EQ(nearest->index, expected[0].index);
      EXPECT_DOUBLE_EQ(nearest->distance, expected[0].distance);
    }
    const auto within = index.within(x, y, radius);
    ASSERT_EQ(within.size(), expected.size());
    for (std::size_t k = 0; k < within.size(); ++k) EXPECT_EQ(within[k].index, expected[k].index);
  }
  EXPECT_GT(found, 1000);
}

TEST(PoleIndex, OfEqualsTheLowerIndex) {
  const std::vector<MapPole> poles{mapPoleAt(9, 9), mapPoleAt(1, 0), mapPoleAt(-1, 0),
                                   mapPoleAt(1, 0), mapPoleAt(0, 1)};
  for (double prepared : {0.5, 2.0}) {  // by the tree, by the grid
    const PoleIndex index(poles, prepared);
    EXPECT_EQ(index.nearest(0, 0, 1.5)->index, 1u);
    EXPECT_EQ(index.nearest(1, 0, 1.5)->index, 1u);
    const auto within = index.within(0, 0, 1.5);
    ASSERT_EQ(within.size(), 4u);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(within[k].index, k + 1);
  }
}

TEST(PoleIndex, DistanceMustBeLessThanTheRadius) {
  for (double prepared : {1.0, 10.0}) {
    const PoleIndex index({mapPoleAt(3, 4)}, prepared);
    EXPECT_FALSE(index.nearest(0, 0, 5).has_value());
    EXPECT_DOUBLE_EQ(index.nearest(0, 0, 5.001)->distance, 5);
    EXPECT_FALSE(index.nearest(3, 4, 0).has_value());
    EXPECT_EQ(index.nearest(3, 4, 1e-9)->distance, 0);
    EXPECT_TRUE(index.within(0, 0, 5).empty());
  }
}

// The cells of such a grid would have numbers beyond all integers.
TEST(PoleIndex, AnyRadiusMayBePrepared) {
  for (const double prepared : {1e-310, 1e-200, 1e-20})
    for (const double x : {0.0, 100.0}) {
      const PoleIndex index({mapPoleAt(x, 0)}, prepared);
      EXPECT_EQ(index.nearest(x, 0, prepared).has_value(), prepared * prepared > 0) << prepared;
      EXPECT_TRUE(index.nearest(x, 0, 0.5)) << prepared;
      EXPECT_FALSE(index.nearest(x + 1, 0, 0.5)) << prepared;
    }
}

TEST(PoleIndex, EmptyMapFindsNothing) {
  const PoleIndex index({});
  EXPECT_EQ(index.size(), 0u);
  EXPECT_FALSE(index.nearest(0, 0, 1).has_value());
  EXPECT_FALSE(index.nearest(0, 0, 100).has_value());
  EXPECT_TRUE(index.within(0, 0, 100).empty());
}

TEST(PoleIndex, VarianceIsTheMeanOverTheAxes) {
  MapPole pole = mapPoleAt(0, 0);
  pole.covariance << 0.04, 0.01, 0.01, 0.02;
  EXPECT_DOUBLE_EQ(PoleIndex({pole}).variance(0), 0.03);
}

TEST(PoleIndex, RefusesAPoleThatIsNotFinite) {
  EXPECT_THROW(PoleIndex({mapPoleAt(0, 0), mapPoleAt(std::nan(""), 0)}), Error);
  MapPole pole = mapPoleAt(0, 0);
  pole.covariance(0, 1) = std::nan("");
  EXPECT_THROW(PoleIndex({pole}), Error);
}

TEST(PoleIndex, RefusesAPoleOutOfThisWorld) {
  MapPole pole;
  pole.y = -1.01e9;
  EXPECT_REFUSED(PoleIndex({MapPole(), pole}), "pole 1", "1e+09");
  pole.y = -0.99e9;
  EXPECT_NO_THROW(PoleIndex({MapPole(), pole}));
}

TEST(PoleIndex, RefusesARadiusThatIsNotPositive) {
  EXPECT_THROW(PoleIndex({mapPoleAt(0, 0)}, 0), Error);
  EXPECT_THROW(PoleIndex({mapPoleAt(0, 0)}, std::nan("")), Error);
}

}  // namespace
}  // namespace polemcl::test_pole_index
