#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "localize/LocalizeTimings.h"

namespace polemcl::test_latency_histogram {

using polemcl::apps::LatencyHistogram;

// Against all durations, sorted: the least that the share does not exceed.
TEST(LatencyHistogram, PercentilesAreRightToHalfAPercent) {
  std::mt19937_64 generator(3);
  std::vector<double> all;
  LatencyHistogram histogram;
  for (int i = 0; i < 5001; ++i) {
    all.push_back(2e-6 * std::pow(10, 8 * (double(generator() >> 11) * 0x1p-53)));
    histogram.add(all.back());
  }
  std::sort(all.begin(), all.end());
  for (const double share : {0.0, 0.01, 0.25, 0.5, 0.9, 0.99, 1.0}) {
    const std::size_t rank = std::max(1.0, std::ceil(share * double(all.size())));
    EXPECT_NEAR(histogram.percentile(share) / all[rank - 1], 1, 0.005) << share;
  }
  EXPECT_EQ(histogram.worst(), all.back());
  EXPECT_EQ(histogram.count(), all.size());
}

TEST(LatencyHistogram, TakesDurationsOutsideItsRange) {
  LatencyHistogram histogram;
  EXPECT_EQ(histogram.percentile(0.5), 0);
  histogram.add(0);
  EXPECT_EQ(histogram.worst(), 0);
  EXPECT_EQ(histogram.percentile(0.5), 0);
  histogram.add(1e9);
  histogram.add(1e9);
  EXPECT_EQ(histogram.worst(), 1e9);
  EXPECT_NEAR(histogram.percentile(0.5), LatencyHistogram::longest, 10);
}

}  // namespace polemcl::test_latency_histogram
