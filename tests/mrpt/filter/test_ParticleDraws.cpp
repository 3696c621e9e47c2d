#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mrpt/filter/ParticleDraws.h"

namespace polemcl::test_particle_draws {

TEST(ParticleDraws, EachParticleComesAsOftenAsItsWeightSays) {
  mrpt::random::CRandomGenerator generator(5);
  const GeneratorLoan loan(generator);
  const std::vector<double> weights{0.1, 0.25, 0.05, 0.6};
  std::vector<double> logWeights;
  for (const double weight : weights) logWeights.push_back(std::log(weight) - 700);
  for (const auto method :
       {Resampling::systematic, Resampling::stratified, Resampling::multinomial})
    for (const std::size_t count : {1, 3}) {
      constexpr double kDraws = 4000;
      std::vector<double> drawn(weights.size(), 0);
      for (int i = 0; i < kDraws; ++i) {
        const std::vector<std::size_t> indices = drawIndices(method, logWeights, count);
        ASSERT_EQ(indices.size(), count);
        EXPECT_TRUE(std::is_sorted(indices.begin(), indices.end()));
        for (const std::size_t index : indices) drawn.at(index) += 1;
      }
      for (std::size_t i = 0; i < weights.size(); ++i) {
        const double expected = weights[i] * static_cast<double>(count) * kDraws;
        EXPECT_NEAR(drawn[i], expected, 4.5 * std::sqrt(expected)) << i << " of " << count;
      }
    }
}

}  // namespace polemcl::test_particle_draws
