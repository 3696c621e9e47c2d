// Scores of maps by hand; the shift and the turn of a whole map; matching against all choices.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <polemcl/core/common/Types.h>
#include "core/evaluation/MapEvaluation.h"

namespace polemcl::test_map_evaluation {
namespace {

using Points = std::vector<Eigen::Vector2d>;
using Edges = std::vector<std::vector<std::uint32_t>>;

/// Tries every choice for every left node; the right nodes taken so far are bits of `taken`.
std::size_t brute(const Edges& edges, std::size_t left, std::uint32_t taken) {
  if (left == edges.size()) return 0;
  std::size_t best = brute(edges, left + 1, taken);
  for (const std::uint32_t right : edges[left]) {
    if (!(taken >> right & 1))
      best = std::max(best, 1 + brute(edges, left + 1, taken | 1u << right));
  }
  return best;
}

TEST(Evaluation, MapScoreByHand) {
  // Two poles of the map at the first true pole, none at the second, one far from all.
  const Points truth{{0, 0}, {10, 0}}, map{{0.5, 0}, {-0.5, 0}, {20, 0}};
  const MapScore authors = scoreMap(truth, map, 1, false);
  EXPECT_EQ(authors.matches, 2u);
  EXPECT_EQ(authors.mapPoles, 3u);
  EXPECT_EQ(authors.truthPoles, 2u);
  EXPECT_NEAR(authors.precision, 2.0 / 3, 1e-12);
  EXPECT_NEAR(authors.recall, 1, 1e-12);
  EXPECT_NEAR(authors.f1, 0.8, 1e-12);
  const MapScore oneToOne = scoreMap(truth, map, 1, true);
  EXPECT_EQ(oneToOne.matches, 1u);
  EXPECT_NEAR(oneToOne.precision, 1.0 / 3, 1e-12);
  EXPECT_NEAR(oneToOne.recall, 0.5, 1e-12);
  EXPECT_NEAR(oneToOne.f1, 0.4, 1e-12);
  EXPECT_EQ(scoreMap(map, truth, 1, true).matches, 1u);
  EXPECT_EQ(scoreMap(map, truth, 1, false).matches, 1u);
  Points street;  // far more true poles than map poles, the last of them matched
  for (int i = 0; i < 1000; ++i) street.emplace_back(10 * i, 0);
  EXPECT_EQ(scoreMap(street, {{9990, 0}}, 1, true).matches, 1u);
}

TEST(Evaluation, TheAuthorsRecallCanExceedOne) {
  EXPECT_NEAR(scoreMap({{0, 0}}, {{0, 0.1}, {0, 0.2}, {0, 0.3}}, 1, false).recall, 3, 1e-12);
}

TEST(Evaluation, TheRadiusIsInclusive) {
  EXPECT_EQ(scoreMap({{0, 0}}, {{3, 4}}, 5, false).matches, 1u);
  EXPECT_EQ(scoreMap({{0, 0}}, {{3, 4}}, std::nextafter(5.0, 0.0), false).matches, 0u);
}

TEST(Evaluation, NoMatchesScoreZero) {
  const MapScore score = scoreMap({{0, 0}}, {{9, 9}}, 1, true);
  EXPECT_EQ(score.matches, 0u);
  EXPECT_EQ(score.f1, 0);
}

TEST(Evaluation, MapScoreRefusesWhatCannotBeScored) {
  const Points one{{0, 0}}, bad{{std::nan(""), 0}};
  for (const bool oneToOne : {false, true})
    for (const auto& [truth, map] : {std::pair{Points(), one}, {one, {}}, {bad, one}, {one, bad}})
      EXPECT_THROW(scoreMap(truth, map, 1, oneToOne), Error);
  for (double radius : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(scoreMap(one, one, radius, false), Error) << radius;
}

TEST(MapShift, FindsTheMotionOfAMap) {
  const std::vector<Eigen::Vector2d> truth{{0, 0}, {10, 2}, {20, -3}, {35, 1}};
  const Eigen::Vector2d centre = (truth[0] + truth[1] + truth[2] + truth[3]) / 4;
  std::vector<Eigen::Vector2d> map;
  for (const Eigen::Vector2d& pole : truth)
    map.push_back(Eigen::Rotation2Dd(0.01) * (pole - centre) + centre +
                  Eigen::Vector2d(0.1, -0.05));
  map.emplace_back(60, 60);  // false
  const MapShift moved = mapShift(truth, map, 0.5);
  EXPECT_EQ(moved.pairs, 4u);
  EXPECT_NEAR(moved.shift.x(), 0.1, 1e-12);
  EXPECT_NEAR(moved.shift.y(), -0.05, 1e-12);
  EXPECT_NEAR(moved.rotation, 0.01, 1e-12);
  EXPECT_EQ(mapShift(truth, {{100, 0}}, 0.5).pairs, 0u);
  EXPECT_EQ(mapShift(truth, {{0.1, 0}}, 0.5).rotation, 0);
}

TEST(BipartiteMatching, EqualsTryingAllChoices) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 300; ++i) {
    const std::size_t rightCount = 1 + random() % 7;
    Edges edges(random() % 8);
    for (auto& list : edges) {
      for (std::uint32_t right = 0; right < rightCount; ++right) {
        if (random() % 100 < static_cast<unsigned>(10 + i % 60)) list.push_back(right);
      }
      std::shuffle(list.begin(), list.end(), random);
    }
    ASSERT_EQ(maximumMatching(edges, rightCount), brute(edges, 0, 0)) << i;
  }
}

TEST(BipartiteMatching, GivesUpAGreedyChoice) {
  EXPECT_EQ(maximumMatching({{0, 1}, {0}}, 2), 2u);
}

// The third moves the first, and the fourth then moves the third and the second.
TEST(BipartiteMatching, MovesEveryPairOfAPath) {
  EXPECT_EQ(maximumMatching({{0, 1}, {2, 3}, {0, 2}, {0}}, 4), 4u);
}

TEST(BipartiteMatching, FollowsAPathAsLongAsTheGraph) {
  const std::uint32_t size = 200000;
  Edges chain(size);
  for (std::uint32_t left = 0; left < size; ++left) {
    if (left + 1 < size) chain[left].push_back(left + 1);
    chain[left].push_back(left);
  }
  EXPECT_EQ(maximumMatching(chain, size), size) << "the last one moves all others";
  std::reverse(chain.begin(), chain.end());
  EXPECT_EQ(maximumMatching(chain, size), size);
}

TEST(BipartiteMatching, NothingToMatch) {
  EXPECT_EQ(maximumMatching({}, 0), 0u);
  EXPECT_EQ(maximumMatching({{}, {}}, 3), 0u);
}

}  // namespace
}  // namespace polemcl::test_map_evaluation
