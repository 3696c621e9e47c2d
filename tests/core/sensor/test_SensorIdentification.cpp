#include <gtest/gtest.h>

#include <cmath>

#include "core/sensor/SensorIdentification.h"
#include "core/sensor/SensorModel.h"
#include "support/Clouds.h"
#include "support/SimulatedScans.h"

namespace polemcl::test_sensor_identification {
namespace {

using polemcl::clouds::kDegree;
using polemcl::clouds::PointList;

PointList scanOf(const std::string& lidar, double height, bool upsideDown = false) {
  sim::SimulationOptions options;
  options.world.seed = 3;
  options.world.length = 120;
  options.sensor = lidar;
  options.height = height;
  options.spacing = 5;
  const sim::World street = sim::makeWorld(options.world);
  const sim::Drive drive = sim::makeDrive(street, options);
  const sim::Scanner scanner(street, sim::makeLidar(lidar, upsideDown));
  PointList points;
  points.append(scanner.scan(drive.T_map_sensor[drive.T_map_sensor.size() / 2], 9).view());
  return points;
}

/// A VLP-16 whose beams lie off their places by turns up and down.
PointList offBeams(double off) {
  PointList points;
  for (int ring = 0; ring < 16; ++ring)
    for (int i = 0; i < 600; ++i)
      points.addPolar(0.6 * i * kDegree, (-15 + 2 * ring + (ring % 2 ? off : -off)) * kDegree,
                      4 + 26 * std::fmod(0.618034 * i, 1));
  return points;
}

/// A VLP-16 so high over level ground, with walls about 30 m away.
PointList court(double height) {
  PointList points;
  for (int elevation = -15; elevation <= 15; elevation += 2)
    for (int i = 0; i < 360; ++i) {
      const double azimuth = i * kDegree, wall = 30 + 5 * std::sin(3 * azimuth),
                   slope = std::tan(elevation * kDegree);
      const double rho = slope < 0 ? std::min(wall, -height / slope) : wall;
      points.add(rho * std::cos(azimuth), rho * std::sin(azimuth), rho * slope);
    }
  return points;
}

struct Expected {
  const char* lidar;
  double height;
  bool upsideDown;
  const char* model;  ///< that fits
};

class SensorInspectionOnStreets : public ::testing::TestWithParam<Expected> {};

TEST_P(SensorInspectionOnStreets, NamesThePreset) {
  const Expected& expected = GetParam();
  const PointList points = scanOf(expected.lidar, expected.height, expected.upsideDown);
  const SensorIdentification inspection = identifySensor({points.view()});
  const auto lidar = sim::makeLidar(expected.lidar);
  EXPECT_FALSE(inspection.onItsHead);
  EXPECT_NEAR(inspection.columns, lidar.columns, 0.01 * lidar.columns);
  EXPECT_GT(inspection.covered, 0.95);
  ASSERT_TRUE(inspection.ground);
  EXPECT_LT(std::abs(inspection.ground->roll()), 3 * kDegree);

  ASSERT_TRUE(inspection.preset());
  const SensorOptions options = inspection.options();
  EXPECT_EQ(options.model, expected.model);
  EXPECT_EQ(options.upsideDown, expected.upsideDown);
  EXPECT_EQ(options.columns, 0);
  EXPECT_EQ(options.originZ, 0);
  EXPECT_NEAR(options.height, expected.height, 0.1);
  EXPECT_NO_THROW(SensorModel{options});
}

INSTANTIATE_TEST_SUITE_P(Lidars, SensorInspectionOnStreets,
                         ::testing::Values(Expected{"hdl32e", 1.0, false, "hdl32e"},
                                           Expected{"hdl32e", 1.0, true, "hdl32e"},
                                           Expected{"vlp16", 1.2, false, "vlp16"},
                                           Expected{"os1_64", 1.8, false, "os1_64"},
                                           Expected{"os1_128", 1.8, false, "os1_128"},
                                           Expected{"os0_64", 1.0, false, "os0_64"}));

// Data-sheet angles lie up to 0.4° beside those of KITTI's unit: a table, in two blocks.
TEST(SensorIdentification, GivesATableWhenNoPresetFits) {
  const PointList points = scanOf("hdl64e", 1.73);
  const SensorIdentification inspection = identifySensor({points.view()});
  EXPECT_FALSE(inspection.preset());
  const SensorOptions options = inspection.options();
  EXPECT_EQ(options.model, "table");
  EXPECT_NEAR(options.height, 1.73, 0.1);
  ASSERT_NO_THROW(SensorModel{options});
  const SensorModel model(options);
  ASSERT_EQ(model.beamCount(), 64);
  std::size_t near = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float rho = std::hypot(points.x[i], points.y[i]);
    const int row = model.row(rho, points.z[i]);
    if (row < 0) continue;
    const Beam& beam = model.beam(row);
    near += std::abs(points.z[i] - beam.offset - rho * beam.slope) < 0.0015 * rho;  // 0.09°
  }
  EXPECT_GT(static_cast<double>(near), 0.97 * static_cast<double>(points.size()));
}

TEST(SensorIdentification, TurnsACloudOverThatStandsOnItsHead) {
  const PointList points = scanOf("hdl32e", 1.0);
  PointList hanging;
  for (std::size_t i = 0; i < points.size(); ++i)
    hanging.add(points.x[i], -points.y[i], -points.z[i]);
  const SensorIdentification inspection = identifySensor({hanging.view()});
  EXPECT_TRUE(inspection.onItsHead);
  ASSERT_TRUE(inspection.preset());
  EXPECT_EQ(inspection.options().model, "hdl32e");
  EXPECT_FALSE(inspection.options().upsideDown);
  EXPECT_NEAR(inspection.options().height, 1.0, 0.1);
}

// Beams of the preset lie 2 degrees apart.
TEST(SensorIdentification, ComparesBeamsWithTheAnglesBetweenThem) {
  const auto fitOf = [](double off) {
    for (const PresetFit& fit : identifySensor({offBeams(off).view()}).presets)
      if (fit.model == "vlp16") return fit;
    return PresetFit();
  };
  const PresetFit near = fitOf(0.2), far = fitOf(0.4);
  EXPECT_NEAR(near.rms, 0.2 * kDegree, 0.01 * kDegree);
  EXPECT_NEAR(near.rmsShare, 0.1, 0.01);
  EXPECT_TRUE(near.fits);
  EXPECT_EQ(far.matched, 16);
  EXPECT_NEAR(far.rmsShare, 0.2, 0.01);
  EXPECT_FALSE(far.fits);
}

TEST(SensorIdentification, TheGroundIsThatOfTheMiddleHeight) {
  const PointList a = court(1.4), b = court(0.9), c = court(1.8), d = court(1.1);
  const auto heightOf = [](const std::vector<PointsView>& scans) {
    return identifySensor(scans).ground.value().heightOf({0, 0, 0});
  };
  EXPECT_NEAR(heightOf({c.view(), b.view(), d.view()}), 1.1, 0.02);
  // Four scans: the third in order of height.
  EXPECT_NEAR(heightOf({a.view(), b.view(), c.view(), d.view()}), 1.4, 0.02);
}

TEST(SensorIdentification, FindsTheOriginOverACloudsOwn) {
  const PointList points = scanOf("vlp16", 1.0);
  PointList moved;
  for (std::size_t i = 0; i < points.size(); ++i)
    moved.add(points.x[i], points.y[i], points.z[i] + 0.957);
  const SensorOptions options = identifySensor({moved.view()}).options();
  EXPECT_EQ(options.model, "vlp16");
  EXPECT_NEAR(options.originZ, 0.957, 0.003);
  EXPECT_NEAR(options.height, 1.0, 0.1);
}

// Correction for motion moves the vehicle's own returns off their beams.
TEST(SensorIdentification, TheVehiclesRoofIsNoBeam) {
  PointList points = scanOf("hdl32e", 1.8);
  for (const double elevation : {-21.0, -22.2, -23.5})
    for (int i = 0; i < 1000; ++i) {
      const double range = 1.8 + 1e-4 * i;
      points.addPolar((120 + 0.12 * i) * kDegree, elevation * kDegree, range);
    }
  const SensorIdentification inspection = identifySensor({points.view()});
  EXPECT_EQ(inspection.beams.beams(), 32);
  ASSERT_TRUE(inspection.preset());
  EXPECT_EQ(inspection.options().model, "hdl32e");
}

// Each point was moved by the way the vehicle went until the end of the turn.
TEST(SensorIdentification, CloudsCorrectedForSeveralSpeedsAreTriedOneByOne) {
  const PointList points = scanOf("hdl32e", 1.8);
  std::vector<PointList> moved(3);
  for (std::size_t k = 0; k < moved.size(); ++k)
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double turned = std::atan2(points.y[i], points.x[i]) / (2 * M_PI);
      moved[k].add(points.x[i] + 0.45 * static_cast<double>(k) * turned, points.y[i], points.z[i]);
    }
  const SensorIdentification together =
      identifySensor({moved[0].view(), moved[1].view(), moved[2].view()});
  ASSERT_TRUE(together.preset());
  EXPECT_EQ(together.options().model, "hdl32e");
  EXPECT_EQ(together.beams.beams(), 32);
  EXPECT_EQ(together.scans, 3u);
}

