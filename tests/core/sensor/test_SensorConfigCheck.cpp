#include <gtest/gtest.h>

#include <cmath>

#include "core/sensor/SensorConfigCheck.h"
#include "support/Clouds.h"
#include "support/ExpectHas.h"
#include "support/Sensors.h"
#include "support/SimulatedScans.h"

namespace polemcl::test_sensor_config_check {
namespace {

using polemcl::clouds::kDegree;
using polemcl::clouds::PointList;
using tests::sensorNamed;

PointList street(const std::string& lidar, double height) {
  PointList points;
  points.append(clouds::streetScans(3, lidar, height, 1).front().scan.view());
  return points;
}

std::string contradiction(const SensorOptions& options, const PointList& points,
                          bool beams = true) {
  return SensorConfigCheck(options, beams).contradiction(points.view());
}

bool has(const std::string& text, const std::string& word) {
  return text.find(word) != std::string::npos;
}

/// Beams of one common origin, as plain simulators have, hitting boxes at many ranges.
PointList singleOrigin(int beams, double topDeg, double bottomDeg) {
  PointList points;
  for (int column = 0; column < 1800; ++column)
    for (int beam = 0; beam < beams; ++beam) {
      const double elevation = (topDeg + (bottomDeg - topDeg) * beam / (beams - 1)) * kDegree;
      const double wall = 4 + 26 * std::abs(std::sin(0.02 * column * 7));
      const double ground = elevation < 0 ? 1.7 / std::tan(-elevation) : 1e9;
      const double rho = std::min(wall, ground);
      points.addPolar(column * 0.2 * kDegree, elevation, rho / std::cos(elevation));
    }
  return points;
}

TEST(SensorConfigCheck, AcceptsEachLidarUnderItsOwnName) {
  for (const auto& [lidar, model] :
       {std::pair{"hdl32e", "hdl32e"}, std::pair{"vlp16", "vlp16"}, std::pair{"os1_64", "os1_64"},
        std::pair{"os1_128", "os1_128"}, std::pair{"os0_64", "os0_64"},
        std::pair{"hdl64e_kitti", "hdl64e"}, std::pair{"hdl64e", "hdl64e"},
        std::pair{"os1_64_gen2", "os1_64_gen2"}})
    EXPECT_EQ(contradiction(sensorNamed(model), street(lidar, 1.5)), "") << lidar;
}

TEST(SensorConfigCheck, RefusesLidarsUnderOthersNames) {
  for (const std::string lidar : {"hdl32e", "vlp16", "os1_64", "os1_64_gen2", "hdl64e_kitti"}) {
    const PointList points = street(lidar, 1.5);
    for (const std::string model :
         {"hdl64e", "hdl32e", "vlp16", "os1_64", "os1_64_gen2", "os1_128", "os0_64"}) {
      if (lidar.rfind(model, 0) == 0 && lidar != "os1_64_gen2") continue;
      if (lidar == model) continue;
      const std::string what = contradiction(sensorNamed(model), points);
      EXPECT_TRUE(has(what, "model = " + model)) << lidar << " as " << model << ": " << what;
      EXPECT_TRUE(has(what, "pole-extract --inspect")) << what;
    }
  }
}

TEST(SensorConfigCheck, NamesThePresetThatFits) {
  const std::string what = contradiction(sensorNamed("os0_64"), street("hdl32e", 1.0));
  EXPECT_TRUE(has(what, "as model = hdl32e has")) << what;
  EXPECT_TRUE(has(what, "32 beams from 10.7 to -30.7 deg")) << what;
}

TEST(SensorConfigCheck, KnowsAMirroredFan) {
  const std::string what = contradiction(sensorNamed("hdl32e", true), street("hdl32e", 1.0));
  EXPECT_TRUE(has(what, "model = hdl32e upside down")) << what;
  EXPECT_TRUE(has(what, "as model = hdl32e has")) << what;
}

TEST(SensorConfigCheck, RefusesOneOriginWhereTheModelHasTwo) {
  const std::string what = contradiction(sensorNamed("hdl64e"), singleOrigin(64, 2, -24.8));
  EXPECT_TRUE(has(what, "model = hdl64e")) << what;
  SensorOptions uniform = sensorNamed("uniform");
  uniform.rings = 64;
  uniform.fovUp = 2 * kDegree;
  uniform.fovDown = -24.8 * kDegree;
  uniform.columns = 1800;
  EXPECT_EQ(contradiction(uniform, singleOrigin(64, 2, -24.8)), "");
}

TEST(SensorConfigCheck, FindsAWrongOrigin) {
  PointList points = street("hdl32e", 1.0);
  for (float& z : points.z) z += 0.957f;
  const std::string what = contradiction(sensorNamed("hdl32e"), points);
  EXPECT_TRUE(has(what, "from 0.96 m above its origin (set [sensor] origin)")) << what;
}

TEST(SensorConfigCheck, FindsACloudUpsideDown) {
  PointList points = street("vlp16", 1.0);  // whose fan is symmetrical
  for (std::size_t i = 0; i < points.size(); ++i) {
    points.y[i] = -points.y[i];
    points.z[i] = -points.z[i];
  }
  for (const bool beams : {true, false}) {
    const std::string what = contradiction(sensorNamed("vlp16"), points, beams);
    EXPECT_TRUE(has(what, "ground lies above the sensor")) << what;
    EXPECT_TRUE(has(what, "--sensor-pose")) << what;
  }
}

TEST(SensorConfigCheck, FindsMillimetresAndKilometres) {
  const PointList points = street("hdl32e", 1.0);
  PointList mm, km;
  for (std::size_t i = 0; i < points.size(); ++i) {
    mm.add(points.x[i] * 1000, points.y[i] * 1000, points.z[i] * 1000);
    km.add(points.x[i] / 1000, points.y[i] / 1000, points.z[i] / 1000);
  }
  for (const bool beams : {true, false}) {
    EXPECT_HAS(contradiction(sensorNamed("hdl32e"), mm, beams), "beyond [sensor] max_range_m");
    EXPECT_HAS(contradiction(sensorNamed("hdl32e"), km, beams), "nearer than [sensor] min_range_m");
  }
}

TEST(SensorConfigCheck, RefusesMergedClouds) {
  const PointList points = street("hdl32e", 1.0);
  PointList merged;
  for (int k = 0; k < 4; ++k)
    for (std::size_t i = 0; i < points.size(); ++i)
      merged.add(points.x[i] + 0.9 * k, points.y[i] + 0.2 * k, points.z[i] + 0.13 * k);
  EXPECT_TRUE(has(contradiction(sensorNamed("hdl32e"), merged), "model = hdl32e"));
}

TEST(SensorConfigCheck, DoesNotJudgeBeamsWhenTold) {
  EXPECT_EQ(contradiction(sensorNamed("os1_128"), street("hdl32e", 1.0), false), "");
}

TEST(SensorConfigCheck, DoesNotJudgeFewPoints) {
  PointList few;
  for (std::size_t i = 0; i + 1 < SensorConfigCheck::kFewestPoints; ++i)
    few.addPolar(0.003 * static_cast<double>(i), 0.5, 10);
  EXPECT_EQ(contradiction(sensorNamed("hdl32e"), few), "");
  EXPECT_EQ(contradiction(sensorNamed("hdl32e"), PointList()), "");
}

// Counted by hand: 3000 points on two of three beams, half of one beam's 10 % off its cone, 100
// above the view.
TEST(BeamAgreement, IsMeasured) {
  SensorOptions options = sensorNamed("table");
  options.elevations = {std::atan(0.1), 0, std::atan(-0.1)};
  options.columns = 1000;
  PointList points;
  for (int i = 0; i < 1500; ++i) {
    const double azimuth = 2 * M_PI * i / 1500;
    points.add(10 * std::cos(azimuth), 10 * std::sin(azimuth), 1.0 + (i % 2 ? 0.25 : -0.25));
    points.add(10 * std::cos(azimuth), 10 * std::sin(azimuth), -1.1);
  }
  for (int i = 0; i < 100; ++i) points.add(10, 0.01 * i, 9);
  const BeamAgreement agreement = measureAgreement(points.view(), SensorModel(options), 1, 60);
  EXPECT_EQ(agreement.points, 3100u);
  EXPECT_NEAR(agreement.outOfView, 100.0 / 3100, 1e-9);
  EXPECT_NEAR(agreement.emptyRows, 1.0 / 3, 1e-9);
  EXPECT_NEAR(agreement.mixedRows, 1.0 / 3, 1e-9);  // ±0.5 half gaps
  EXPECT_NEAR(agreement.mixedCells, 0.5, 1e-9);
  EXPECT_NEAR(agreement.meanOffset, 0.1, 1e-3);  // 0 and 0.2
  EXPECT_FALSE(agreement.good());
}

}  // namespace
}  // namespace polemcl::test_sensor_config_check
