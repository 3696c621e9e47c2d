#include <gtest/gtest.h>

#include <numeric>

#include "core/localization/KldSampleSize.h"

namespace polemcl::test_kld_sample_size {
namespace {

KldOptions wide() {
  KldOptions options;
  options.minParticles = 1;
  options.maxParticles = 1000000;
  return options;
}

TEST(KldSampleSize, IsTheQuantileOfChiSquareOverTwiceEpsilon) {
  struct Row {
    std::size_t bins;
    double quantile;
  };
  // Tables of chi-square, 0.99 and 0.95; Wilson and Hilferty are 0.8 % off at worst.
  for (const Row& row :
       {Row{2, 6.635}, Row{3, 9.210}, Row{11, 23.209}, Row{31, 50.892}, Row{101, 135.807}}) {
    EXPECT_NEAR(kldSampleSize(row.bins, wide()) / (row.quantile / 0.1), 1, 0.015) << row.bins;
  }
  KldOptions other = wide();
  other.delta = 0.05;
  other.epsilon = 0.01;
  for (const Row& row : {Row{2, 3.841}, Row{11, 18.307}, Row{101, 124.342}})
    EXPECT_NEAR(kldSampleSize(row.bins, other) / (row.quantile / 0.02), 1, 0.03) << row.bins;
}

TEST(KldSampleSize, StaysWithinTheLimitsAndGrows) {
  const KldOptions options;
  EXPECT_EQ(kldSampleSize(0, options), 200u);
  EXPECT_EQ(kldSampleSize(1, options), 200u);
  EXPECT_EQ(kldSampleSize(2, options), 200u);
  EXPECT_EQ(kldSampleSize(100000, options), 10000u);
  std::size_t before = 0;
  for (std::size_t bins = 0; bins < 2000; bins += 7) {
    EXPECT_GE(kldSampleSize(bins, options), before);
    before = kldSampleSize(bins, options);
  }
}

TEST(KldSampleSize, CountsTheBinsOfTheChosen) {
  KldOptions options;
  options.bin = 0.5;
  options.binYaw = 0.1;
  const std::vector<Pose2D> poses{{0.1, 0.1, 0.01},  {0.4, 0.4, 0.09},  {-0.1, 0.1, 0.01},
                                  {0.1, -0.1, 0.01}, {0.1, 0.1, -0.01}, {0.6, 0.1, 0.01},
                                  {0.2, 0.2, 0.02}};
  std::vector<std::size_t> all(poses.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  EXPECT_EQ(occupiedBins(poses, all, options), 5u);
  EXPECT_EQ(occupiedBins(poses, {0, 0, 1, 6}, options), 1u);
  EXPECT_EQ(occupiedBins(poses, {5, 0, 5}, options), 2u);
  EXPECT_EQ(occupiedBins(poses, {}, options), 0u);
}

}  // namespace
}  // namespace polemcl::test_kld_sample_size
