#include <gtest/gtest.h>

#include <Eigen/LU>
#include <numeric>
#include <random>

#include "core/mapping/LandmarkFusion.h"
#include "support/Poles.h"
#include "support/Refusal.h"

namespace polemcl::test_landmark_fusion {
namespace {

LandmarkObservation observation(double x, double y, double variance = 0.01) {
  LandmarkObservation s;
  s.pole = tests::detectionAt(x, y, variance);
  return s;
}

std::vector<std::uint32_t> all(const std::vector<LandmarkObservation>& observations) {
  std::vector<std::uint32_t> members(observations.size());
  std::iota(members.begin(), members.end(), 0u);
  return members;
}

TEST(LandmarkFusion, OneSightingIsThePole) {
  std::vector<LandmarkObservation> observations{observation(3, 4, 0.04)};
  observations[0].pole.radius = 0.1;
  observations[0].pole.bottom = 0.3;
  observations[0].pole.top = 5;
  observations[0].pole.confidence = 1;
  const MapPole pole = fuse(observations, {0});
  EXPECT_DOUBLE_EQ(pole.x, 3);
  EXPECT_DOUBLE_EQ(pole.y, 4);
  EXPECT_NEAR(pole.covariance(0, 0), 0.04, 1e-7);
  EXPECT_DOUBLE_EQ(pole.radius, 0.1);
  EXPECT_EQ(pole.bottom, 0.3);
  EXPECT_EQ(pole.top, 5);
  EXPECT_EQ(pole.count, 1u);
}

TEST(LandmarkFusion, WeighsByInverseCovarianceAndConfidence) {
  // Information 100 and 25 in x: (100·0 + 25·1)/125; the second one's confidence of a half makes
  // it 12.5.
  std::vector<LandmarkObservation> observations{observation(0, 0, 0.01), observation(1, 0, 0.04)};
  EXPECT_NEAR(fusedCentre(observations, {0, 1}).x(), 25.0 / 125, 1e-5);
  observations[1].pole.confidence = 0.5;
  EXPECT_NEAR(fusedCentre(observations, {0, 1}).x(), 12.5 / 112.5, 1e-5);
}

TEST(LandmarkFusion, EachCountsMostAcrossItsLongAxis) {
  std::vector<LandmarkObservation> observations{observation(0, 0), observation(0.1, 0.1)};
  observations[0].pole.covariance << 1, 0, 0, 0.0001;
  observations[1].pole.covariance << 0.0001, 0, 0, 1;
  const Eigen::Vector2d centre = fusedCentre(observations, {0, 1});
  EXPECT_NEAR(centre.x(), 0.1, 1e-4);
  EXPECT_NEAR(centre.y(), 0, 1e-4);
}

TEST(LandmarkFusion, IsTheLeastSquaresSolutionWithoutOutliers) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::vector<LandmarkObservation> observations;
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int i = 0; i < 40; ++i) {
    Eigen::Matrix2d root;
    root << 0.1, 0.05 * normal(random), 0, 0.02 + 0.1 * (i % 3);
    LandmarkObservation s = observation(0, 0);
    s.pole.covariance = root * root.transpose();
    Eigen::Vector2d noise(normal(random), normal(random));
    if (noise.norm() > 2) noise *= 2 / noise.norm();  // all of them well inside the 99 % ellipse
    const Eigen::Vector2d at = Eigen::Vector2d(7, -3) + root * noise;
    s.pole.x = at.x();
    s.pole.y = at.y();
    observations.push_back(s);
    const Eigen::Matrix2d inverse = s.pole.covariance.inverse();
    information += inverse;
    sum += inverse * at;
  }
  const Eigen::Vector2d expected = information.inverse() * sum;
  EXPECT_LT((fusedCentre(observations, all(observations)) - expected).norm(), 1e-5);
}

