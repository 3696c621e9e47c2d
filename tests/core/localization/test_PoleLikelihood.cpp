#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <polemcl/core/localization/PoleLikelihood.h>
#include "core/common/Binder.h"
#include "core/common/PoleIndex.h"
#include "support/Poles.h"
#include "support/Refusal.h"

namespace polemcl::test_pole_likelihood {
namespace {

using namespace polemcl::tests;

PoleDetection exactAt(double x, double y) {
  return detectionAt(x, y, 0);
}

LikelihoodOptions optionsOf(LikelihoodModel model, bool weighted) {
  LikelihoodOptions options;
  options.model = model;
  options.sigma = 0.15;
  options.weighted = weighted;
  return options;
}

struct Scene {
  std::vector<MapPole> map;
  std::vector<PoleDetection> poles;
  std::vector<Pose2D> poses;
};

Scene randomScene(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Scene scene;
  for (int i = 0; i < 200; ++i)
    scene.map.push_back(mapPoleAt(uniform(-40, 40), uniform(-40, 40), uniform(0, 0.02)));
  for (int i = 0; i < 12; ++i) {
    PoleDetection pole = exactAt(uniform(-30, 30), uniform(-30, 30));
    Eigen::Matrix2d root;
    root << uniform(0, 0.3), uniform(-0.2, 0.2), 0, uniform(0.01, 0.2);
    pole.covariance = root * root.transpose();
    pole.confidence = uniform(0, 1);
    scene.poles.push_back(pole);
  }
  for (int i = 0; i < 100; ++i)
    scene.poses.push_back({uniform(-5, 5), uniform(-5, 5), uniform(-4, 4)});
  return scene;
}

/// The formulas of the header word by word: all poles searched, covariances rotated and inverted.
double oracle(const Scene& scene, const Pose2D& pose, const LikelihoodOptions& o) {
  const Eigen::Matrix2d rotation = Eigen::Rotation2Dd(pose.yaw).toRotationMatrix();
  const double squaredSigma = o.sigma * o.sigma;
  double sum = 0;
  for (const PoleDetection& pole : scene.poles) {
    const Eigen::Vector2d centre =
        Eigen::Vector2d(pose.x, pose.y) + rotation * Eigen::Vector2d(pole.x, pole.y);
    const MapPole* best = nullptr;
    double least = o.gate;
    for (const MapPole& candidate : scene.map) {
      const double d = (centre - Eigen::Vector2d(candidate.x, candidate.y)).norm();
      if (d < least) {
        least = d;
        best = &candidate;
      }
    }
    Eigen::Matrix2d S = squaredSigma * Eigen::Matrix2d::Identity();
    double confidence = 1, cost = o.gate * o.gate / (2 * squaredSigma);
    if (o.weighted) {
      S += rotation * pole.covariance * rotation.transpose();
      if (best) S += 0.5 * best->covariance.trace() * Eigen::Matrix2d::Identity();
      confidence = pole.confidence;
      cost = o.gate * o.gate / (2 * squaredSigma + pole.covariance.trace());
    }
    const Eigen::Vector2d e =
        best ? Eigen::Vector2d(centre - Eigen::Vector2d(best->x, best->y)) : Eigen::Vector2d(0, 0);
    const double m2 = e.dot(S.inverse() * e);
    if (o.model == LikelihoodModel::paper) {
      sum -= confidence * (best ? std::min(0.5 * m2, cost) : cost);
    } else if (o.model == LikelihoodModel::floored) {
      sum += std::log(
          std::exp(-least * least / (2 * squaredSigma)) / o.sigma / std::sqrt(2 * M_PI) + o.floor);
    } else {
      const double p = (1 - o.outlier) * confidence;
      const double beside = std::pow(1 - e.squaredNorm() / (o.gate * o.gate), 3) * confidence;
      const double outlier = o.farOutlier + (best ? (1 - o.farOutlier) * beside : 0);
      const double hit = p * squaredSigma / std::sqrt(S.determinant()) * std::exp(-0.5 * m2);
      sum += std::log((best ? hit : 0) + (1 - p) * outlier);
    }
  }
  return sum;
}

constexpr LikelihoodModel kModels[] = {LikelihoodModel::paper, LikelihoodModel::mixture};

/// All models, weighted where they can be.
std::vector<LikelihoodOptions> allOptions() {
  std::vector<LikelihoodOptions> all{optionsOf(LikelihoodModel::floored, false)};
  for (const LikelihoodModel model : kModels)
    for (const bool weighted : {false, true}) all.push_back(optionsOf(model, weighted));
  return all;
}

TEST(PoleLikelihood, PaperByHand) {
  LikelihoodOptions options = optionsOf(LikelihoodModel::paper, false);
  options.sigma = 0.5;
  options.gate = 2;
  const PoleIndex index({mapPoleAt(10, 0, 0), mapPoleAt(0, 10, 0)}, 2);
  // Seen from (1, 0) looking to +y: (0, -9) lies at (10, 0), off by 0; (10.6, 1) at (0, 10.6), off
  // by 0.6.
  const Pose2D pose{1, 0, M_PI / 2};
  EXPECT_NEAR(logLikelihood({exactAt(0, -9)}, pose, index, options), 0, 1e-12);
  EXPECT_NEAR(logLikelihood({exactAt(0, -9), exactAt(10.6, 1)}, pose, index, options), -0.36 / 0.5,
              1e-12);
  // Without a match a pole costs the gate, 2²/(2·0.5²) = 8, as one just inside it does.
  EXPECT_NEAR(logLikelihood({exactAt(50, 50)}, pose, index, options), -8, 1e-12);
  EXPECT_NEAR(logLikelihood({exactAt(0, -10.999999)}, pose, index, options), -8, 1e-4);
}

TEST(PoleLikelihood, MixtureByHand) {
  LikelihoodOptions options = optionsOf(LikelihoodModel::mixture, false);
  options.sigma = 0.2;
  options.outlier = 0.1;
  options.farOutlier = 0.25;
  options.gate = 0.2;
  const PoleIndex index({mapPoleAt(5, 5, 0)});
  // Off by 0.1 m: half a σ, and half of the gate.
  const double matched = std::log(0.9 * std::exp(-0.125) + 0.1 * (0.25 + 0.75 * 27 / 64));
  EXPECT_NEAR(logLikelihood({exactAt(5.1, 5)}, {}, index, options), matched, 1e-12);
  EXPECT_NEAR(logLikelihood({exactAt(5.1, 5), exactAt(20, 5)}, {}, index, options),
              matched + std::log(0.025), 1e-12);
  options.farOutlier = 1;  // all outliers alike
  EXPECT_NEAR(logLikelihood({exactAt(5.1, 5)}, {}, index, options),
              std::log(0.9 * std::exp(-0.125) + 0.1), 1e-12);
}

TEST(PoleLikelihood, FlooredByHand) {
  LikelihoodOptions options = optionsOf(LikelihoodModel::floored, false);
  options.sigma = 1;
  const PoleIndex index({mapPoleAt(5, 5, 0)});
  // A constant apart: the densities of the standard normal distribution at 0, 0.5 and 1, from a
  // table, and 0.2. A pole without a match counts as one at the gate of 1 m.
  const double exact = logLikelihood({exactAt(5, 5)}, {}, index, options);
  const double half = logLikelihood({exactAt(5.5, 5)}, {}, index, options);
  const double none = logLikelihood({exactAt(9, 5)}, {}, index, options);
  EXPECT_NEAR(half - exact, std::log((0.352065 + 0.2) / (0.398942 + 0.2)), 1e-5);
  EXPECT_NEAR(none - exact, std::log((0.241971 + 0.2) / (0.398942 + 0.2)), 1e-5);
  EXPECT_NEAR(logLikelihood({exactAt(5, 5.999999)}, {}, index, options), none, 1e-5);
  EXPECT_NEAR(logLikelihood({exactAt(9, 5), exactAt(5.5, 5)}, {}, index, options), none + half,
              1e-12);
}

TEST(PoleLikelihood, FlooredRefusesWhatItCannotDo) {
  LikelihoodOptions options = optionsOf(LikelihoodModel::floored, true);
  EXPECT_REFUSED(checkOptions(options), "weighted");
  options.weighted = false;
  checkOptions(options);
  for (const double bad : {0.0, -0.2, std::nan(""), HUGE_VAL, 1e-12}) {
    options.floor = bad;
    EXPECT_REFUSED(checkOptions(options), "floor");
  }
}

// A constant apart: only differences between poses count with the model of a floor.
TEST(PoleLikelihood, EqualsTheFormulasWordByWord) {
  for (std::uint64_t seed : {1, 2, 3}) {
    const Scene scene = randomScene(seed);
    const PoleIndex index(scene.map, 1.0);
    const auto expectEqual = [&](const LikelihoodOptions& options) {
      double offset = 0;
      if (options.model == LikelihoodModel::floored)
        offset = logLikelihood(scene.poles, scene.poses[0], index, options) -
                 oracle(scene, scene.poses[0], options);
      for (const Pose2D& pose : scene.poses) {
        const double expected = oracle(scene, pose, options);
        ASSERT_NEAR(logLikelihood(scene.poles, pose, index, options) - offset, expected,
                    1e-9 * (1 + std::abs(expected)));
      }
    };
    for (LikelihoodOptions options : allOptions())
      for (const double gate : {0.4, 1.0, 3.0}) {  // the last beyond what the index is prepared for
        options.gate = gate;
        expectEqual(options);
        for (const double sigma : {0.05, 1.0, 1.2247})
          for (const double floor : {1e-6, 0.2, 5.0}) {
            if (options.model != LikelihoodModel::floored) continue;
            options.sigma = sigma, options.floor = floor;
            expectEqual(options);
          }
      }
  }
}

TEST(PoleLikelihood, PosesNearEachOtherAreSearchedTogetherToTheSameNumbers) {
  Scene scene = randomScene(13);
  for (MapPole& pole : scene.map) pole.x *= 0.4, pole.y *= 0.4;  // several within the gate
  for (Pose2D& pose : scene.poses) pose = {0.05 * pose.x, 0.05 * pose.y, 1 + 0.002 * pose.yaw};
  const PoleIndex index(scene.map);
  const LikelihoodOptions options = optionsOf(LikelihoodModel::mixture, true);
  std::vector<double> together, apart;
  logLikelihoods(scene.poles, scene.poses, index, options, together);
  scene.poses.push_back({1e5, -1e5, 0});  // too far to be searched with the others
  logLikelihoods(scene.poles, scene.poses, index, options, apart);
  apart.pop_back();
  EXPECT_EQ(together, apart);
}

TEST(PoleLikelihood, BatchesAndSeveralSigmasAtOnceGiveWhatEachGivesAlone) {
  const Scene scene = randomScene(11);
  const PoleIndex index(scene.map);
  const std::vector<double> widenings{1, 2, 0.5, 8};
  for (const LikelihoodOptions& options : allOptions()) {
    std::vector<double> plain(3, 42);
    logLikelihoods(scene.poles, scene.poses, index, options, plain);
    std::vector<std::vector<double>> batch;
    widenedLogLikelihoods(scene.poles, scene.poses, index, options, widenings, batch);
    ASSERT_EQ(batch.size(), widenings.size());
    EXPECT_EQ(batch[0], plain);
    for (std::size_t k = 0; k < widenings.size(); ++k) {
      LikelihoodOptions alone = options;
      alone.sigma *= widenings[k];
      ASSERT_EQ(batch[k].size(), scene.poses.size());
      for (std::size_t i = 0; i < scene.poses.size(); ++i)
        EXPECT_EQ(batch[k][i], logLikelihood(scene.poles, scene.poses[i], index, alone));
    }
  }
  std::vector<std::vector<double>> out;
  EXPECT_THROW(widenedLogLikelihoods({}, {}, index, {}, std::vector<double>(9, 1.0), out), Error);
}

TEST(PoleLikelihood, NoDetectionsSayNothing) {
  const PoleIndex index({mapPoleAt(0, 0, 0)});
  for (LikelihoodModel model : kModels)
    EXPECT_EQ(logLikelihood({}, {}, index, optionsOf(model, true)), 0);
}

TEST(PoleLikelihood, AnEmptyMapCostsTheFloorForEachDetection) {
  const PoleIndex index({});
  const std::vector<PoleDetection> poles{exactAt(1, 2), exactAt(3, 4)};
  EXPECT_NEAR(logLikelihood(poles, {}, index, optionsOf(LikelihoodModel::mixture, false)),
              2 * std::log(0.05 * 0.1), 1e-12);
  EXPECT_NEAR(logLikelihood(poles, {}, index, optionsOf(LikelihoodModel::paper, false)),
              -2 / (2 * 0.15 * 0.15), 1e-9);
}

TEST(PoleLikelihood, StaysFiniteWithThousandsOfUnmatchedPoles) {
  LikelihoodOptions options = optionsOf(LikelihoodModel::mixture, false);
  options.outlier = 1e-9;
  const std::vector<PoleDetection> poles(5000, exactAt(1, 2));
  EXPECT_NEAR(logLikelihood(poles, {}, PoleIndex({}), options), 5000 * std::log(1e-10), 1e-6);
}

TEST(PoleLikelihood, StaysFiniteWithNumbersThatAreNone) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  const PoleIndex index({mapPoleAt(0, 0, 0)});
  for (const LikelihoodOptions& options : allOptions()) {
    const double unmatched = logLikelihood({exactAt(50, 50)}, {}, index, options);
    for (const Pose2D& none : {Pose2D{nan, 0, 0}, {0, infinity, 0}, {0, 0, nan}})
      EXPECT_EQ(logLikelihood({exactAt(0, 0)}, none, index, options), unmatched);
    EXPECT_EQ(logLikelihood({exactAt(nan, 0)}, {}, index, options), unmatched);
  }
}

TEST(PoleLikelihood, TheMixtureIsNotFlat) {
  const PoleIndex index({mapPoleAt(10, 0, 0)});
  const LikelihoodOptions options = optionsOf(LikelihoodModel::mixture, false);
  const double right = logLikelihood({exactAt(10, 0)}, {}, index, options);
  const double off = logLikelihood({exactAt(10, 0)}, {0.3, 0, 0}, index, options);
  const double lost = logLikelihood({exactAt(10, 0)}, {5, 0, 0}, index, options);
  EXPECT_GT(right - off, std::log(4));
  EXPECT_GT(off - lost, std::log(2));
  EXPECT_NEAR(lost, std::log(options.outlier * options.farOutlier), 1e-12);
}

TEST(PoleLikelihood, WeightsAnErrorByTheCovarianceAlongIt) {
  LikelihoodOptions options = optionsOf(LikelihoodModel::paper, true);
  options.sigma = 0.1;
  const PoleIndex index({mapPoleAt(0, 20, 0)});
  PoleDetection pole = exactAt(20, 0);
  pole.covariance << 0.08, 0, 0, 0;  // 0.28 m along the line of sight, certain across it
  // The robot looks to +y, so along the line of sight is along the map's y.
  const double along = logLikelihood({pole}, {0, 0.3, M_PI / 2}, index, options);
  const double across = logLikelihood({pole}, {0.3, 0, M_PI / 2}, index, options);
  EXPECT_NEAR(along, -0.5 * 0.09 / 0.09, 1e-9);
  EXPECT_NEAR(across, -0.5 * 0.09 / 0.01, 1e-9);
}

TEST(PoleLikelihood, AnUncertainMapPoleCountsForLess) {
  LikelihoodOptions options = optionsOf(LikelihoodModel::paper, true);
  options.sigma = 0.1;
  EXPECT_NEAR(logLikelihood({exactAt(1.2, 1)}, {}, PoleIndex({mapPoleAt(1, 1, 0.03)}), options),
              -0.5 * 0.04 / 0.04, 1e-9);
}

TEST(PoleLikelihood, ADetectionWithoutConfidenceHasNoInfluence) {
  PoleDetection doubtful = exactAt(3, 3);
  doubtful.confidence = 0;
  const PoleIndex index({mapPoleAt(3, 3, 0)});
  for (LikelihoodModel model : kModels) {
    const LikelihoodOptions options = optionsOf(model, true);
    const double at = logLikelihood({doubtful}, {}, index, options);
    for (double x : {0.2, 9.0})
      EXPECT_NEAR(logLikelihood({doubtful}, {x, 0, 0}, index, options), at, 1e-15);
    EXPECT_LT(logLikelihood({doubtful}, {9, 0, 0}, index, optionsOf(model, false)), -1);
  }
}

TEST(PoleLikelihood, RefusesOptionsOutOfRange) {
  LikelihoodOptions options;
  options.outlier = 1e-9;
  options.farOutlier = 0.01;  // products of many factors would underflow
  std::vector<double> out;
  EXPECT_THROW(logLikelihood({}, {}, PoleIndex({}), options), Error);
  EXPECT_THROW(logLikelihoods({}, {}, PoleIndex({}), options, out), Error);
}

TEST(PoleLikelihood, RefusesWeightsThatAreNone) {
  const PoleIndex index({});
  const auto refuses = [&](const PoleDetection& pole) {
    // Covariance and confidence are not used unless weighted.
    logLikelihood({pole}, {}, index, optionsOf(LikelihoodModel::mixture, false));
    EXPECT_THROW(logLikelihood({pole}, {}, index, optionsOf(LikelihoodModel::mixture, true)),
                 Error);
  };
  PoleDetection pole = exactAt(1, 1);
  pole.covariance << 0.01, 0.02, 0.02, 0.01;  // indefinite
  refuses(pole);
  pole.covariance << 0.01, 0.001, 0, 0.01;  // not symmetric
  refuses(pole);
  pole.covariance << std::nan(""), 0, 0, 0.01;
  refuses(pole);
  for (double confidence : {-0.1, 1.1, std::nan("")}) {
    pole = exactAt(1, 1);
    pole.confidence = confidence;
    refuses(pole);
  }
}

}  // namespace
}  // namespace polemcl::test_pole_likelihood
