#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/mapping/BoxMerging.h"

namespace polemcl::test_box_merging {
namespace {

using Groups = std::vector<std::vector<std::uint32_t>>;

LandmarkObservation observation(double x, double y, double radius, std::uint32_t view = 0) {
  LandmarkObservation result;
  result.pole.x = x;
  result.pole.y = y;
  result.pole.radius = radius;
  result.scan = view;
  return result;
}

/// Components by spreading from each observation over all that overlap, without an index.
Groups spread(const std::vector<LandmarkObservation>& all) {
  const auto overlap = [&](std::size_t i, std::size_t j) {
    const PoleDetection &a = all[i].pole, &b = all[j].pole;
    const double reach = a.radius + b.radius;
    return std::abs(a.x - b.x) <= reach && std::abs(a.y - b.y) <= reach;
  };
  Groups groups;
  std::vector<bool> done(all.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    if (done[i]) continue;
    std::vector<std::uint32_t> group{i};
    done[i] = true;
    for (std::size_t k = 0; k < group.size(); ++k)
      for (std::uint32_t j = 0; j < all.size(); ++j)
        if (!done[j] && overlap(group[k], j)) {
          done[j] = true;
          group.push_back(j);
        }
    std::sort(group.begin(), group.end());
    groups.push_back(group);
  }
  return groups;
}

std::vector<LandmarkObservation> randomSightings(std::uint64_t seed, int count) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(-10, 10), radius(0.02, 0.4);
  std::vector<LandmarkObservation> all;
  for (int i = 0; i < count; ++i)
    all.push_back(observation(4e5 + place(random), 5e6 + place(random), radius(random)));
  return all;
}

TEST(BoxMerging, JoinsByHand) {
  // 0 and 1 overlap; 2 touches 1 by an edge; 3 shares only a corner with 2; 4 stands alone,
  // nearer to 0 than 0.5 m.
  const std::vector<LandmarkObservation> all{
      observation(0, 0, 0.25), observation(0.375, 0, 0.25), observation(0.875, 0, 0.25),
      observation(1.375, 0.5, 0.25), observation(-0.4375, 0, 0.125)};
  EXPECT_EQ(joinOverlappingBoxes(all), (Groups{{0, 1, 2, 3}, {4}}));
}

TEST(BoxMerging, BoxesAreSquaresRoundTheCentre) {
  // Circles of 0.1 m do not meet at a diagonal distance of 0.27 m, their boxes do.
  EXPECT_EQ(joinOverlappingBoxes({observation(0, 0, 0.1), observation(0.19, 0.19, 0.1)}).size(),
            1u);
  EXPECT_EQ(joinOverlappingBoxes({observation(0, 0, 0.1), observation(0.19, 0.21, 0.1)}).size(),
            2u);
}

TEST(BoxMerging, EqualsSpreadingOverAllPairs) {
  for (const int count : {0, 1, 2, 50, 400, 1500}) {
    const auto all = randomSightings(count, count);
    EXPECT_EQ(joinOverlappingBoxes(all), spread(all)) << count;
  }
  // With 400 in 20 m by 20 m neither one group nor one for each observation: the test says
  // something.
  const auto groups = joinOverlappingBoxes(randomSightings(400, 400)).size();
  EXPECT_GT(groups, 150u);
  EXPECT_LT(groups, 350u);
}

TEST(BoxMerging, PlainMeanByHand) {
  std::vector<LandmarkObservation> all{observation(1, 2, 0.1), observation(2, 4, 0.2),
                                       observation(6, 0, 0.6)};
  for (int i = 0; i < 3; ++i) {
    all[i].pole.bottom = i;
    all[i].pole.top = 3 + 2 * i;
    all[i].pole.confidence = 0.5 + 0.25 * i;
    all[i].pole.covariance = Eigen::Vector2d(0.09, 0.18).asDiagonal();
  }
  const MapPole mean = plainMean(all, {0, 1, 2});
  EXPECT_NEAR(mean.x, 3, 1e-12);
  EXPECT_NEAR(mean.y, 2, 1e-12);
  EXPECT_NEAR(mean.radius, 0.3, 1e-12);
  EXPECT_NEAR(mean.bottom, 1, 1e-12);
  EXPECT_NEAR(mean.top, 5, 1e-12);
  EXPECT_NEAR(mean.confidence, 0.75, 1e-12);
  EXPECT_NEAR(mean.covariance(0, 0), 0.03, 1e-12);
  EXPECT_NEAR(mean.covariance(1, 1), 0.06, 1e-12);
  EXPECT_EQ(mean.count, 3u);
  const MapPole pair = plainMean(all, {2, 0});
  EXPECT_NEAR(pair.x, 3.5, 1e-12);
  EXPECT_EQ(pair.count, 2u);
}

TEST(BoxMerging, TheMeanDoesNotDependOnTheOrder) {
  auto all = randomSightings(3, 60);
  std::vector<std::uint32_t> members(all.size());
  for (std::uint32_t i = 0; i < members.size(); ++i) members[i] = i;
  const MapPole before = plainMean(all, members);
  std::reverse(all.begin(), all.end());
  const MapPole after = plainMean(all, members);
  EXPECT_EQ(before.x, after.x);
  EXPECT_EQ(before.y, after.y);
  EXPECT_EQ(before.radius, after.radius);
  EXPECT_NEAR(before.x, 4e5, 10);
}

}  // namespace
}  // namespace polemcl::test_box_merging
