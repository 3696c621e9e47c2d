#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "core/sensor/BeamTableEstimator.h"
#include "support/Clouds.h"
#include "support/Refusal.h"
#include "support/SimulatedScans.h"

namespace polemcl::test_beam_table_estimator {
namespace {

using polemcl::clouds::kDegree;
using polemcl::clouds::PointList;

PointList street(const std::string& lidar, double height, std::uint64_t world = 3) {
  PointList points;
  points.append(clouds::streetScans(world, lidar, height, 1).front().scan.view());
  return points;
}

/// Every beam of the list lies beside a true one, and at least `share` of the true ones is there.
void expectBeams(const BeamTableEstimate& estimate, const sim::LidarModel& lidar, double share) {
  const auto found = estimate.elevations();
  for (const double elevation : found) {
    double nearest = 1;
    for (const sim::Beam& beam : lidar.beams)
      nearest = std::min(nearest, std::abs(beam.elevation - elevation));
    EXPECT_LT(nearest, 0.06 * kDegree) << elevation / kDegree;
  }
  EXPECT_LE(found.size(), lidar.beams.size());
  EXPECT_GE(static_cast<double>(found.size()), share * static_cast<double>(lidar.beams.size()));
}

/// Returns of one laser, all around and 4 m to 30 m away; `apex` is its height over the origin, m.
void addRing(PointList& points, double elevationDeg, int returns, double apex = 0) {
  for (int i = 0; i < returns; ++i) {
    const double rho = 4 + 26 * std::fmod(0.618034 * i, 1), azimuth = 2 * M_PI * i / returns;
    points.add(rho * std::cos(azimuth), rho * std::sin(azimuth),
               apex + rho * std::tan(elevationDeg * kDegree));
  }
}

void expectSame(const BeamTableEstimate& a, const BeamTableEstimate& b) {
  EXPECT_EQ(a.elevations(), b.elevations());
  EXPECT_EQ(a.origin.z, b.origin.z);
  EXPECT_EQ(a.sharpness, b.sharpness);
  EXPECT_EQ(a.spread, b.spread);
}

class BeamFinderOnStreets : public ::testing::TestWithParam<std::pair<const char*, double>> {};

TEST_P(BeamFinderOnStreets, FindsTheBeamsOfTheLidar) {
  const auto [name, height] = GetParam();
  const BeamTableEstimate estimate = estimateBeamTable({street(name, height).view()});
  expectBeams(estimate, sim::makeLidar(name), 0.9);
  EXPECT_EQ(estimate.blocks.size(), 1u);
  EXPECT_EQ(estimate.origin.x, 0);
  EXPECT_EQ(estimate.origin.z, 0);
  EXPECT_EQ(estimate.origin.slide, 0);
  EXPECT_GT(estimate.sharpness, 0.98);
}

INSTANTIATE_TEST_SUITE_P(Lidars, BeamFinderOnStreets,
                         ::testing::Values(std::pair{"hdl32e", 1.0}, std::pair{"vlp16", 1.0},
                                           std::pair{"os1_64", 1.8}, std::pair{"os1_128", 1.8},
                                           std::pair{"os0_64", 1.0}));

// Upper lasers of the HDL-64E start at 0.2 m, lower ones at 0.12 m.
TEST(BeamTableEstimator, TellsTwoBlocksApart) {
  const BeamTableEstimate estimate = estimateBeamTable({street("hdl64e", 1.73).view()});
  ASSERT_EQ(estimate.blocks.size(), 2u);
  EXPECT_EQ(estimate.blocks[0].elevations.size(), 32u);
  EXPECT_EQ(estimate.blocks[1].elevations.size(), 32u);
  EXPECT_NEAR(estimate.blocks[0].apex, 0.2, 0.005);
  EXPECT_NEAR(estimate.blocks[1].apex, 0.12, 0.015);
  // An apex that is a little off moves elevations of ground rings by as much, seen from 5 m.
  for (const auto& beam : sim::makeLidar("hdl64e").beams) {
    double nearest = 1;
    for (const double elevation : estimate.elevations())
      nearest = std::min(nearest, std::abs(beam.elevation - elevation));
    EXPECT_LT(nearest, 0.15 * kDegree) << beam.elevation / kDegree;
  }
}

TEST(BeamTableEstimator, TheOriginMayLieBetweenTwoBlocks) {
  PointList points;
  for (int k = 0; k < 6; ++k) {
    addRing(points, 3 - 1.5 * k, 300, 0.1);
    addRing(points, -9 - 2 * k, 300, -0.1);
  }
  const BeamTableEstimate estimate = estimateBeamTable({points.view()});
  ASSERT_EQ(estimate.blocks.size(), 2u);
  EXPECT_NEAR(estimate.blocks[0].apex, 0.1, 0.005);
  EXPECT_NEAR(estimate.blocks[1].apex, -0.1, 0.005);
  EXPECT_EQ(estimate.beams(), 12);
}

// 35 % of each laser's returns lie 0.065 degrees higher than the others.
TEST(BeamTableEstimator, ABeamIsTheMeanOfItsReturns) {
  PointList points;
  for (int k = 0; k < 8; ++k) {
    addRing(points, -10 + 2 * k, 390);
    addRing(points, -10 + 2 * k + 0.065, 210);
  }
  const std::vector<double> found = estimateBeamTable({points.view()}).elevations();
  ASSERT_EQ(found.size(), 8u);
  for (int k = 0; k < 8; ++k)
    EXPECT_NEAR(found[7 - k] / kDegree, -10 + 2 * k + 0.35 * 0.065, 0.007) << k;
}

// Most lasers look into the sky, three at the ground: a full one has 2000 returns, and stray ones
// are a hundredth of that.
TEST(BeamTableEstimator, StrayReturnsAreNoBeamEvenWhereMostBeamsHaveFew) {
  PointList points;
  for (int k = 0; k < 9; ++k) addRing(points, -20 + 2 * k, k < 3 ? 2000 : 300);
  addRing(points, 1, 20);
  EXPECT_EQ(estimateBeamTable({points.view()}).beams(), 9);
}

TEST(BeamTableEstimator, TwoBeamsAreEnough) {
  PointList points;
  addRing(points, -1, 1500);
  addRing(points, -3, 1500);
  const std::vector<double> found = estimateBeamTable({points.view()}).elevations();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found[0], -1 * kDegree, 0.01 * kDegree);
  EXPECT_NEAR(found[1], -3 * kDegree, 0.01 * kDegree);
}

TEST(BeamTableEstimator, OrderAndInvalidPointsAreOfNoConsequence) {
  const PointList points = street("hdl32e", 1.0);
  const BeamTableEstimate estimate = estimateBeamTable({points.view()});
  expectSame(estimateBeamTable({clouds::shuffled(points.view(), 5).view()}), estimate);
  PointList spoilt;
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 500; ++i) {
    spoilt.add(0, 0, 0);
    spoilt.add(nan, 1, 1);
    spoilt.add(9, inf, 0);
    spoilt.add(9, 0, -inf);
  }
  spoilt.append(points.view());
  expectSame(estimateBeamTable({spoilt.view()}), estimate);
}

