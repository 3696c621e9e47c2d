#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/common/BipartiteMatching.h"

namespace polemcl::test_bipartite_matching {
namespace {

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
}  // namespace polemcl::test_bipartite_matching
