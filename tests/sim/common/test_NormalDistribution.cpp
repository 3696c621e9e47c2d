#include <gtest/gtest.h>

#include "sim/common/NormalDistribution.h"
#include "sim/common/Random.h"

namespace polemcl::test_normal_distribution {

using namespace polemcl::sim;

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

}  // namespace polemcl::test_normal_distribution