TEST(BeamTableEstimator, ATenthOfTheReturnsIsEnough) {
  const PointList points = street("os1_64", 1.8);
  PointList few;
  sim::Random random(4);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (random.uniform(0, 1) < 0.1) few.add(points.x[i], points.y[i], points.z[i]);
  expectBeams(estimateBeamTable({few.view()}), sim::makeLidar("os1_64"), 0.95);
}

TEST(BeamTableEstimator, FindsTheOriginOfCloudsInAnotherFrame) {
  const PointList points = street("hdl32e", 1.0);
  PointList moved;
  for (std::size_t i = 0; i < points.size(); ++i)
    moved.add(points.x[i] + 0.9, points.y[i] - 0.2, points.z[i] + 1.2);
  const BeamTableEstimate estimate = estimateBeamTable({moved.view()});
  EXPECT_NEAR(estimate.origin.x, 0.9, 0.01);
  EXPECT_NEAR(estimate.origin.y, -0.2, 0.01);
  EXPECT_NEAR(estimate.origin.z, 1.2, 0.005);
  expectBeams(estimate, sim::makeLidar("hdl32e"), 0.95);
}

// Points moved to where the sensor was in the middle of a turn that began at the rear.
TEST(BeamTableEstimator, SeesThroughMotionCorrection) {
  const PointList points = street("os1_64", 1.8);
  PointList corrected;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double azimuth = std::atan2(points.y[i], points.x[i]);
    corrected.add(points.x[i] - 0.8 * azimuth / (2 * M_PI), points.y[i], points.z[i]);
  }
  const BeamTableEstimate estimate = estimateBeamTable({corrected.view()});
  EXPECT_NEAR(estimate.origin.slide, 0.8, 0.1);
  expectBeams(estimate, sim::makeLidar("os1_64"), 0.95);
}

TEST(BeamTableEstimator, RefusesCloudsWithoutBeams) {
  const PointList points = street("hdl32e", 1.0);
  PointList merged, thinned, tilted;
  std::set<std::tuple<long, long, long>> voxels;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = points.x[i], y = points.y[i], z = points.z[i];
    merged.add(x, y, z);
    merged.add(x + 1.3, y + 0.1, z + 0.02 * x + 0.1);
    const auto cell = [](double v) { return std::lround(v / 0.2); };
    if (voxels.emplace(cell(x), cell(y), cell(z)).second)
      thinned.add(0.2 * cell(x), 0.2 * cell(y), 0.2 * cell(z));
    tilted.add(x, y, z + std::tan(3 * kDegree) * x);
  }
  sim::Random random(1);
  PointList blob;
  for (int i = 0; i < 20000; ++i)
    blob.add(20 * random.normal(), 20 * random.normal(), 2 * random.normal());
  for (const PointList* cloud : {&merged, &thinned, &tilted, &blob})
    EXPECT_REFUSED(estimateBeamTable({cloud->view()}), "no beams");
}

TEST(BeamTableEstimator, RefusesTooFewPoints) {
  PointList few;
  for (int i = 0; i < 1999; ++i) few.addPolar(0.003 * i, 0.01 * (i % 5), 10);
  EXPECT_REFUSED(estimateBeamTable({few.view()}), "1999");
  EXPECT_REFUSED(estimateBeamTable({{}}), "2000 are needed");
}

}  // namespace
}  // namespace polemcl::test_beam_table_estimator
