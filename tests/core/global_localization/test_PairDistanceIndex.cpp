#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "core/global_localization/PreparedMap.h"
#include "sim/common/Random.h"

namespace polemcl::test_pair_distance_index {
namespace {

std::vector<Eigen::Vector2d> scatter(std::uint64_t seed, int count, double extent) {
  sim::Random random(seed);
  std::vector<Eigen::Vector2d> poles;
  for (int i = 0; i < count; ++i)
    poles.emplace_back(random.uniform(0, extent), random.uniform(0, extent));
  return poles;
}

using Names = std::set<std::pair<std::uint32_t, std::uint32_t>>;

Names namesOf(PairDistanceIndex::Range range) {
  Names names;
  for (const PairDistanceIndex::Pair* p = range.begin; p != range.end; ++p)
    names.insert({p->first, p->second});
  return names;
}

TEST(PairDistanceIndex, HoldsEveryPairWithinTheBoundsOnce) {
  const std::vector<Eigen::Vector2d> poles = scatter(1, 200, 200);
  const PairDistanceIndex pairs(poles, 8, 40, 200);
  for (const auto& [low, high] : {std::pair{0.0, 100.0}, {8.0, 12.0}, {20.0, 20.5}, {39.0, 60.0}}) {
    Names expected;
    for (std::uint32_t i = 0; i < poles.size(); ++i)
      for (std::uint32_t j = i + 1; j < poles.size(); ++j) {
        const double d = (poles[i] - poles[j]).norm();
        if (d >= std::max(8.0, low) && d <= std::min(40.0, high)) expected.insert({i, j});
      }
    const PairDistanceIndex::Range range = pairs.between(low, high);
    EXPECT_EQ(namesOf(range), expected) << low << " to " << high;
    EXPECT_EQ(range.size(), expected.size());
  }
}

TEST(PairDistanceIndex, SortsByDistance) {
  const std::vector<Eigen::Vector2d> poles = scatter(2, 100, 100);
  const PairDistanceIndex pairs(poles, 8, 40);
  const PairDistanceIndex::Range all = pairs.between(0, 1000);
  ASSERT_GT(all.size(), 100u);
  EXPECT_TRUE(std::is_sorted(all.begin, all.end,
                             [](const auto& a, const auto& b) { return a.distance < b.distance; }));
  for (const PairDistanceIndex::Pair* p = all.begin; p != all.end; ++p)
    EXPECT_NEAR(p->distance, (poles[p->first] - poles[p->second]).norm(), 1e-5);
}

TEST(PairDistanceIndex, FindsNothingOutsideOrBetweenCrossedBounds) {
  const PairDistanceIndex pairs({{0, 0}, {20, 0}}, 8, 40);
  EXPECT_EQ(pairs.between(19.9, 20.1).size(), 1u);
  EXPECT_EQ(pairs.between(0, 19.9).size(), 0u);
  EXPECT_EQ(pairs.between(20.1, 90).size(), 0u);
  EXPECT_EQ(pairs.between(20.1, 19.9).size(), 0u);
  const PairDistanceIndex none({}, 8, 40);
  EXPECT_EQ(none.between(0, 100).size(), 0u);
}

/// A park must not blow up the memory, nor lose its far pairs.
TEST(PairDistanceIndex, KeepsAShareOfEveryDistanceInACrowd) {
  const std::vector<Eigen::Vector2d> poles = scatter(3, 1500, 60);
  const PairDistanceIndex pairs(poles, 8, 40, 20);
  EXPECT_LE(pairs.size(), 1500u * 20u);
  for (double low = 8; low < 40; low += 4)
    EXPECT_GT(pairs.between(low, low + 4).size(), 500u) << low;
}

/// A broken map: that each pole looks at all others would take minutes.
TEST(PairDistanceIndex, LooksAtFewOfTensOfThousandsInReach) {
  const std::vector<Eigen::Vector2d> poles = scatter(4, 20000, 30);
  const PairDistanceIndex pairs(poles, 8, 40);
  EXPECT_LE(pairs.size(), 20000u * 48u);
  for (double low = 8; low < 32; low += 4)
    EXPECT_GT(pairs.between(low, low + 4).size(), 10000u) << low;
  // A pole asks for 48 partners; only those that are looked at are asked for.
  std::vector<int> count(poles.size());
  const PairDistanceIndex::Range all = pairs.between(0, 40);
  for (const PairDistanceIndex::Pair* p = all.begin; p != all.end; ++p)
    ++count[p->first], ++count[p->second];
  EXPECT_LE(std::count_if(count.begin(), count.end(), [](int n) { return n > 48; }), 144)
      << "12 by 12 cells of 2.5 m";
}

/// Beside a crowd, no pole loses its pairs with the rest; in it, all are too near to each other.
TEST(PairDistanceIndex, ACrowdInOnePlaceHasPairsWithWhatIsFarther) {
  std::vector<Eigen::Vector2d> poles = scatter(5, 5000, 2e-5);
  poles.emplace_back(20, 0);
  const PairDistanceIndex pairs(poles, 8, 40);
  EXPECT_EQ(pairs.size(), 5000u);
}

}  // namespace
}  // namespace polemcl::test_pair_distance_index
