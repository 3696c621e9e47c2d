#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <polemcl/core/common/Types.h>
#include "sim/lidar/LidarModel.h"
#include "support/Refusal.h"

namespace polemcl::test_lidar_model {
namespace {

using namespace polemcl::sim;

constexpr double kDegree = M_PI / 180;
struct Sheet {
  const char* name;
  std::size_t beams;
  double topDeg, bottomDeg;
};
TEST(LidarModel, BeamsAreThoseOfTheDataSheets) {
  for (const Sheet& sheet : {Sheet{"hdl64e", 64, 2, -24.33}, Sheet{"hdl32e", 32, 10.67, -30.67},
                             Sheet{"vlp16", 16, 15, -15}, Sheet{"os1_64", 64, 16.6, -16.6},
                             Sheet{"os1_128", 128, 22.5, -22.5}, Sheet{"os0_64", 64, 45, -45}}) {
    const LidarModel lidar = makeLidar(sheet.name);
    ASSERT_EQ(lidar.beams.size(), sheet.beams) << sheet.name;
    EXPECT_NEAR(lidar.beams.front().elevation / kDegree, sheet.topDeg, 0.25) << sheet.name;
    EXPECT_NEAR(lidar.beams.back().elevation / kDegree, sheet.bottomDeg, 0.25) << sheet.name;
  }
}

TEST(LidarModel, Hdl64HasTwoBlocksThatStartAtDifferentHeights) {
  const LidarModel lidar = makeLidar("hdl64e");
  EXPECT_NEAR((lidar.beams[0].elevation - lidar.beams[31].elevation) / kDegree, 31.0 / 3, 0.3);
  EXPECT_NEAR((lidar.beams[32].elevation - lidar.beams[63].elevation) / kDegree, 31.0 / 2, 0.3);
  EXPECT_NEAR(lidar.beams[3].rise, 0.2, 0.02);
  EXPECT_NEAR(lidar.beams[40].rise, 0.12, 0.02);
}

TEST(LidarModel, UnitsDifferALittleAndEachIsAlwaysTheSame) {
  const LidarModel one = makeLidar("vlp16", false, 1), two = makeLidar("vlp16", false, 2),
                   again = makeLidar("vlp16", false, 1);
  for (std::size_t i = 0; i < one.beams.size(); ++i) {
    EXPECT_EQ(one.beams[i].elevationError, again.beams[i].elevationError);
    EXPECT_NE(one.beams[i].elevationError, two.beams[i].elevationError);
    EXPECT_LT(std::abs(one.beams[i].elevationError), 0.2 * kDegree);
  }
}

TEST(LidarModel, HangingItKeepsBeamsFromTopToBottom) {
  const LidarModel hanging = makeLidar("hdl32e", true);
  EXPECT_NEAR(hanging.beams.front().elevation / kDegree, 30.67, 0.01);
  EXPECT_NEAR(hanging.beams.back().elevation / kDegree, -10.67, 0.01);
  EXPECT_TRUE(
      std::is_sorted(hanging.beams.begin(), hanging.beams.end(),
                     [](const Beam& a, const Beam& b) { return a.elevation > b.elevation; }));
}

TEST(LidarModel, ListedBeamsAreSimulatedAsTheyAreListed) {
  SimulationOptions options;
  SensorOptions beams;
  options.sensor = "table";
  beams.elevations = {0.1, -0.05, 0.02};
  beams.lowerElevations = {-0.2, -0.1};
  beams.upperApex = 0.2;
  beams.lowerApex = 0.12;
  beams.columns = 900;
  const LidarModel lidar = makeLidar(options, beams);
  const std::vector<double> elevations{0.1, 0.02, -0.05, -0.1, -0.2};
  ASSERT_EQ(lidar.beams.size(), elevations.size());
  for (std::size_t i = 0; i < elevations.size(); ++i) {
    EXPECT_NEAR(lidar.beams[i].elevation, elevations[i], 1e-12);
    EXPECT_NEAR(lidar.beams[i].rise, i < 3 ? 0.2 : 0.12, 0.02);
    EXPECT_NE(lidar.beams[i].elevationError, 0);
  }
  EXPECT_EQ(lidar.columns, 900);
  EXPECT_EQ(lidar.name, "table of 5 beams from 5.7296 to -11.459 deg");

  options.upsideDown = true;
  const LidarModel hanging = makeLidar(options, beams);
  EXPECT_NEAR(hanging.beams.front().elevation, 0.2, 1e-12);
  EXPECT_NEAR(hanging.beams.front().rise, -0.12, 1e-12);
  EXPECT_NE(hanging.clockwise, lidar.clockwise);
}

TEST(LidarModel, UniformBeamsAreEvenlySpread) {
  SimulationOptions options;
  SensorOptions beams;
  options.sensor = "uniform";
  beams.rings = 5;
  beams.fovUp = 0.2;
  beams.fovDown = -0.2;
  beams.columns = 500;
  const LidarModel lidar = makeLidar(options, beams);
  ASSERT_EQ(lidar.beams.size(), 5u);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(lidar.beams[i].elevation, 0.2 - 0.1 * i, 1e-12);
}

TEST(LidarModel, RefusesAnUnknownNameAndListsTheKnownOnes) {
  const std::string message = tests::messageOf([] { makeLidar("hdl65"); });
  for (const std::string& name : lidarNames()) EXPECT_HAS(message, name);
}

}  // namespace
}  // namespace polemcl::test_lidar_model
