#include <gtest/gtest.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/poses/CPose2D.h>
#include <mrpt/slam/CICP.h>
#include <mrpt/tfest/TMatchingPair.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include <polemcl/mrpt/map/CPoleMap.h>
#include "support/Refusal.h"

namespace polemcl::test_cpole_map_matching {
namespace {
using mrpt::maps::TMatchingExtraResults;
using mrpt::maps::TMatchingParams;
using mrpt::poses::CPose2D;
using mrpt::poses::CPose3D;
using mrpt::tfest::TMatchingPairList;

CPoleMap randomMap(unsigned seed, int poles) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> anywhere(-30, 30);
  std::vector<MapPole> all(static_cast<std::size_t>(poles));
  for (auto& pole : all) {
    pole.x = anywhere(random);
    pole.y = anywhere(random);
    pole.count = 1;
  }
  CPoleMap map;
  map.setPoles(all);
  return map;
}

Eigen::Vector2d composed(const CPose2D& pose, double x, double y) {
  return Eigen::Rotation2Dd(pose.phi()) * Eigen::Vector2d(x, y) +
         Eigen::Vector2d(pose.x(), pose.y());
}

/// The same poles, as a vehicle at this pose sees them.
CPoleMap seenFrom(const CPoleMap& map, const CPose2D& pose) {
  std::vector<MapPole> poles = map.poles();
  for (auto& pole : poles) {
    const Eigen::Vector2d local =
        Eigen::Rotation2Dd(-pose.phi()) * Eigen::Vector2d(pole.x - pose.x(), pole.y - pose.y());
    pole.x = local.x();
    pole.y = local.y();
  }
  CPoleMap seen;
  seen.setPoles(poles);
  return seen;
}

using Pair = std::pair<std::size_t, std::size_t>;  ///< this map's pole, the other's

/// By comparing all poles with all.
std::vector<Pair> bruteForce(const CPoleMap& map, const CPoleMap& other, const CPose2D& pose,
                             const TMatchingParams& params) {
  std::vector<Pair> pairs;
  for (std::size_t i = params.offset_other_map_points; i < other.poles().size();
       i += params.decimation_other_map_points) {
    const auto place = composed(pose, other.poles()[i].x, other.poles()[i].y);
    const double radius = params.maxDistForCorrespondence +
                          params.maxAngularDistForCorrespondence *
                              std::hypot(place.x() - params.angularDistPivotPoint.x,
                                         place.y() - params.angularDistPivotPoint.y);
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t k = 0; k < map.poles().size(); ++k) {
      const double distance =
          std::hypot(map.poles()[k].x - place.x(), map.poles()[k].y - place.y());
      if (distance < radius) near.push_back({distance, k});
    }
    std::sort(near.begin(), near.end());
    if (params.onlyKeepTheClosest && near.size() > 1) near.resize(1);
    for (const auto& [distance, k] : near) pairs.push_back({k, i});
  }
  return pairs;
}

std::vector<Pair> indices(const TMatchingPairList& pairs) {
  std::vector<Pair> result;
  for (const auto& pair : pairs) result.push_back({pair.globalIdx, pair.localIdx});
  return result;
}

std::string refusal(const CPoleMap& map, const mrpt::maps::CMetricMap* other,
                    const TMatchingParams& params = {}) {
  TMatchingPairList pairs;
  TMatchingExtraResults results;
  return tests::messageOf(
      [&] { map.determineMatching2D(other, CPose2D(), pairs, params, results); });
}

TEST(CPoleMapMatching, PairsAreThoseOfBruteForce) {
  const CPoleMap map = randomMap(1, 80), other = randomMap(2, 60);
  const CPose2D pose(1.5, -2, 0.3);
  TMatchingParams params;
  params.maxDistForCorrespondence = 2;
  std::vector<TMatchingParams> all{params};
  all.push_back(params);
  all.back().onlyKeepTheClosest = false;
  all.push_back(params);
  all.back().maxAngularDistForCorrespondence = 0.1f;
  all.back().angularDistPivotPoint = {3, 4, 0};
  all.push_back(params);
  all.back().decimation_other_map_points = 3;
  all.back().offset_other_map_points = 2;
  for (const auto& each : all) {
    const auto expected = bruteForce(map, other, pose, each);
    ASSERT_FALSE(expected.empty());
    TMatchingPairList flat, solid;
    TMatchingExtraResults results;
    map.determineMatching2D(&other, pose, flat, each, results);
    EXPECT_EQ(indices(flat), expected);
    map.determineMatching3D(&other, CPose3D(pose), solid, each, results);
    EXPECT_EQ(indices(solid), expected);
    double squares = 0;
    for (const auto& pair : flat) {
      const auto place = composed(pose, pair.local.x, pair.local.y);
      squares += std::pow(pair.global.x - place.x(), 2) + std::pow(pair.global.y - place.y(), 2);
    }
    EXPECT_NEAR(results.sumSqrDist, squares / static_cast<double>(flat.size()), 1e-4);
  }
}