TEST(LandmarkFusion, LeavesOutliersOut) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal(0, 0.02);
  std::vector<LandmarkObservation> observations;
  for (int i = 0; i < 20; ++i)
    observations.push_back(observation(normal(random), normal(random), 0.0004));
  for (int i = 0; i < 6; ++i)
    observations.push_back(observation(0.4, 0.1 + normal(random), 0.0004));
  std::vector<std::uint32_t> kept;
  const Eigen::Vector2d centre = fusedCentre(observations, all(observations), nullptr, &kept);
  EXPECT_LT(centre.norm(), 0.02);
  for (const std::uint32_t member : kept) EXPECT_LT(member, 20u);
  EXPECT_GE(kept.size(), 18u);
}

// The vague ones lie within two of their sigmas of the certain one, all on one side of it.
TEST(LandmarkFusion, ACertainSightingIsNoOutlierOfVagueOnes) {
  const std::vector<LandmarkObservation> observations{
      observation(0, 0, 0.09), observation(0.05, 0, 0.09), observation(0.6, 0, 0.0001)};
  std::vector<std::uint32_t> kept;
  const Eigen::Vector2d centre = fusedCentre(observations, {0, 1, 2}, nullptr, &kept);
  EXPECT_NEAR(centre.x(), 0.6, 0.005);
  EXPECT_EQ(kept.size(), 3u);
}

// By Rousseeuw and Leroy, six coordinates with two unknowns whose median distance is 0.1 m have a
// sigma of (1 + 5 / (6 - 2)) 0.1 m / sqrt(1.386) = 0.191 m: the ellipse of 99 % ends at 0.58 m.
TEST(LandmarkFusion, ThreeSightingsAllowForTheirFewness) {
  const auto keptWith = [](double farthest) {
    std::vector<std::uint32_t> kept;
    fusedCentre({observation(-0.1, 0), observation(0, 0), observation(farthest, 0)}, {0, 1, 2},
                nullptr, &kept);
    return kept.size();
  };
  EXPECT_EQ(keptWith(0.57), 3u);
  EXPECT_EQ(keptWith(0.6), 2u);
}

// 4000 poles of 12 observations with σ = 0.05 m each, that promise 0.05 m, only 0.01 m, or 0.1 m.
TEST(LandmarkFusion, TheCovarianceIsHonestWhateverTheSightingsPromise) {
  const auto squaredErrors = [](double promised) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal(0, 0.05);
    double sum = 0;
    for (int pole = 0; pole < 4000; ++pole) {
      std::vector<LandmarkObservation> observations;
      for (int i = 0; i < 12; ++i)
        observations.push_back(observation(normal(random), normal(random), promised * promised));
      Eigen::Matrix2d covariance;
      const Eigen::Vector2d error = fusedCentre(observations, all(observations), &covariance);
      sum += error.dot(covariance.inverse() * error);
    }
    return sum / 4000;
  };
  // 2 would be exact. Ellipses are widened by the scatter where that is large, never narrowed:
  // below 2 by chance, above by the variance of a scatter of 12, and a quarter for twice the sigma.
  EXPECT_NEAR(squaredErrors(0.05), 1.87, 0.12);
  EXPECT_NEAR(squaredErrors(0.01), 2.35, 0.15);
  EXPECT_NEAR(squaredErrors(0.1), 0.5, 0.03);
}

TEST(LandmarkFusion, LosesNoDigitsFarFromTheOrigin) {
  const std::vector<LandmarkObservation> observations{
      observation(4e6 + 0.25, 5e6), observation(4e6 + 0.5, 5e6), observation(4e6 + 0.75, 5e6)};
  EXPECT_NEAR(fusedCentre(observations, {0, 1, 2}).x() - 4e6, 0.5, 1e-8);
}

