#include <gtest/gtest.h>

#include <cmath>

#include <polemcl/core/common/Types.h>
#include "core/common/GreedyAssignment.h"

namespace polemcl::test_greedy_assignment {

TEST(GreedyAssignment, TakesTheClosestPairFirst) {
  // The second of `a` is nearer to the only point of `b`; the first gets nothing.
  const auto pairs = greedyAssignment({{0, 0}, {0.5, 0}}, {{0.4, 0}}, 1);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].first, 1u);
  EXPECT_EQ(pairs[0].second, 0u);
  EXPECT_NEAR(pairs[0].distance, 0.1, 1e-12);
}

TEST(GreedyAssignment, GivesUpMorePairsForACloserOne) {
  // Two pairs would be possible (0-0, 1-1); the closest, 1-0, leaves the others 1.1 m apart.
  const auto pairs = greedyAssignment({{-0.5, 0}, {0.1, 0}}, {{0, 0}, {0.6, 0}}, 0.8);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].first, 1u);
  EXPECT_EQ(pairs[0].second, 0u);
}

TEST(GreedyAssignment, TheRadiusIsInclusiveAndOrderIsByFirst) {
  const auto pairs = greedyAssignment({{10, 0}, {0, 0}}, {{0.5, 0}, {10, 0.25}}, 0.5);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].first, 0u);
  EXPECT_EQ(pairs[0].second, 1u);
  EXPECT_EQ(pairs[1].first, 1u);
  EXPECT_EQ(pairs[1].second, 0u);
  EXPECT_TRUE(greedyAssignment({{0, 0}}, {{0.5001, 0}}, 0.5).empty());
}

TEST(GreedyAssignment, EqualDistancesGoToTheLowerIndex) {
  const auto pairs = greedyAssignment({{0, 0}}, {{0.25, 0}, {-0.25, 0}}, 1);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].second, 0u);
}

TEST(GreedyAssignment, CandidatesKeepTheirContentAndTheirOwnOrder) {
  struct Labelled : AssignedPair {
    char label;
    bool operator<(const Labelled& other) const { return label < other.label; }
  };
  const auto chosen = chooseClosest<Labelled>(
      {{{7, 2, 1}, 'c'}, {{3, 2, 9}, 'b'}, {{3, 5, 1}, 'd'}, {{7, 5, 4}, 'e'}});
  ASSERT_EQ(chosen.size(), 2u);
  EXPECT_EQ(chosen[0].label, 'b');
  EXPECT_EQ(chosen[1].label, 'e');
}

TEST(GreedyAssignment, RefusesWhatMakesNoSense) {
  EXPECT_THROW(greedyAssignment({{0, 0}}, {{0, 0}}, 0), Error);
  EXPECT_THROW(greedyAssignment({{0, 0}}, {{0, 0}}, NAN), Error);
  EXPECT_THROW(greedyAssignment({{NAN, 0}}, {{0, 0}}, 1), Error);
  EXPECT_THROW(greedyAssignment({{0, 0}}, {{0, INFINITY}}, 1), Error);
  EXPECT_TRUE(greedyAssignment({}, {}, 1).empty());
}

}  // namespace polemcl::test_greedy_assignment
