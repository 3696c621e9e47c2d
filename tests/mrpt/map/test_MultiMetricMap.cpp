// A pole map beside MRPT's own maps in one mrpt::maps::CMultiMetricMap.
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <algorithm>
#include <cmath>

#include <polemcl/mrpt/map/CPoleMap.h>
#include "support/Samples.h"

namespace polemcl::test_multi_metric_map {
namespace {

using mrpt::maps::CMetricMap;
using mrpt::maps::COccupancyGridMap2D;
using mrpt::maps::CSimplePointsMap;
using mrpt::obs::CObservation2DRangeScan;
using mrpt::poses::CPose3D;

/// A scan of a wall 2 m ahead: 181 beams over half a circle.
CObservation2DRangeScan wallAhead() {
  CObservation2DRangeScan scan;
  scan.aperture = static_cast<float>(M_PI);
  scan.maxRange = 20;
  scan.resizeScan(181);
  for (std::size_t i = 0; i < 181; ++i) {
    const double angle = (static_cast<double>(i) - 90) * M_PI / 180;
    scan.setScanRange(i, static_cast<float>(2 / std::max(0.2, std::cos(angle))));
    scan.setScanRangeValidity(i, true);
  }
  return scan;
}

struct MultiMetricMap : testing::Test {
  mrpt::maps::CMultiMetricMap maps;
  CPoleMap::Ptr poles;
  COccupancyGridMap2D::Ptr grid;
  CSimplePointsMap::Ptr points;
  const CObservationPoles poleScan = samples::observation();
  const CObservation2DRangeScan laserScan = wallAhead();

  void SetUp() override {
    const mrpt::config::CConfigFileMemory ini(
        std::string("[MetricMap]\npoleMap_count = 1\noccupancyGrid_count = 1\npointsMap_count = 1\n"
                    "[MetricMap_occupancyGrid_00_creationOpts]\nresolution = 0.1\n"
                    "[MetricMap_poleMap_00_likelihoodOpts]\nsigma_m = 0.2\n"));
    mrpt::maps::TSetOfMetricMapInitializers list;
    list.loadFromConfigFile(ini, "MetricMap");
    maps.setListOfMaps(list);
    ASSERT_EQ(maps.maps.size(), 3u);
    poles = maps.mapByClass<CPoleMap>();
    grid = maps.mapByClass<COccupancyGridMap2D>();
    points = maps.mapByClass<CSimplePointsMap>();
    ASSERT_TRUE(poles && grid && points);
  }
};

TEST_F(MultiMetricMap, EachMapTakesWhatItUnderstands) {
  ASSERT_TRUE(maps.insertObservation(poleScan, CPose3D()));
  EXPECT_EQ(poles->poles().size(), poleScan.poles.size());
  EXPECT_TRUE(points->empty());
  EXPECT_NEAR(grid->getPos(1, 0), 0.5, 0.01);  // unknown

  ASSERT_TRUE(maps.insertObservation(laserScan, CPose3D()));
  EXPECT_EQ(poles->poles().size(), poleScan.poles.size());
  EXPECT_FALSE(points->empty());
  EXPECT_GT(grid->getPos(1, 0), 0.5);  // free
}

TEST_F(MultiMetricMap, LikelihoodIsTheSumOfTheMaps) {
  ASSERT_TRUE(maps.insertObservation(poleScan, CPose3D()));
  ASSERT_TRUE(maps.insertObservation(laserScan, CPose3D()));
  EXPECT_EQ(poles->likelihoodOptions.sigma, 0.2);
  EXPECT_TRUE(maps.canComputeObservationLikelihood(poleScan));
  EXPECT_TRUE(maps.canComputeObservationLikelihood(laserScan));

  const CPose3D off(0.3, 0.2, 0, 0.05, 0, 0);
  const double ofPoles = poles->computeObservationLikelihood(poleScan, off);
  EXPECT_LT(ofPoles, poles->computeObservationLikelihood(poleScan, CPose3D()) - 0.1);
  EXPECT_EQ(maps.computeObservationLikelihood(poleScan, off), ofPoles);
  const double ofLaser = grid->computeObservationLikelihood(laserScan, off) +
                         points->computeObservationLikelihood(laserScan, off);
  EXPECT_NE(ofLaser, 0);
  EXPECT_NEAR(maps.computeObservationLikelihood(laserScan, off), ofLaser, 1e-9);
}

}  // namespace
}  // namespace polemcl::test_multi_metric_map
