#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "io/data/PlanarMotion.h"
#include "support/IoFiles.h"

namespace polemcl::test_planar_motion {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;

/// Square root of a covariance, for sampling in the tests.
Eigen::Matrix3d root(const Eigen::Matrix3d& covariance) {
  return Eigen::Matrix3d(covariance.llt().matrixL());
}

Eigen::Vector3d vector(const Pose2D& pose) {
  return {pose.x, pose.y, pose.yaw};
}

TEST(PoseWithCovariance, ComposesMeansByHand) {
  const PoseWithCovariance a{{1, 0, M_PI / 2}, Eigen::Matrix3d::Zero()},
      b{{2, 0.5, 0.1}, Eigen::Matrix3d::Zero()};
  const PoseWithCovariance sum = composeMotions(a, b);
  EXPECT_NEAR(sum.mean.x, 0.5, 1e-15);
  EXPECT_NEAR(sum.mean.y, 2, 1e-15);
  EXPECT_NEAR(sum.mean.yaw, M_PI / 2 + 0.1, 1e-15);
  EXPECT_EQ(sum.covariance, Eigen::Matrix3d::Zero());
}

TEST(PoseWithCovariance, ComposesCovariancesByHand) {
  // An uncertain heading (0.1 rad) moves the end of a 2 m motion sideways by 0.2 m.
  PoseWithCovariance a, b;
  a.covariance = Eigen::Vector3d(0, 0, 0.01).asDiagonal();
  b.mean = {2, 0, 0};
  b.covariance = Eigen::Vector3d(0.09, 0, 0).asDiagonal();
  Eigen::Matrix3d expected;
  expected << 0.09, 0, 0, 0, 0.04, 0.02, 0, 0.02, 0.01;
  EXPECT_TRUE(composeMotions(a, b).covariance.isApprox(expected, 1e-14));
  // After a quarter turn, forward uncertainty becomes uncertainty to the left.
  a.mean.yaw = M_PI / 2;
  a.covariance.setZero();
  expected.setZero();
  expected(1, 1) = 0.09;
  EXPECT_TRUE(composeMotions(a, b).covariance.isApprox(expected, 1e-14));
}

TEST(PoseWithCovariance, CovarianceIsThatOfSampledMotions) {
  PoseWithCovariance a, b;
  a.mean = {1.2, -0.4, 0.8};
  b.mean = {2.1, 0.9, -0.5};
  a.covariance << 0.04, 0.01, 0.002, 0.01, 0.02, -0.001, 0.002, -0.001, 0.0016;
  b.covariance << 0.01, -0.004, 0.001, -0.004, 0.03, 0.0005, 0.001, 0.0005, 0.0009;
  const PoseWithCovariance sum = composeMotions(a, b);
  // Noise small enough for the first-order result to be exact to the digits compared.
  const double small = 1e-3;
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  Eigen::Matrix3d sampled = Eigen::Matrix3d::Zero();
  const int count = 200000;
  for (int i = 0; i < count; ++i) {
    const auto draw = [&](const PoseWithCovariance& motion) {
      const Eigen::Vector3d n(normal(generator), normal(generator), normal(generator));
      const Eigen::Vector3d v = vector(motion.mean) + small * root(motion.covariance) * n;
      return Pose2D{v[0], v[1], v[2]};
    };
    const Pose2D first = draw(a), second = draw(b);
    const Eigen::Vector3d off = (vector(compose(first, second)) - vector(sum.mean)) / small;
    sampled += off * off.transpose() / count;
  }
  EXPECT_LT((sampled - sum.covariance).cwiseAbs().maxCoeff(), 0.01 * sum.covariance(0, 0));
  EXPECT_EQ(sum.covariance, sum.covariance.transpose());
}

TEST(PoseWithCovariance, ComposingIsAssociative) {
  PoseWithCovariance a, b, c;
  a.mean = {1, 0.1, 0.3};
  b.mean = {0.8, -0.2, -0.6};
  c.mean = {1.1, 0, 3.0};
  a.covariance = Eigen::Vector3d(0.01, 0.02, 0.003).asDiagonal();
  b.covariance = Eigen::Vector3d(0.03, 0.01, 0.001).asDiagonal();
  c.covariance = Eigen::Vector3d(0.02, 0.04, 0.002).asDiagonal();
  const PoseWithCovariance left = composeMotions(composeMotions(a, b), c);
  const PoseWithCovariance right = composeMotions(a, composeMotions(b, c));
  EXPECT_TRUE(vector(left.mean).isApprox(vector(right.mean), 1e-14));
  EXPECT_TRUE(left.covariance.isApprox(right.covariance, 1e-13));
}

TEST(PoseWithCovariance, NoiseHasTheDeviationsItStates) {
  const Pose2D motion{2, -0.5, 0.1};
  const double k = 0.02;
  std::mt19937_64 generator(7);
  const int count = 100000;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d off = vector(noisyMotion(motion, k, generator).mean) - vector(motion);
    const Eigen::Vector3d n = off.cwiseQuotient(Eigen::Vector3d(0.04, 0.01, 0.002));
    mean += n / count;
    square += n * n.transpose() / count;
  }
  // Standard errors are 0.003 and 0.0045.
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 0.015);
  EXPECT_LT((square - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 0.02);
}