TEST(SensorIdentification, AScanWithFewReturnsSpoilsNothing) {
  PointList points;  // of a LiDAR that fits no preset
  for (int ring = 0; ring < 12; ++ring)
    for (int i = 0; i < 900; ++i)
      points.addPolar(0.4 * i * kDegree, (-19.3 + 2.9 * ring) * kDegree, 12);
  PointList few;
  for (int i = 0; i < 100; ++i) few.addPolar(i * kDegree, -2 * kDegree, 5);
  const SensorIdentification inspection =
      identifySensor({points.view(), points.view(), few.view()});
  EXPECT_FALSE(inspection.preset());
  EXPECT_EQ(inspection.options().model, "table");
}

TEST(SensorIdentification, CountsAndShuffles) {
  const PointList a = scanOf("vlp16", 1.0);
  PointList b = clouds::shuffled(a.view(), 2);
  for (int i = 0; i < 50; ++i) b.add(i % 2 ? std::nan("") : 0, 0, 0);
  const SensorIdentification one = identifySensor({a.view(), a.view()});
  const SensorIdentification two = identifySensor({b.view(), b.view()});
  EXPECT_EQ(two.invalid, one.invalid + 100);
  EXPECT_EQ(two.points, 2 * a.size() - one.invalid);
  EXPECT_EQ(two.scans, 2u);
  EXPECT_EQ(one.columns, two.columns);
  EXPECT_EQ(one.beams.elevations(), two.beams.elevations());
  EXPECT_EQ(one.options().height, two.options().height);
}

TEST(SensorIdentification, RefusesWhatHasNoBeams) {
  EXPECT_THROW(identifySensor({}), Error);
  EXPECT_THROW(identifySensor({PointsView()}), Error);
}

}  // namespace
}  // namespace polemcl::test_sensor_identification
