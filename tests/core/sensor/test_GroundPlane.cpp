#include <gtest/gtest.h>

#include <cmath>

#include "core/sensor/GroundPlane.h"
#include "support/Clouds.h"

namespace polemcl::test_ground_plane {
namespace {

using polemcl::clouds::kDegree;
using polemcl::clouds::PointList;

/// A plane `height` under the origin, rising by `alongX`, `alongY` per metre, with boxes on it.
PointList field(double height, double alongX = 0, double alongY = 0) {
  PointList points;
  sim::Random random(7);
  for (int i = 0; i < 20000; ++i) {
    const double x = random.uniform(-25, 25), y = random.uniform(-25, 25);
    const double box = x > 4 && x < 9 && y > -8 && y < 3 ? random.uniform(0, 3) : 0;
    points.add(x, y, -height + alongX * x + alongY * y + box + 0.01 * random.normal());
  }
  return points;
}

PointList turnedOver(const PointList& points) {
  PointList out;
  for (std::size_t i = 0; i < points.size(); ++i) out.add(points.x[i], -points.y[i], -points.z[i]);
  return out;
}

TEST(GroundPlane, GivesHeightAndTilt) {
  // The front of the sensor points up where the ground falls ahead of it.
  const double pitch = 4 * kDegree, roll = 3 * kDegree;
  const auto ground = findGroundPlane(field(1.5, std::tan(pitch), 0).view());
  ASSERT_TRUE(ground);
  EXPECT_FALSE(ground->above);
  EXPECT_NEAR(ground->pitch(), pitch, 0.006);  // ground rising ahead: the front is down
  EXPECT_NEAR(ground->roll(), 0, 0.006);
  EXPECT_NEAR(ground->heightOf({0, 0, 0}), 1.5 * std::cos(pitch), 0.02);
  EXPECT_GT(ground->share, 0.7);
  // Ground falling to the left: left is up.
  const auto leaning = findGroundPlane(field(1.5, 0, -std::tan(roll)).view());
  ASSERT_TRUE(leaning);
  EXPECT_NEAR(leaning->roll(), roll, 0.006);
  EXPECT_NEAR(leaning->pitch(), 0, 0.006);
}

TEST(GroundPlane, IsAboveWhenTheCloudStandsOnItsHead) {
  const PointList points = field(1.2, 0.05, -0.03);
  const auto upright = findGroundPlane(points.view());
  const auto ground = findGroundPlane(turnedOver(points).view());
  ASSERT_TRUE(upright && ground);
  EXPECT_TRUE(ground->above);
  EXPECT_NEAR(ground->heightOf({0, 0, 0}), upright->heightOf({0, 0, 0}), 0.02);
  EXPECT_NEAR(ground->roll(), upright->roll(), 0.006);
  EXPECT_NEAR(ground->pitch(), upright->pitch(), 0.006);
}

TEST(GroundPlane, ACeilingIsNoGround) {
  PointList points = field(1.2);
  points.append(turnedOver(field(1.0)).view());
  const auto ground = findGroundPlane(points.view());
  ASSERT_TRUE(ground);
  EXPECT_FALSE(ground->above);
  EXPECT_NEAR(ground->heightOf({0, 0, 0}), 1.2, 0.03);
}

// Parked cars hide most of the floor of a garage; its ceiling is all in view.
TEST(GroundPlane, ACeilingOverParkedCarsIsNoGround) {
  PointList points;
  sim::Random random(7);
  for (int i = 0; i < 20000; ++i) {
    const double x = random.uniform(-25, 25), y = random.uniform(-25, 25);
    const bool isCar = std::fmod(x + 50, 5) < 3.2;
    points.add(x, y, isCar ? random.uniform(-1.5, 0) : -1.8 + 0.01 * random.normal());
    points.add(x, y, 0.7 + 0.01 * random.normal());
  }
  const auto ground = findGroundPlane(points.view());
  ASSERT_TRUE(ground);
  EXPECT_FALSE(ground->above);
}

// NCLT: the origin of the clouds lies almost on the ground, the sensor a metre over it.
TEST(GroundPlane, TakesHeightsFromTheSensor) {
  const PointList points = field(0.05);
  const auto ground = findGroundPlane(points.view(), {0, 0, 1.0});
  ASSERT_TRUE(ground);
  EXPECT_NEAR(ground->heightOf({0, 0, 1.0}), 1.05, 0.02);
  EXPECT_NEAR(ground->heightOf({0, 0, 0}), 0.05, 0.02);
}

TEST(GroundPlane, OrderAndInvalidPointsAreOfNoConsequence) {
  const PointList points = field(1.5, 0.02, 0.01);
  PointList spoilt = clouds::shuffled(points.view(), 3);
  for (int i = 0; i < 100; ++i) {
    spoilt.add(std::nan(""), 3, -9);
    spoilt.add(0, 0, 0);
  }
  const auto a = findGroundPlane(points.view()), b = findGroundPlane(spoilt.view());
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->normal, b->normal);
  EXPECT_EQ(a->offset, b->offset);
}

TEST(GroundPlane, ThereIsNoneInABlob) {
  PointList points;
  sim::Random random(2);
  for (int i = 0; i < 20000; ++i)
    points.add(10 * random.normal(), 10 * random.normal(), 10 * random.normal());
  EXPECT_FALSE(findGroundPlane(points.view()));
  EXPECT_FALSE(findGroundPlane({}));
}

}  // namespace
}  // namespace polemcl::test_ground_plane