TEST(CPoleMapMatching, RatioIsTheShareWithAPartner) {
  const CPoleMap map = randomMap(1, 80), other = randomMap(2, 60);
  mrpt::maps::TMatchingRatioParams params;
  params.maxDistForCorr = 1.5f;
  TMatchingParams same;
  same.maxDistForCorrespondence = 1.5f;
  const auto expected = bruteForce(map, other, CPose2D(1, 2, 0.1), same);
  EXPECT_FLOAT_EQ(map.compute3DMatchingRatio(&other, CPose3D(CPose2D(1, 2, 0.1)), params),
                  static_cast<float>(expected.size()) / 60);
  EXPECT_EQ(map.compute3DMatchingRatio(&map, CPose3D(), params), 1);
  const CPoleMap none;
  EXPECT_EQ(map.compute3DMatchingRatio(&none, CPose3D(), params), 0);
  EXPECT_EQ(none.compute3DMatchingRatio(&map, CPose3D(), params), 0);
}

TEST(CPoleMapMatching, EachPoleOnceIfAsked) {
  CPoleMap map, other;
  std::vector<MapPole> two(2);
  two[1].x = 0.4;
  map.setPoles({two[0]});
  other.setPoles(two);
  TMatchingParams params;
  TMatchingPairList pairs;
  TMatchingExtraResults results;
  map.determineMatching2D(&other, CPose2D(), pairs, params, results);
  EXPECT_EQ(pairs.size(), 2u);
  params.onlyUniqueRobust = true;
  map.determineMatching2D(&other, CPose2D(), pairs, params, results);
  EXPECT_EQ(indices(pairs), (std::vector<Pair>{{0, 0}}));
}

TEST(CPoleMapMatching, SquaredDistanceToTheNearest) {
  const CPoleMap map = randomMap(3, 50);
  for (const auto& [x, y] : {std::pair{0.0f, 0.0f}, {500.0f, -3.0f}, {-12.0f, 7.0f}}) {
    double least = 1e18;
    for (const auto& pole : map.poles())
      least = std::min(least, std::pow(pole.x - x, 2) + std::pow(pole.y - y, 2));
    EXPECT_FLOAT_EQ(map.squareDistanceToClosestCorrespondence(x, y), static_cast<float>(least));
  }
  EXPECT_TRUE(std::isinf(CPoleMap().squareDistanceToClosestCorrespondence(0, 0)));
}

// Poles that a vehicle sees, on the map: ICP of MRPT finds where it stands.
TEST(CPoleMapMatching, IcpFindsThePose) {
  const CPoleMap map = randomMap(4, 40);
  const CPose2D truth(3, -2, 0.2);
  const CPoleMap seen = seenFrom(map, truth);
  mrpt::slam::CICP icp;
  icp.options.thresholdDist = 2;
  icp.options.thresholdAng = 0;
  icp.options.onlyUniqueRobust = true;
  const auto pose = icp.Align(&map, &seen, CPose2D(2.6, -1.7, 0.16))->getMeanVal();
  EXPECT_NEAR(pose.x(), truth.x(), 1e-3);
  EXPECT_NEAR(pose.y(), truth.y(), 1e-3);
  EXPECT_NEAR(pose.phi(), truth.phi(), 1e-4);
}

TEST(CPoleMapMatching, RefusesOtherMapsAndParameters) {
  const CPoleMap map = randomMap(5, 3);
  const mrpt::maps::CSimplePointsMap points;
  EXPECT_HAS(refusal(map, &points), "not with mrpt::maps::CSimplePointsMap");
  TMatchingParams params;
  params.offset_other_map_points = 1;
  EXPECT_HAS(refusal(map, &map, params), "offset_other_map_points");
  params = {};
  params.onlyUniqueRobust = true;
  params.onlyKeepTheClosest = false;
  EXPECT_HAS(refusal(map, &map, params), "onlyUniqueRobust");
}

}  // namespace
}  // namespace polemcl::test_cpole_map_matching
