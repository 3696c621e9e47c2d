#include <gtest/gtest.h>

#include "sim/common/Random.h"

namespace polemcl::test_random {

using namespace polemcl::sim;

TEST(Random, IsSplitMix64) {
  // First outputs for seed 0 and 1234567, as published with the reference implementation.
  Random zero(0);
  EXPECT_EQ(zero.next(), 0xe220a8397b1dcdafull);
  EXPECT_EQ(zero.next(), 0x6e789e6aa1b965f4ull);
  Random other(1234567);
  EXPECT_EQ(other.next(), 6457827717110365317ull);
  EXPECT_EQ(other.next(), 3203168211198807973ull);
}

TEST(Random, UniformStaysInsideAndHasTheRightMoments) {
  Random random(3);
  double sum = 0, square = 0;
  constexpr int kCount = 200000;
  for (int i = 0; i < kCount; ++i) {
    const double value = random.uniform(2, 5);
    ASSERT_GE(value, 2);
    ASSERT_LT(value, 5);
    sum += value;
    square += value * value;
  }
  const double mean = sum / kCount;
  EXPECT_NEAR(mean, 3.5, 0.01);
  EXPECT_NEAR(square / kCount - mean * mean, 9.0 / 12, 0.01);
}

TEST(Random, NormalHasMeanVarianceAndTails) {
  Random random(4);
  double sum = 0, square = 0;
  int beyondTwo = 0;
  constexpr int kCount = 200000;
  for (int i = 0; i < kCount; ++i) {
    const double value = random.normal();
    sum += value;
    square += value * value;
    beyondTwo += std::abs(value) > 2;
  }
  EXPECT_NEAR(sum / kCount, 0, 0.01);
  EXPECT_NEAR(square / kCount, 1, 0.015);
  EXPECT_NEAR(static_cast<double>(beyondTwo) / kCount, 0.0455, 0.002);
}

TEST(Random, BelowReachesEveryNumberAndNoOther) {
  Random random(5);
  int seen[7] = {};
  for (int i = 0; i < 7000; ++i) {
    const int value = random.below(7);
    ASSERT_GE(value, 0);
    ASSERT_LT(value, 7);
    ++seen[value];
  }
  for (const int count : seen) EXPECT_NEAR(count, 1000, 150);
}

TEST(Random, HashOfAListDependsOnTheOrder) {
  EXPECT_NE(hash(1, 2), hash(2, 1));
  EXPECT_NE(hash(1, 2, 3), hash(1, 2));
  EXPECT_EQ(hash(1, 2, 3), hash(1, 2, 3));
}

TEST(NormalDistribution, FromHashesHasItsMomentsAndTails) {
  double sum = 0, square = 0, tail = 0;
  constexpr int kDraws = 200000;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const double z = normalFromHash(hash(i));
    sum += z;
    square += z * z;
    tail += z > 2;
  }
  EXPECT_NEAR(sum / kDraws, 0, 0.01);
  EXPECT_NEAR(square / kDraws, 1, 0.01);
  EXPECT_NEAR(tail / kDraws, 0.02275, 0.0015);
}

}  // namespace polemcl::test_random
