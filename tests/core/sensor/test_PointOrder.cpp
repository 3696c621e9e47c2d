#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/sensor/PointOrder.h"

namespace polemcl::test_point_order {
namespace {

/// Points at these azimuths, deg, 10 m away.
std::optional<PointOrder> orderOf(const std::vector<double>& azimuths, float range = 10) {
  std::vector<float> x, y, z;
  for (const double azimuth : azimuths) {
    x.push_back(range * static_cast<float>(std::cos(azimuth * M_PI / 180)));
    y.push_back(range * static_cast<float>(std::sin(azimuth * M_PI / 180)));
    z.push_back(0);
  }
  return pointOrder({x.data(), y.data(), z.data(), x.size()});
}

std::vector<double> turn(double begin, double step, double span = 360) {
  std::vector<double> azimuths;
  for (int i = 0; i * std::abs(step) < span; ++i) azimuths.push_back(begin + i * step);
  return azimuths;
}

TEST(PointOrder, OneTurnTellsDirectionAndBegin) {
  const auto left = orderOf(turn(100, 0.5)), right = orderOf(turn(-170, -0.5));
  ASSERT_TRUE(left && right);
  EXPECT_EQ(left->turn, Turn::counterclockwise);
  EXPECT_NEAR(left->begin, 100 * M_PI / 180, 1e-6);
  EXPECT_EQ(right->turn, Turn::clockwise);
  EXPECT_NEAR(right->begin, -170 * M_PI / 180, 1e-6);
}

TEST(PointOrder, LasersOfOneFiringMayLookToDifferentSides) {
  std::vector<double> azimuths;
  for (const double azimuth : turn(20, -0.5))
    for (const double aside : {-4.0, 4.0, -1.0, 1.0}) azimuths.push_back(azimuth + aside);
  const auto order = orderOf(azimuths);
  ASSERT_TRUE(order);
  EXPECT_EQ(order->turn, Turn::clockwise);
  EXPECT_NEAR(order->begin, 16 * M_PI / 180, 1e-6);
}

TEST(PointOrder, WhereReturnsAreMissingTheRestTells) {
  std::vector<double> azimuths = turn(100, -0.5, 150), rest = turn(-150, -0.5, 100);
  azimuths.insert(azimuths.end(), rest.begin(), rest.end());
  const auto order = orderOf(azimuths);
  ASSERT_TRUE(order);
  EXPECT_EQ(order->turn, Turn::clockwise);
  EXPECT_NEAR(order->begin, 100 * M_PI / 180, 1e-6);
  EXPECT_NEAR(order->arc, 249 * M_PI / 180, 1e-3);
}

TEST(PointOrder, RingsShortPiecesAndMixedPointsTellNothing) {
  std::vector<double> rings = turn(0, 0.5), again = rings, mixed;
  rings.insert(rings.end(), again.begin(), again.end());
  EXPECT_FALSE(orderOf(rings));
  EXPECT_FALSE(orderOf(turn(0, 0.5, 80)));
  for (int i = 0; i < 1000; ++i) mixed.push_back(std::fmod(i * 222.49, 360));
  EXPECT_FALSE(orderOf(mixed));
  EXPECT_FALSE(orderOf(turn(0, 0.5), 0.5f)) << "nearer than 1 m";
  EXPECT_FALSE(orderOf({}));
}

TEST(PointOrder, AWholeTurnLacksLessThanASixth) {
  const auto tells = [](double span) {
    std::vector<float> x, y, z;
    for (const double azimuth : turn(100, -0.5, span)) {
      x.push_back(static_cast<float>(10 * std::cos(azimuth * M_PI / 180)));
      y.push_back(static_cast<float>(10 * std::sin(azimuth * M_PI / 180)));
      z.push_back(0);
    }
    return pointOrder({x.data(), y.data(), z.data(), x.size()}).value().isWhole();
  };
  EXPECT_TRUE(tells(305));
  EXPECT_FALSE(tells(295));
}

/// First index and number of points of a turn of a scan that sweeps 399 deg and lacks 29 of them.
std::pair<std::size_t, std::size_t> turnOf(double step, double stamp) {
  std::vector<float> x, y, z;
  for (const double azimuth : turn(100, step, 400)) {
    if (std::abs(azimuth - 100) > 200 && std::abs(azimuth - 100) < 230) continue;
    x.push_back(static_cast<float>(10 * std::cos(azimuth * M_PI / 180)));
    y.push_back(static_cast<float>(10 * std::sin(azimuth * M_PI / 180)));
    z.push_back(0);
  }
  const PointsView points{x.data(), y.data(), z.data(), x.size()};
  const PointOrder order = pointOrder(points).value();
  EXPECT_NEAR(order.sweep, 399 * M_PI / 180, 1e-3);
  const PointsView one = oneTurn(points, order, stamp).points;
  return {static_cast<std::size_t>(one.x - points.x), one.size};
}

TEST(PointOrder, OfMoreThanATurnOneIsTaken) {
  for (const double step : {-1.0, 1.0}) {
    const auto first = turnOf(step, 0), middle = turnOf(step, 0.5), last = turnOf(step, 1);
    EXPECT_EQ(first.first, 0u);
    EXPECT_NEAR(static_cast<double>(first.second), 331, 1) << "azimuths 0 to 200, 230 to 360";
    EXPECT_NEAR(static_cast<double>(middle.first), 20, 1);
    EXPECT_NEAR(static_cast<double>(middle.second), 331, 1);
    EXPECT_NEAR(static_cast<double>(last.first), 39, 1);
    EXPECT_EQ(last.first + last.second, 371u) << "to the end";
  }
}

/// As a recorder of an HDL-32E does it now and then.
TEST(PointOrder, AFiringAtAWrongAzimuthDoesNotMoveTheTurn) {
  std::vector<double> azimuths = turn(100, -0.01, 400);
  for (std::size_t i = 1000; i < 1026; ++i) azimuths[i] -= 90;
  std::vector<float> x, y;
  for (const double azimuth : azimuths) {
    x.push_back(static_cast<float>(10 * std::cos(azimuth * M_PI / 180)));
    y.push_back(static_cast<float>(10 * std::sin(azimuth * M_PI / 180)));
  }
  const PointsView points{x.data(), y.data(), y.data(), x.size()};
  const PointOrder order = pointOrder(points).value();
  EXPECT_NEAR(order.sweep, 400 * M_PI / 180, 0.02);
  const OneTurn one = oneTurn(points, order, 0.5);
  EXPECT_NEAR(one.begin, 80 * M_PI / 180, 0.01);
  EXPECT_NEAR(static_cast<double>(one.points.x - points.x), 2000, 160) << "two blocks of 80";
  EXPECT_NEAR(static_cast<double>(one.points.size), 36000, 160);
}

TEST(PointOrder, TurnsBeginWithinAnArcUnlessTheyTurnDifferentWays) {
  EXPECT_EQ(beginArc({}), 0);
  const PointOrder left{Turn::counterclockwise, 3.0, 6, 6},
      beyond{Turn::counterclockwise, -3.0, 6, 6}, right{Turn::clockwise, 1, 6, 6};
  EXPECT_NEAR(beginArc({left, beyond}), 2 * M_PI - 6, 1e-12) << "across the back";
  EXPECT_EQ(beginArc({left, right}), 0);
}

}  // namespace
}  // namespace polemcl::test_point_order
