#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "core/mapping/ObservationClustering.h"
#include "support/Poles.h"

namespace polemcl::test_observation_clustering {
namespace {

using Groups = std::vector<std::vector<std::uint32_t>>;

LandmarkObservation observation(double x, double y, std::uint32_t view) {
  LandmarkObservation s;
  s.pole = tests::detectionAt(x, y, 0.0025);
  s.scan = view;
  return s;
}

std::set<std::set<std::uint32_t>> asSets(const Groups& groups) {
  std::set<std::set<std::uint32_t>> sets;
  for (const auto& group : groups) sets.insert({group.begin(), group.end()});
  return sets;
}

void expectInvariants(const std::vector<LandmarkObservation>& observations, const Groups& groups,
                      const ClusteringOptions& options) {
  std::vector<int> used(observations.size(), 0);
  double lastX = -1e300;
  for (const auto& group : groups) {
    ASSERT_FALSE(group.empty());
    const Eigen::Vector2d centre = fusedCentre(observations, group);
    EXPECT_GE(centre.x(), lastX);
    lastX = centre.x();
    std::set<std::uint32_t> views;
    for (const std::uint32_t member : group) {
      EXPECT_EQ(used[member]++, 0);
      EXPECT_TRUE(views.insert(observations[member].scan).second) << "two of one view";
      EXPECT_LT((Eigen::Vector2d(observations[member].pole.x, observations[member].pole.y) - centre)
                    .norm(),
                options.mergeDistance);
    }
  }
}

/// Poles far apart, each seen with little noise in a random share of the views: no doubt who
/// belongs to whom. The truth comes as one set of observations for each pole.
struct Easy {
  std::vector<LandmarkObservation> observations;
  std::set<std::set<std::uint32_t>> truth;
};
Easy easyScene(std::uint64_t seed, double spread) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> noise(-spread, spread);
  Easy easy;
  std::vector<std::set<std::uint32_t>> sets(60);
  for (std::uint32_t view = 0; view < 40; ++view) {
    for (std::size_t pole = 0; pole < sets.size(); ++pole) {
      if (random() % 3 == 0) continue;
      sets[pole].insert(static_cast<std::uint32_t>(easy.observations.size()));
      easy.observations.push_back(
          observation(1.5 * (pole % 8) + noise(random), 1.5 * (pole / 8) + noise(random), view));
    }
  }
  easy.truth = {sets.begin(), sets.end()};
  return easy;
}

TEST(ObservationClustering, FindsThePolesWhereThereIsNoDoubt) {
  for (std::uint64_t seed : {1, 2, 3}) {
    const Easy easy = easyScene(seed, 0.2);
    const Groups groups = clusterObservations(easy.observations, {0.5, 0.25});
    EXPECT_EQ(asSets(groups), easy.truth);
    expectInvariants(easy.observations, groups, {0.5, 0.25});
  }
}

TEST(ObservationClustering, AChainDoesNotRunTogether) {
  // A hedge: an observation every 0.3 m over 9 m. Connected components at 0.5 m would make one of
  // it.
  std::vector<LandmarkObservation> observations;
  for (std::uint32_t i = 0; i <= 30; ++i) observations.push_back(observation(0.3 * i, 0, i));
  const ClusteringOptions options{0.5, 0.25};
  const Groups groups = clusterObservations(observations, options);
  expectInvariants(observations, groups, options);
  EXPECT_GE(groups.size(), 8u);
  for (const auto& group : groups) EXPECT_LE(group.size(), 4u);
}

TEST(ObservationClustering, TwoOfOneScanAreTwoPoles) {
  // 0.4 m apart, both seen in every scan, with a noise that the gate is far wider than.
  std::mt19937_64 random(4);
  std::normal_distribution<double> noise(0, 0.03);
  std::vector<LandmarkObservation> observations;
  for (std::uint32_t view = 0; view < 30; ++view) {
    observations.push_back(observation(noise(random), noise(random), view));
    observations.push_back(observation(0.4 + noise(random), noise(random), view));
  }
  const Groups groups = clusterObservations(observations, {0.5, 0.25});
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_NEAR(fusedCentre(observations, groups[0]).x(), 0, 0.02);
  EXPECT_NEAR(fusedCentre(observations, groups[1]).x(), 0.4, 0.02);
  EXPECT_EQ(groups[0].size(), 30u);
  EXPECT_EQ(groups[1].size(), 30u);
}

TEST(ObservationClustering, ScansThatMissOneOfTwoGoToTheOneTheySaw) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0, 0.03);
  std::vector<LandmarkObservation> observations;
  std::size_t first = 0, second = 0;
  for (std::uint32_t view = 0; view < 60; ++view) {
    if (view % 3 != 0)
      observations.push_back(observation(noise(random), noise(random), view)), ++first;
    if (view % 3 != 1)
      observations.push_back(observation(0.4 + noise(random), noise(random), view)), ++second;
  }
  const Groups groups = clusterObservations(observations, {0.5, 0.25});
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].size(), first);
  EXPECT_EQ(groups[1].size(), second);
}