TEST(LandmarkFusion, HeightsAreQuantilesAndTheRestMeans) {
  std::vector<LandmarkObservation> observations;
  for (int i = 0; i < 11; ++i) {
    LandmarkObservation s = observation(0, 0);
    s.pole.bottom = 0.1 * i;
    s.pole.top = 5 + i;
    s.pole.radius = i < 6 ? 0.1 : 0.2;
    s.pole.confidence = i % 2 ? 0.5 : 1;
    observations.push_back(s);
  }
  const MapPole pole = fuse(observations, all(observations));
  EXPECT_DOUBLE_EQ(pole.bottom, 0.1);
  EXPECT_DOUBLE_EQ(pole.top, 14);
  // Weights 1 and 1/2: 1 at even, 1/2 at odd; 0.1 has 1+.5+1+.5+1+.5, 0.2 has 1+.5+1+.5+1.
  EXPECT_NEAR(pole.radius, (0.1 * 4.5 + 0.2 * 4) / 8.5, 1e-12);
  EXPECT_NEAR(pole.confidence, 8.5 / 11, 1e-12);
  EXPECT_EQ(pole.count, 11u);
}

TEST(LandmarkFusion, CopesWithACovarianceOfZero) {
  const std::vector<LandmarkObservation> observations{observation(1, 1, 0), observation(1.1, 1, 0),
                                                      observation(1.05, 1, 0)};
  Eigen::Matrix2d covariance;
  EXPECT_NEAR(fusedCentre(observations, {0, 1, 2}, &covariance).x(), 1.05, 1e-9);
  EXPECT_TRUE(covariance.allFinite());
}

TEST(LandmarkFusion, CopesWithNoConfidence) {
  std::vector<LandmarkObservation> observations{observation(1, 1), observation(1.01, 1),
                                                observation(1.02, 1), observation(9, 9)};
  for (const double confidence : {0.0, 1e-310, 1e-12}) {
    observations[3].pole.confidence = confidence;
    EXPECT_NEAR(fuse(observations, all(observations)).x, 1.01, 1e-6) << "it changes nothing";
    const MapPole alone = fuse(observations, {3});
    EXPECT_EQ(alone.x, 9);
    EXPECT_TRUE(std::isfinite(alone.radius) && alone.covariance.allFinite());
  }
}

// Its determinant is 0 in floating point, whatever small number is added to the diagonal.
TEST(LandmarkFusion, CopesWithALongThinEllipse) {
  for (const double variance : {1e3, 1e8, 1e12}) {
    LandmarkObservation thin = observation(3, 3);
    thin.pole.covariance = Eigen::Matrix2d::Constant(variance);
    const MapPole alone = fuse({thin}, {0});
    EXPECT_EQ(alone.x, 3);
    EXPECT_TRUE(alone.covariance.allFinite()) << variance;
    const MapPole two = fuse({thin, observation(4, 4)}, {0, 1});
    EXPECT_NEAR(two.x, 4, 1e-4) << variance;
    EXPECT_NEAR(two.y, 4, 1e-4) << variance;
  }
}

TEST(LandmarkFusion, RefusesADetectionOfNumbersThatOverflow) {
  const auto refused = [](const auto& spoil) {
    PoleDetection pole = tests::detectionAt(1, 2);
    spoil(pole);
    return tests::messageOf([&] { checkScan({}, {pole}, "scan 7"); });
  };
  EXPECT_EQ(refused([](PoleDetection& p) { p.covariance *= 4e13; }), "no error");
  EXPECT_HAS(refused([](PoleDetection& p) { p.covariance *= 1e160; }),
             "pole 0 of scan 7 has a covariance above 1e12");
  EXPECT_HAS(refused([](PoleDetection& p) { p.radius = 1.7e308; }), "a radius above 1e6 m");
  EXPECT_HAS(refused([](PoleDetection& p) { p.top = 1e300; }), "a height above 1e9 m");
  EXPECT_HAS(refused([](PoleDetection& p) { p.timeOffset = -1e160; }),
             "a time offset above 1000 s");
}

TEST(LandmarkFusion, CertainSightingsGiveACertainPole) {
  for (int n = 1; n < 60; ++n) {
    const std::vector<LandmarkObservation> observations(n, observation(0, 0));
    EXPECT_EQ(fuse(observations, all(observations)).confidence, 1) << n;
  }
}

}  // namespace
}  // namespace polemcl::test_landmark_fusion
