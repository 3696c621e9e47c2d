#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <polemcl/core/localization/PoleLikelihood.h>
#include "core/common/PoleIndex.h"
#include "core/common/SimdMath.h"

namespace polemcl::test_simd_math {
namespace {

/// Odd in number, so that vectors of any length leave a rest.
std::vector<double> uniform(double low, double high, std::size_t count = 10007) {
  std::mt19937_64 random(5);
  std::vector<double> values(count);
  for (double& value : values) value = low + (high - low) * 0x1p-64 * double(random());
  return values;
}

std::vector<double> someNormals(std::size_t pairs) {
  std::mt19937 random(7);
  std::vector<std::uint32_t> bits(2 * pairs);
  for (auto& number : bits) number = static_cast<std::uint32_t>(random());
  std::vector<double> out(2 * pairs);
  normalDeviates(bits.data(), pairs, out.data());
  return out;
}

/// All that the vector kernels compute, in one list.
std::vector<double> everything() {
  const std::vector<double> angles = uniform(-20, 20), exponents = uniform(-60, 1);
  std::vector<double> all(3 * angles.size());
  sinesAndCosines(angles.data(), angles.size(), &all[0], &all[angles.size()]);
  std::copy(exponents.begin(), exponents.end(), &all[2 * angles.size()]);
  exponentials(&all[2 * angles.size()], exponents.size());
  const auto normals = someNormals(501);
  all.insert(all.end(), normals.begin(), normals.end());
  std::vector<MapPole> map(50);
  std::vector<PoleDetection> poles(7);
  std::vector<Pose2D> poses(77);
  for (std::size_t i = 0; i < map.size(); ++i)
    map[i].x = angles[2 * i], map[i].y = angles[2 * i + 1];
  for (std::size_t i = 0; i < poles.size(); ++i) poles[i].x = angles[i], poles[i].y = 0.3 * i;
  for (std::size_t i = 0; i < poses.size(); ++i)
    poses[i] = {0.1 * angles[i], angles[i + 1], 0.5 * i};
  for (const bool weighted : {false, true})
    for (const auto model : {LikelihoodModel::paper, LikelihoodModel::mixture}) {
      LikelihoodOptions options;
      options.model = model;
      options.sigma = 0.15;
      options.weighted = weighted;
      std::vector<double> values;
      logLikelihoods(poles, poses, PoleIndex(map), options, values);
      all.insert(all.end(), values.begin(), values.end());
    }
  return all;
}

struct AnyInstructionSet {
  ~AnyInstructionSet() { hwy::SetSupportedTargetsForTest(0); }
};

TEST(SimdMath, ExponentialsEqualTheStandardLibrarys) {
  std::vector<double> values = uniform(-708, 709);
  for (double extra : {0.0, -0.0, 1.0, -1.0, 1e-300, -1e-17, 709.0, -708.0})
    values.push_back(extra);
  std::vector<double> out = values;
  exponentials(out.data(), out.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    ASSERT_NEAR(out[i] / std::exp(values[i]), 1, 1e-15) << values[i];
  values = {-750, -1e6, -INFINITY};
  exponentials(values.data(), values.size());
  for (const double value : values) EXPECT_EQ(value, 0);
}

TEST(SimdMath, SinesAndCosinesEqualTheStandardLibrarys) {
  for (double range : {1.0, 4.0, 100.0, 39000.0}) {
    std::vector<double> angles = uniform(-range, range);
    for (int quarter = -8; quarter <= 8; ++quarter) angles.push_back(quarter * M_PI / 2);
    std::vector<double> sines(angles.size()), cosines(angles.size());
    sinesAndCosines(angles.data(), angles.size(), sines.data(), cosines.data());
    for (std::size_t i = 0; i < angles.size(); ++i) {
      ASSERT_NEAR(sines[i], std::sin(angles[i]), 1e-15) << angles[i];
      ASSERT_NEAR(cosines[i], std::cos(angles[i]), 1e-15) << angles[i];
    }
  }
}

TEST(SimdMath, NormalDeviatesAreNormalAndIndependent) {
  const std::vector<double> values = someNormals(200000);
  const double n = static_cast<double>(values.size());
  double sums[5] = {}, product = 0;
  std::size_t below[3] = {};
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (int k = 1; k <= 4; ++k) sums[k] += std::pow(values[i], k);
    if (i > 0) product += values[i] * values[i - 1];
    for (int k = 0; k < 3; ++k) below[k] += values[i] < k - 1;
  }
  // Four standard deviations: of moments of a normal number, and of a binomial count.
  EXPECT_NEAR(sums[1] / n, 0, 4 / std::sqrt(n));
  EXPECT_NEAR(sums[2] / n, 1, 4 * std::sqrt(2 / n));
  EXPECT_NEAR(sums[3] / n, 0, 4 * std::sqrt(15 / n));
  EXPECT_NEAR(sums[4] / n, 3, 4 * std::sqrt(96 / n));
  EXPECT_NEAR(product / n, 0, 4 / std::sqrt(n));
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(below[k] / n, 0.5 * std::erfc(-(k - 1) / std::sqrt(2.0)), 2 / std::sqrt(n));
}

TEST(SimdMath, NormalDeviatesStayFiniteAtTheEnds) {
  const std::uint32_t bits[] = {0, 0, 0xffffffffu, 0xffffffffu};
  double out[4];
  normalDeviates(bits, 2, out);
  EXPECT_NEAR(out[0], std::sqrt(2 * std::log(0x1p33)), 1e-9);
  for (double value : out) EXPECT_LT(std::abs(value), 6.8);
}

TEST(SimdMath, InstructionSetsDifferInTheLastDigitsOnly) {
  const AnyInstructionSet restore;
  const std::vector<double> expected = everything();
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    const std::vector<double> values = everything();
    for (std::size_t i = 0; i < values.size(); ++i)
      ASSERT_NEAR(values[i], expected[i], 1e-12 * std::max(1.0, std::abs(expected[i])))
          << hwy::TargetName(target) << " " << i;
  }
}

}  // namespace
}  // namespace polemcl::test_simd_math