TEST(ObservationClustering, ASecondSightingNowAndThenIsNoPole) {
  // One pole; two of 30 scans see something else 0.3 m beside it, too.
  std::vector<LandmarkObservation> observations;
  for (std::uint32_t view = 0; view < 30; ++view) observations.push_back(observation(0, 0, view));
  observations.push_back(observation(0.3, 0, 4));
  observations.push_back(observation(0.3, 0, 9));
  const Groups groups = clusterObservations(observations, {0.5, 0.25});
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_EQ(groups[0].size(), 30u);
  // With a share so small that two of 30 suffice they are two poles.
  EXPECT_EQ(clusterObservations(observations, {0.5, 0.05}).size(), 2u);
}

TEST(ObservationClustering, OneEachSplitByAPoorPoseIsMerged) {
  // The same pole from two drives that disagree by 0.45 m.
  std::vector<LandmarkObservation> observations;
  for (std::uint32_t view = 0; view < 10; ++view)
    observations.push_back(observation(0.002 * view, 0, view));
  for (std::uint32_t view = 10; view < 20; ++view)
    observations.push_back(observation(0.45, 0.002 * view, view));
  const Groups groups = clusterObservations(observations, {0.5, 0.25});
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_EQ(groups[0].size(), 20u);
}

// 60 scans see something at 0, 22 at -0.4 m and 22 at 0.45 m; few see two of them. With the nearer
// neighbour the centre moves to -0.1 m, and the other one is out of its gate.
TEST(ObservationClustering, OnlyTheNearerOfTwoNeighboursIsMerged) {
  std::vector<LandmarkObservation> observations;
  for (std::uint32_t view = 0; view < 100; ++view) {
    if (view < 60) observations.push_back(observation(0, 0, view));
    if (view < 2 || (view >= 60 && view < 80)) observations.push_back(observation(-0.4, 0, view));
    if (view == 2 || view == 3 || view >= 80) observations.push_back(observation(0.45, 0, view));
  }
  for (LandmarkObservation& seen : observations)  // so vague that none is an outlier
    seen.pole.covariance = 0.04 * Eigen::Matrix2d::Identity();
  const Groups groups = clusterObservations(observations, {0.5, 0.25});
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].size(), 80u);
  EXPECT_NEAR(fusedCentre(observations, groups[0]).x(), -0.1, 1e-6);
  EXPECT_EQ(groups[1].size(), 22u);
}

TEST(ObservationClustering, TheGateIsStrict) {
  EXPECT_EQ(clusterObservations({observation(0, 0, 0), observation(1, 0, 1)}, {1.0, 0.25}).size(),
            2u);
  EXPECT_EQ(
      clusterObservations({observation(0, 0, 0), observation(0.999, 0, 1)}, {1.0, 0.25}).size(),
      1u);
}

TEST(ObservationClustering, TheOrderOfTheSightingsIsOfNoConsequence) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> coordinate(0, 6);
  std::vector<LandmarkObservation> observations;
  for (int i = 0; i < 400; ++i)
    observations.push_back(observation(coordinate(random), coordinate(random), random() % 40));
  const ClusteringOptions options{0.5, 0.25};
  const Groups groups = clusterObservations(observations, options);
  std::vector<std::uint32_t> order(observations.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), random);
  std::vector<LandmarkObservation> shuffled;
  for (const std::uint32_t i : order) shuffled.push_back(observations[i]);
  Groups back = clusterObservations(shuffled, options);
  ASSERT_EQ(back.size(), groups.size());
  for (std::size_t g = 0; g < back.size(); ++g) {
    for (std::uint32_t& member : back[g]) member = order[member];
    EXPECT_EQ(back[g], groups[g]);
  }
}

TEST(ObservationClustering, HoldsItsInvariantsOnClutter) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> coordinate(0, 3 + seed);
    std::vector<LandmarkObservation> observations;
    for (int i = 0; i < 500; ++i) {
      LandmarkObservation s =
          observation(coordinate(random), coordinate(random), random() % (5 + 5 * seed));
      s.pole.confidence = 0.1 + 0.9 * coordinate(random) / (3.0 + seed);
      observations.push_back(s);
    }
    const ClusteringOptions options{0.3 + 0.05 * seed, 0.25};
    expectInvariants(observations, clusterObservations(observations, options), options);
  }
}

TEST(ObservationClustering, HoldsItsInvariantsWhereCentresDoNotSettle) {
  // Few observations of very different certainty: centres jump, and the dealing may go round in
  // circles.
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> coordinate(0, 0.8 + 0.007 * seed), sigma(0.001, 0.2);
    std::vector<LandmarkObservation> observations;
    for (std::uint64_t i = 0; i < 20 + seed % 60; ++i) {
      LandmarkObservation s =
          observation(coordinate(random), coordinate(random), random() % (5 + seed % 37));
      s.pole.covariance = std::pow(sigma(random), 2) * Eigen::Matrix2d::Identity();
      observations.push_back(s);
    }
    expectInvariants(observations, clusterObservations(observations, {0.5, 0.25}), {0.5, 0.25});
  }
}

TEST(ObservationClustering, CopesWithPilesOfEqualSightings) {
  std::vector<LandmarkObservation> observations;
  for (std::uint32_t i = 0; i < 300; ++i) observations.push_back(observation(1, 1, i % 3));
  const Groups groups = clusterObservations(observations, {0.5, 0.25});
  expectInvariants(observations, groups, {0.5, 0.25});
  for (const auto& group : groups) EXPECT_EQ(group.size(), 3u);
}

TEST(ObservationClustering, NothingToMerge) {
  EXPECT_TRUE(clusterObservations({}, {}).empty());
}

}  // namespace
}  // namespace polemcl::test_observation_clustering