TEST(PoseWithCovariance, NoiseIsGaussian) {
  std::mt19937_64 generator(11);
  int within1 = 0, within2 = 0;
  const int count = 100000;
  for (int i = 0; i < count; ++i) {
    const double n = noisyMotion({1, 0, 0}, 1, generator).mean.x - 1;
    within1 += std::abs(n) < 1;
    within2 += std::abs(n) < 2;
  }
  EXPECT_NEAR(within1, 0.6827 * count, 0.01 * count);
  EXPECT_NEAR(within2, 0.9545 * count, 0.005 * count);
}

TEST(PoseWithCovariance, NoiseComesFromTheGeneratorByHand) {
  // Box-Muller computed here from the draws: u = draw / 2^53 of the upper 53 bits.
  std::mt19937_64 generator(7), draws(7);
  const auto uniform = [&] { return std::ldexp(static_cast<double>(draws() >> 11), -53); };
  const double u0 = uniform(), u1 = uniform(), u2 = uniform(), u3 = uniform();
  const PoseWithCovariance motion = noisyMotion({3, 4, 0.5}, 0.1, generator);
  EXPECT_DOUBLE_EQ(motion.mean.x,
                   3 + 0.3 * std::sqrt(-2 * std::log1p(-u0)) * std::cos(2 * M_PI * u1));
  EXPECT_DOUBLE_EQ(motion.mean.y,
                   4 + 0.4 * std::sqrt(-2 * std::log1p(-u0)) * std::sin(2 * M_PI * u1));
  EXPECT_DOUBLE_EQ(motion.mean.yaw,
                   0.5 + 0.05 * std::sqrt(-2 * std::log1p(-u2)) * std::cos(2 * M_PI * u3));
  EXPECT_EQ(generator, draws);  // four draws
}

TEST(PoseWithCovariance, DrawsTheSameNumberForAnyMotion) {
  std::mt19937_64 still(3), moving(3);
  noisyMotion({0, 0, 0}, 0, still);
  noisyMotion({5, 1, -2}, 0.5, moving);
  EXPECT_EQ(still, moving);
}

TEST(PoseWithCovariance, CovarianceOfNoiseByHand) {
  std::mt19937_64 generator(1);
  const PoseWithCovariance motion = noisyMotion({2, -0.5, 0.1}, 0.02, generator);
  EXPECT_NEAR(motion.covariance(0, 0), 0.0016 + 1e-6, 1e-18);
  EXPECT_NEAR(motion.covariance(1, 1), 0.0001 + 1e-6, 1e-18);
  EXPECT_NEAR(motion.covariance(2, 2), 0.000004 + 1e-8, 1e-18);
  EXPECT_EQ(motion.covariance(0, 1), 0);
}

TEST(PoseWithCovariance, StandingStillHasAPositiveDefiniteCovariance) {
  std::mt19937_64 generator(1);
  const PoseWithCovariance motion = noisyMotion({0, 0, 0}, 0.02, generator);
  EXPECT_EQ(vector(motion.mean), Eigen::Vector3d::Zero());
  EXPECT_GT(
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(motion.covariance).eigenvalues().minCoeff(),
      0);
}

TEST(PoseWithCovariance, RefusesNegativeOrEndlessNoise) {
  std::mt19937_64 generator(1);
  for (const double k : {-0.02, std::numeric_limits<double>::infinity(), std::nan("")}) {
    EXPECT_REFUSED(noisyMotion({1, 0, 0}, k, generator), "odometry noise", ">= 0");
  }
}

}  // namespace
}  // namespace polemcl::test_planar_motion
