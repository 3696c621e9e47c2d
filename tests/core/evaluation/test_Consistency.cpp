#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "core/evaluation/Consistency.h"
#include "sim/common/Random.h"

namespace polemcl::test_consistency {
namespace {

ConsistencySample sample(double dx, double dy, double dyaw, const Eigen::Matrix3d& covariance) {
  ConsistencySample result;
  result.truth = {5, -7, 3.1};
  result.estimate.mean = {5 + dx, -7 + dy, 3.1 + dyaw};
  result.estimate.covariance = covariance;
  return result;
}

TEST(Consistency, FiguresByHand) {
  const Eigen::Matrix3d diagonal = Eigen::Vector3d(0.04, 0.01, 0.0025).asDiagonal();
  // The second heading error goes the other way round the circle.
  const auto score = scoreConsistency({sample(0.2, 0.2, 0.1, diagonal),             // 1 + 4 + 4
                                       sample(0, 0.25, 0.05 - 2 * M_PI, diagonal),  // 6.25 + 1
                                       sample(0.2, 0, 0, diagonal)});               // 1
  EXPECT_EQ(score.samples, 3u);
  EXPECT_NEAR(score.neesMean, (9 + 7.25 + 1) / 3, 1e-9);
  EXPECT_NEAR(score.neesMedian, 7.25, 1e-9);
  EXPECT_NEAR(score.neesPositionMean, (5 + 6.25 + 1) / 3, 1e-9);
  EXPECT_NEAR(score.neesHeadingMean, (4 + 1 + 0) / 3.0, 1e-9);
  EXPECT_NEAR(score.coverage95, 2.0 / 3, 1e-12);  // 6.25 is beyond 5.99
}

TEST(Consistency, LongestTimeBeyondFiveSigmaEndsWithAGoodPoseAndWithAGap) {
  const Eigen::Matrix3d covariance = Eigen::Vector3d(0.01, 0.01, 0.01).asDiagonal();
  std::vector<ConsistencySample> samples;
  for (int i = 0; i < 40; ++i) {
    const bool isFar = (i >= 3 && i < 10) || (i >= 20 && i < 36);
    samples.push_back(sample(isFar ? 0.51 : 0.49, 0, 0, covariance));
    samples.back().time = 0.5 * i;
    samples.back().isFirst = i == 0;
  }
  EXPECT_NEAR(scoreConsistency(samples).longestBeyond5, 0.5 * 15, 1e-9);
  samples[28].isFirst = true;  // 20 to 27 and 28 to 35
  EXPECT_NEAR(scoreConsistency(samples).longestBeyond5, 0.5 * 7, 1e-9);
}

TEST(Consistency, ErrorsDrawnFromTheCovarianceAreConsistent) {
  Eigen::Matrix3d covariance;
  covariance << 0.04, 0.01, 0.002, 0.01, 0.02, -0.001, 0.002, -0.001, 0.001;
  const Eigen::Matrix3d root = covariance.llt().matrixL();
  sim::Random random(3);
  std::vector<ConsistencySample> samples;
  for (int i = 0; i < 40000; ++i) {
    const Eigen::Vector3d e =
        root * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
    samples.push_back(sample(e.x(), e.y(), e.z(), covariance));
  }
  const auto score = scoreConsistency(samples);  // bounds: four standard deviations
  EXPECT_NEAR(score.neesMean, 3, 4 * std::sqrt(6.0 / 40000));
  EXPECT_NEAR(score.neesMedian, 2.366, 0.06);
  EXPECT_NEAR(score.neesPositionMean, 2, 4 * std::sqrt(4.0 / 40000));
  EXPECT_NEAR(score.neesHeadingMean, 1, 4 * std::sqrt(2.0 / 40000));
  EXPECT_NEAR(score.coverage95, 0.95, 4 * std::sqrt(0.95 * 0.05 / 40000));
}

TEST(Consistency, RefusesWhatHasNoNees) {
  EXPECT_THROW(scoreConsistency({}), Error);
  const Eigen::Matrix3d good = Eigen::Matrix3d::Identity();
  EXPECT_THROW(scoreConsistency({sample(0, 0, 0, Eigen::Matrix3d::Zero())}), Error);
  Eigen::Matrix3d indefinite = good, skew = good, broken = good;
  indefinite(0, 1) = indefinite(1, 0) = 2;
  skew(0, 1) = 0.5;
  broken(2, 2) = NAN;
  for (const auto& bad : {indefinite, skew, broken})
    EXPECT_THROW(scoreConsistency({sample(0, 0, 0, good), sample(0, 0, 0, bad)}), Error);
  EXPECT_THROW(scoreConsistency({sample(NAN, 0, 0, good)}), Error);
}

}  // namespace
}  // namespace polemcl::test_consistency
