#pragma once
// Poles for tests: detections and poles of a map, and their comparison.

#include <gtest/gtest.h>

#include <vector>

#include <polemcl/core/common/Types.h>

namespace polemcl::tests {

/// A street's post, as a detection or on a map; the variance is that of x and y, m².
template <class Pole>
Pole postAt(double x, double y, double variance) {
  Pole pole;
  pole.x = x;
  pole.y = y;
  pole.radius = 0.1;
  pole.bottom = 0.2;
  pole.top = 4;
  pole.covariance = variance * Eigen::Matrix2d::Identity();
  return pole;
}
inline PoleDetection detectionAt(double x, double y, double variance = 0.01) {
  auto pole = postAt<PoleDetection>(x, y, variance);
  pole.points = 10;
  return pole;
}
inline MapPole mapPoleAt(double x, double y, double variance = 0.01) {
  auto pole = postAt<MapPole>(x, y, variance);
  pole.count = 30;
  return pole;
}

/// A pole with another value in each field, so that none can stand for another.
template <class Pole>
Pole varied(Pole pole) {
  pole.radius = 0.125;
  pole.bottom = 0.25;
  pole.top = 4.5;
  pole.confidence = 0.75;
  pole.covariance << 0.04, 0.01, 0.01, 0.09;
  return pole;
}
inline MapPole variedMapPole(double x, double y) {
  MapPole pole = varied(mapPoleAt(x, y));
  pole.count = 17;
  return pole;
}

/// All fields that detections and poles of a map share, bit by bit.
template <class Pole>
void expectSameFields(const Pole& a, const Pole& b) {
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.radius, b.radius);
  EXPECT_EQ(a.bottom, b.bottom);
  EXPECT_EQ(a.top, b.top);
  EXPECT_EQ(a.confidence, b.confidence);
  EXPECT_EQ(a.covariance, b.covariance);
}
inline void expectSame(const MapPole& a, const MapPole& b) {
  expectSameFields(a, b);
  EXPECT_EQ(a.count, b.count);
}
inline void expectSame(const PoleDetection& a, const PoleDetection& b) {
  expectSameFields(a, b);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.timeOffset, b.timeOffset);
  EXPECT_EQ(a.turnRate, b.turnRate);
}

template <class Pole>
void expectSame(const std::vector<Pole>& a, const std::vector<Pole>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) expectSame(a[i], b[i]);
}

}  // namespace polemcl::tests
