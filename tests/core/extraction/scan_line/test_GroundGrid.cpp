#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/extraction/scan_line/GroundGrid.h"
#include "support/RayCast.h"
#include "support/Sensors.h"

namespace polemcl::test_ground_grid {
namespace {

using namespace polemcl::clouds;

GroundGrid built(const PointList& points, double sensorHeight,
                 const Eigen::Vector2f& upright = Eigen::Vector2f::Zero()) {
  GroundGrid ground;
  ground.build(points.view(), 1, 60, static_cast<float>(sensorHeight), upright);
  return ground;
}

SensorModel sensorModel(const std::string& model) {
  return SensorModel(tests::sensorNamed(model));
}

/// Greatest errors of the grid below and above the true ground, over places `from` to `to` away.
struct Errors {
  double low = 0, high = 0;
};
Errors errors(const GroundGrid& ground, const GroundPlane& truth, double from, double to) {
  Errors e;
  for (double azimuth = -3.14; azimuth < 3.14; azimuth += 0.05)
    for (double rho = from; rho <= to; rho += 0.5) {
      const double error = ground.at(static_cast<float>(rho * std::cos(azimuth)),
                                     static_cast<float>(rho * std::sin(azimuth))) -
                           truth.at(rho * std::cos(azimuth), rho * std::sin(azimuth));
      e.low = std::max(e.low, -error);
      e.high = std::max(e.high, error);
    }
  return e;
}

Scene onGround(const GroundPlane& ground) {
  Scene scene;
  scene.ground = ground;
  return scene;
}

TEST(GroundGrid, FlatGroundIsFlat) {
  for (const std::string model : {"hdl64e", "hdl32e", "vlp16"}) {
    const SensorModel sensor = sensorModel(model);
    const GroundPlane plane{-1.5, 0, 0};
    const GroundGrid ground = built(cast(onGround(plane), sensor, {0.02, 0, 1}), 1.5);
    const Errors e = errors(ground, plane, 3, 45);
    EXPECT_LT(e.low, 0.06) << model;
    EXPECT_LT(e.high, 0.06) << model;
    EXPECT_NEAR(ground.median(), -1.5, 0.06) << model;
  }
}

TEST(GroundGrid, TheNominalHeightMayBeOff) {
  const SensorModel sensor = sensorModel("hdl64e");
  const GroundPlane plane{-1.73, 0, 0};
  for (const double nominal : {1.4, 2.1}) {
    const GroundGrid ground = built(cast(onGround(plane), sensor, {0.02, 0, 1}), nominal);
    const Errors e = errors(ground, plane, 5, 45);
    EXPECT_LT(std::max(e.low, e.high), 0.06) << nominal;
  }
}

// A cell keeps its lowest return, so on a slope it lies too low by up to what the slope falls
// across a cell: 2.5 m · 8 % along the ray, and 5.6° of the turn across it.
TEST(GroundGrid, FollowsASlopeInAnyDirection) {
  const SensorModel sensor = sensorModel("hdl64e");
  for (double direction = 0; direction < 6.2; direction += 0.7) {
    const GroundPlane plane{-1.73, 0.08 * std::cos(direction), 0.08 * std::sin(direction)};
    const GroundGrid ground = built(cast(onGround(plane), sensor, {0.02, 0, 1}), 1.73);
    const Errors e = errors(ground, plane, 4, 20);
    EXPECT_LT(e.low, 0.3) << direction;
    EXPECT_LT(e.high, 0.15) << direction;
  }
}

// The level ground of a sensor that is tilted by 25°: three times as steep as ground may be.
TEST(GroundGrid, LevelGroundUnderATiltedSensorIsFlat) {
  const SensorModel sensor = sensorModel("hdl64e");
  for (double direction = 0; direction < 6.2; direction += 0.7) {
    const double lean = std::tan(25 * kDegree), x = lean * std::cos(direction),
                 y = lean * std::sin(direction);
    const GroundPlane plane{-1.73, -x, -y};
    const PointList points = cast(onGround(plane), sensor, {0.02, 0, 1});
    const GroundGrid ground = built(points, 1.73, {static_cast<float>(x), static_cast<float>(y)});
    const Errors e = errors(ground, plane, 4, 45);
    EXPECT_LT(std::max(e.low, e.high), 0.07) << direction;
    EXPECT_NEAR(ground.median(), -1.73, 0.07) << direction;
    for (std::size_t i = 0; i < points.size(); i += 97)
      EXPECT_NEAR(ground.levels()[i], points.z[i] + x * points.x[i] + y * points.y[i], 1e-4);
  }
}

TEST(GroundGrid, StrayReturnsBelowTheGroundDoNotMoveIt) {
  const SensorModel sensor = sensorModel("hdl64e");
  const GroundPlane plane{-1.73, 0, 0};
  PointList points = cast(onGround(plane), sensor, {0.02, 0, 1});
  for (int s = 0; s < 64; ++s)  // one reflection in every sector, near and far, some deep below
    for (const double rho : {8.7, 21.2}) {
      const double z = s % 2 ? -2.2 : -3.2;
      points.add(rho * std::cos((s + 0.5) * 5.625 * kDegree),
                 rho * std::sin((s + 0.5) * 5.625 * kDegree), z);
    }
  const GroundGrid ground = built(points, 1.73);
  const Errors e = errors(ground, plane, 3, 45);
  EXPECT_LT(e.low, 0.06);
  EXPECT_LT(e.high, 0.06);
}

TEST(GroundGrid, AWallIsNotTakenForGround) {
  const SensorModel sensor = sensorModel("hdl64e");
  const GroundPlane plane{-1.73, 0, 0};
  Scene scene = onGround(plane);
  scene.walls = {{-30, 7, 30, 7, -1.73, 8}, {-30, -9, 30, -9, -1.2, 8}};
  const GroundGrid ground = built(cast(scene, sensor, {0.02, 0, 1}), 1.73);
  // Before the walls, and as far behind them as heights are handed on.
  const Errors e = errors(ground, plane, 3, 45);
  EXPECT_LT(e.low, 0.06);
  EXPECT_LT(e.high, 0.06);
}

TEST(GroundGrid, WhereNothingIsSeenTheNominalHeightHolds) {
  const SensorModel sensor = sensorModel("vlp16");
  const GroundGrid ground = built(PointList(), 1.2);
  for (const float x : {0.f, 5.f, 49.f, -500.f}) EXPECT_FLOAT_EQ(ground.at(x, 0.1f * x), -1.2f);
  EXPECT_FLOAT_EQ(ground.median(), -1.2f);
}

TEST(GroundGrid, TheLastKnownHeightIsHandedOn) {
  const SensorModel sensor = sensorModel("vlp16");  // its lowest beams reach 30 m at most
  const GroundPlane plane{-1.0, 0.02, 0};
  const GroundGrid ground = built(cast(onGround(plane), sensor), 1.0);
  EXPECT_NEAR(ground.at(49, 0), ground.at(200, 0), 1e-6);
  EXPECT_TRUE(std::isfinite(ground.at(1e6f, 0)));
}

TEST(GroundGrid, KeepsNothingOfTheScanBefore) {
  const SensorModel sensor = sensorModel("hdl32e");
  const PointList low = cast(onGround({-2.0, 0, 0}), sensor),
                  high = cast(onGround({-1.0, 0, 0}), sensor);
  GroundGrid ground = built(low, 1.5);
  ground.build(high.view(), 1, 60, 1.0f);
  EXPECT_NEAR(ground.median(), -1.0, 0.05);
}

/// Sectors are estimated, and made exact near their borders.
TEST(GroundGrid, EveryPointIsInTheCellOfItsPlace) {
  PointList points;
  for (int border = 0; border <= 4 * GroundGrid::kSectors; ++border)
    for (const double rho : {1.0, 2.5, 7.499999, 7.5, 39.9}) {
      const double turn = 4.0 * border / (4 * GroundGrid::kSectors) - 2;  // y / (|x| + |y|), folded
      const double t = std::abs(turn) <= 1 ? turn : std::copysign(2, turn) - turn;
      const double x = std::copysign(1 - std::abs(t), std::abs(turn) <= 1 ? 1 : -1);
      const double scale = rho / std::hypot(x, t);
      for (const double off : {-1e-3, -1e-6, 0.0, 1e-7, 1e-5})
        points.add(x * scale, t * scale + off, 0);
    }
  GroundGrid ground;
  ground.build(points.view(), 0.5f, 60, 1.7f);
  for (std::size_t i = 0; i < points.size(); ++i)
    ASSERT_EQ(ground.cells()[i], GroundGrid::cell(points.x[i], points.y[i]))
        << points.x[i] << ' ' << points.y[i];
}

}  // namespace
}  // namespace polemcl::test_ground_grid
