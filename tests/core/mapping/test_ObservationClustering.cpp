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

LandmarkObservation observation(double x, double y, double radius, std::uint32_t view = 0) {
  LandmarkObservation result;
  result.pole.x = x;
  result.pole.y = y;
  result.pole.radius = radius;
  result.scan = view;
  return result;
}

/// Components by spreading from each observation over all that overlap, without an index.
Groups spread(const std::vector<LandmarkObservation>& all) {
  const auto overlap = [&](std::size_t i, std::size_t j) {
    const PoleDetection &a = all[i].pole, &b = all[j].pole;
    const double reach = a.radius + b.radius;
    return std::abs(a.x - b.x) <= reach && std::abs(a.y - b.y) <= reach;
  };
  Groups groups;
  std::vector<bool> done(all.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    if (done[i]) continue;
    std::vector<std::uint32_t> group{i};
    done[i] = true;
    for (std::size_t k = 0; k < group.size(); ++k)
      for (std::uint32_t j = 0; j < all.size(); ++j)
        if (!done[j] && overlap(group[k], j)) {
          done[j] = true;
          group.push_back(j);
        }
    std::sort(group.begin(), group.end());
    groups.push_back(group);
  }
  return groups;
}

std::vector<LandmarkObservation> randomSightings(std::uint64_t seed, int count) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(-10, 10), radius(0.02, 0.4);
  std::vector<LandmarkObservation> all;
  for (int i = 0; i < count; ++i)
    all.push_back(observation(4e5 + place(random), 5e6 + place(random), radius(random)));
  return all;
}

TEST(BoxMerging, JoinsByHand) {
  // 0 and 1 overlap; 2 touches 1 by an edge; 3 shares only a corner with 2; 4 stands alone,
  // nearer to 0 than 0.5 m.
  const std::vector<LandmarkObservation> all{
      observation(0, 0, 0.25), observation(0.375, 0, 0.25), observation(0.875, 0, 0.25),
      observation(1.375, 0.5, 0.25), observation(-0.4375, 0, 0.125)};
  EXPECT_EQ(joinOverlappingBoxes(all), (Groups{{0, 1, 2, 3}, {4}}));
}

TEST(BoxMerging, BoxesAreSquaresRoundTheCentre) {
  // Circles of 0.1 m do not meet at a diagonal distance of 0.27 m, their boxes do.
  EXPECT_EQ(joinOverlappingBoxes({observation(0, 0, 0.1), observation(0.19, 0.19, 0.1)}).size(),
            1u);
  EXPECT_EQ(joinOverlappingBoxes({observation(0, 0, 0.1), observation(0.19, 0.21, 0.1)}).size(),
            2u);
}

TEST(BoxMerging, EqualsSpreadingOverAllPairs) {
  for (const int count : {0, 1, 2, 50, 400, 1500}) {
    const auto all = randomSightings(count, count);
    EXPECT_EQ(joinOverlappingBoxes(all), spread(all)) << count;
  }
  // With 400 in 20 m by 20 m neither one group nor one for each observation: the test says
  // something.
  const auto groups = joinOverlappingBoxes(randomSightings(400, 400)).size();
  EXPECT_GT(groups, 150u);
  EXPECT_LT(groups, 350u);
}

TEST(BoxMerging, PlainMeanByHand) {
  std::vector<LandmarkObservation> all{observation(1, 2, 0.1), observation(2, 4, 0.2),
                                       observation(6, 0, 0.6)};
  for (int i = 0; i < 3; ++i) {
    all[i].pole.bottom = i;
    all[i].pole.top = 3 + 2 * i;
    all[i].pole.confidence = 0.5 + 0.25 * i;
    all[i].pole.covariance = Eigen::Vector2d(0.09, 0.18).asDiagonal();
  }
  const MapPole mean = plainMean(all, {0, 1, 2});
  EXPECT_NEAR(mean.x, 3, 1e-12);
  EXPECT_NEAR(mean.y, 2, 1e-12);
  EXPECT_NEAR(mean.radius, 0.3, 1e-12);
  EXPECT_NEAR(mean.bottom, 1, 1e-12);
  EXPECT_NEAR(mean.top, 5, 1e-12);
  EXPECT_NEAR(mean.confidence, 0.75, 1e-12);
  EXPECT_NEAR(mean.covariance(0, 0), 0.03, 1e-12);
  EXPECT_NEAR(mean.covariance(1, 1), 0.06, 1e-12);
  EXPECT_EQ(mean.count, 3u);
  const MapPole pair = plainMean(all, {2, 0});
  EXPECT_NEAR(pair.x, 3.5, 1e-12);
  EXPECT_EQ(pair.count, 2u);
}

TEST(BoxMerging, TheMeanDoesNotDependOnTheOrder) {
  auto all = randomSightings(3, 60);
  std::vector<std::uint32_t> members(all.size());
  for (std::uint32_t i = 0; i < members.size(); ++i) members[i] = i;
  const MapPole before = plainMean(all, members);
  std::reverse(all.begin(), all.end());
  const MapPole after = plainMean(all, members);
  EXPECT_EQ(before.x, after.x);
  EXPECT_EQ(before.y, after.y);
  EXPECT_EQ(before.radius, after.radius);
  EXPECT_NEAR(before.x, 4e5, 10);
}

}  // namespace

}  // namespace polemcl::test_observation_clustering
