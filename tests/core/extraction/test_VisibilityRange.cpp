#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <polemcl/core/extraction/PoleExtractor.h>
#include "core/extraction/VisibilityRange.h"
#include "support/KnownScene.h"

namespace polemcl::test_visibility_range {
namespace {

using namespace polemcl::clouds;

constexpr double kTurn = 2 * M_PI;

/// Ground only, but for what the test adds.
Scene plain() {
  Scene scene;
  scene.ground = GroundPlane{-kSensorHeight, 0, 0};
  return scene;
}

/// Upright board across the line of sight: bearing, distance, half width, top above ground.
Wall board(double bearing, double distance, double half, double top) {
  const double c = std::cos(bearing), s = std::sin(bearing);
  return {distance * c - half * -s, distance * s - half * c, distance * c + half * -s,
          distance * s + half * c,  -kSensorHeight,          top - kSensorHeight};
}

std::vector<float> visibilityRangeOf(const PointList& points, const SensorOptions& sensor) {
  PoleExtractor extractor(sensor, {});
  extractor.extract(points.view());
  return extractor.visibilityRange();
}

float at(const std::vector<float>& ranges, double bearing) {
  return ranges[visibilityRangeSector(bearing, ranges.size())];
}

TEST(VisibilityRange, SectorsCountFromBehindToTheLeft) {
  EXPECT_EQ(visibilityRangeSector(-M_PI, 256), 0u);
  EXPECT_EQ(visibilityRangeSector(-M_PI + 0.99 * kTurn / 256, 256), 0u);
  EXPECT_EQ(visibilityRangeSector(-M_PI + 1.01 * kTurn / 256, 256), 1u);
  EXPECT_EQ(visibilityRangeSector(0.001, 256), 128u);
  EXPECT_EQ(visibilityRangeSector(M_PI - 0.001, 256), 255u);
  EXPECT_EQ(visibilityRangeSector(M_PI / 2 + 3 * kTurn + 0.001, 4), 3u);
}

TEST(VisibilityRange, TowardsSomethingWideTheNearestSectorDecides) {
  std::vector<float> ranges(8, 20);  // of 45°
  ranges[4] = 7;                     // 0° to 45°
  EXPECT_EQ(visibilityRangeTowards(ranges, 10, 5, 0.1), 7);
  EXPECT_EQ(visibilityRangeTowards(ranges, 10, -5, 0.1), 20);
  EXPECT_EQ(visibilityRangeTowards(ranges, 10, -0.05, 0.1), 7);  // reaches across
  EXPECT_EQ(visibilityRangeTowards(ranges, 10, -0.15, 0.1), 20);
  ranges[0] = 3;  // beyond the seam
  EXPECT_EQ(visibilityRangeTowards(ranges, -10, 0.05, 0.1), 3);
  EXPECT_EQ(visibilityRangeTowards({}, 1, 0, 0.1), 0);
  ranges[6] = 2;  // 90° to 135°; what is round the sensor reaches a right angle to both sides
  EXPECT_EQ(visibilityRangeTowards(ranges, 0.05, 0.005, 0.1), 2);
  EXPECT_EQ(visibilityRangeTowards(ranges, 0.05, -0.005, 0.1), 7);
}

TEST(VisibilityRange, EndsAtWallsAndGoesOnOverWhatIsLow) {
  for (const char* model : {"hdl64e", "hdl32e", "os1_64"}) {
    SCOPED_TRACE(model);
    Scene scene = plain();
    scene.walls.push_back(board(0.5, 12.2, 3, 6));     // a house
    scene.walls.push_back(board(2.0, 8.0, 3, 0.45));   // a kerb's planter
    scene.walls.push_back(board(-1.5, 25.3, 4, 2.9));  // as high as poles
    const auto ranges =
        visibilityRangeOf(castYard(sensorOptions(model), scene), sensorOptions(model));
    ASSERT_EQ(ranges.size(), 256u);
    EXPECT_EQ(at(ranges, 0.5), 12.0f);
    EXPECT_EQ(at(ranges, -1.5), 25.0f);
    EXPECT_EQ(at(ranges, 2.0), 40.0f) << "the extractor looks no farther";
    EXPECT_EQ(at(ranges, -3.0), 40.0f);
    EXPECT_EQ(at(ranges, 0.5 + std::atan(3 / 12.2) + 0.04), 40.0f) << "beside the house";
  }
}

TEST(VisibilityRange, APoleEndsItAtItsFrontAndNothingElse) {
  Scene scene = plain();
  scene.cylinders.push_back({10, 4, 0.15, -kSensorHeight, 3});
  const auto ranges =
      visibilityRangeOf(castYard(sensorOptions("hdl64e"), scene), sensorOptions("hdl64e"));
  const double bearing = std::atan2(4, 10), front = std::hypot(10, 4) - 0.15;
  EXPECT_LE(at(ranges, bearing), front);
  EXPECT_GT(at(ranges, bearing), front - 0.55);
  EXPECT_LE(std::count_if(ranges.begin(), ranges.end(), [](float r) { return r < 40; }), 3);
}

TEST(VisibilityRange, SparseBeamsEndItWhereFewerThanTwoMeetPoles) {
  SensorOptions sensor = sensorOptions("uniform");
  sensor.rings = 5;  // at +10°, +5°, 0°, -5°, -10°
  sensor.fovUp = 10 * kDegree;
  sensor.fovDown = -10 * kDegree;
  sensor.columns = 1800;
  sensor.checkBeams = false;
  const auto ranges = visibilityRangeOf(castYard(sensor, plain()), sensor);
  // 1.5 m up: the level beam always passes at 1.5 m; +5° reaches 3 m after 17.1 m, -5° 0.5 m after
  // 11.4 m. The last step with two beams is at 17.0 m.
  EXPECT_EQ(at(ranges, 1.0), 17.0f);
}

TEST(VisibilityRange, IsUnknownWhereNothingWasSeen) {
  const SensorOptions sensor = sensorOptions("hdl32e");
  const auto ranges =
      visibilityRangeOf(cast(plain(), SensorModel(sensor), {0, 0, 5, 0.0, M_PI / 2}), sensor);
  EXPECT_EQ(at(ranges, 0), 40.0f);
  EXPECT_EQ(at(ranges, 1.4), 40.0f);
  EXPECT_EQ(at(ranges, 2.0), 0.0f);
  EXPECT_EQ(at(ranges, -3.0), 0.0f);
}

// At a right angle to the left and right begins a sector of the ranges and one of the ground.
TEST(VisibilityRange, IsKnownUpToTheLastSectorWithPoints) {
  const SensorOptions sensor = sensorOptions("hdl32e");
  const Casting ahead{0, 0, 5, 0.0, M_PI / 2 - 0.01};
  const auto ranges = visibilityRangeOf(cast(plain(), SensorModel(sensor), ahead), sensor);
  for (const double side : {1, -1}) {
    EXPECT_EQ(at(ranges, side * (M_PI / 2 - 0.001)), 40.0f) << side;
    EXPECT_EQ(at(ranges, side * (M_PI / 2 + 0.001)), 0.0f) << side;
  }
}

TEST(VisibilityRange, TurnsWithTheScan) {
  Scene scene = plain();
  scene.walls.push_back(board(0.5, 12.2, 3, 6));
  const SensorOptions sensor = sensorOptions("hdl64e");
  const PointList points = castYard(sensor, scene);
  const auto before = visibilityRangeOf(points, sensor);
  const auto after = visibilityRangeOf(turned(points.view(), kTurn * 32 / 256), sensor);
  int different = 0;
  for (int i = 0; i < 256; ++i) different += before[i] != after[(i + 32) % 256];
  EXPECT_LE(different, 4) << "edges of sectors may round";
}

// The nose of the LiDAR is 15° down. Ahead, its two highest beams (10.67° and 9.33° up) fall by
// 4.33° and 5.67°, and the second is below 0.5 m after (1.5 - 0.5) m / tan 5.67° = 10.1 m.
TEST(VisibilityRange, OfATiltedLidarEndsWhereItsBeamsReachTheGround) {
  const double lean = std::tan(15 * kDegree);
  Scene scene;
  scene.ground = GroundPlane{-kSensorHeight, lean, 0};
  const SensorOptions sensor = sensorOptions("hdl32e");
  const PointList points = cast(scene, SensorModel(sensor), {0, 0, 1});
  PoleExtractor extractor(sensor, {});
  extractor.extract(points.view(), {static_cast<float>(-lean), 0});
  const auto tilted = extractor.visibilityRange();
  EXPECT_NEAR(at(tilted, 0.01), (kSensorHeight - 0.5) / std::tan(5.67 * kDegree), 0.8);
  EXPECT_GT(at(tilted, 3.1), 35);
  EXPECT_GT(at(tilted, 1.57), 35);
  extractor.extract(castYard(sensor, plain()).view());
  EXPECT_GT(at(extractor.visibilityRange(), 0.01), 35) << "level again";
}

TEST(VisibilityRange, IsEmptyByThePapersMethodAndOfCameras) {
  ExtractionOptions paper;
  paper.method = ExtractionMethod::rangeImage;
  PoleExtractor extractor(sensorOptions("hdl64e"), paper);
  extractor.extract(castYard(sensorOptions("hdl64e")).view());
  EXPECT_TRUE(extractor.visibilityRange().empty());
  PinholeCamera camera;
  camera.width = 320;
  camera.height = 240;
  camera.fx = camera.fy = 250;
  camera.cx = 160;
  camera.cy = 120;
  const SensorModel model(camera);
  ScanLines lines(model);
  GroundGrid ground;
  std::vector<float> ranges{1, 2};
  VisibilityRangeFinder(model, 1.5, 40).find(lines, ground, Eigen::Vector2f::Zero(), ranges);
  EXPECT_TRUE(ranges.empty());
}

}  // namespace
}  // namespace polemcl::test_visibility_range
