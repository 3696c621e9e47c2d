#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>

#include "core/extraction/range_image/CircleFit.h"
#include "sim/common/Random.h"

namespace polemcl::test_circle_fit {
namespace {

using Points = std::vector<Eigen::Vector2d>;

Points arc(double x, double y, double radius, double from, double to, int n) {
  Points points;
  for (int i = 0; i < n; ++i) {
    const double angle = from + (to - from) * i / (n - 1);
    points.emplace_back(x + radius * std::cos(angle), y + radius * std::sin(angle));
  }
  return points;
}

/// What a LiDAR at the origin sees of a pole: rays `step` apart, ranges with noise.
Points rendered(double depth, double bearing, double radius, double step, double sigma,
                sim::Random& random) {
  Points points;
  const double phase = random.uniform();
  for (int i = -200; i <= 200; ++i) {
    const double angle = (i + phase) * step;
    const double across = depth * std::sin(angle);
    if (std::abs(across) >= radius) continue;
    const double range = depth * std::cos(angle) - std::sqrt(radius * radius - across * across) +
                         sigma * random.normal();
    points.emplace_back(range * std::cos(bearing + angle), range * std::sin(bearing + angle));
  }
  return points;
}

void expectCircle(const std::optional<Circle>& circle, double x, double y, double radius,
                  double tolerance) {
  ASSERT_TRUE(circle);
  EXPECT_NEAR(circle->x, x, tolerance);
  EXPECT_NEAR(circle->y, y, tolerance);
  EXPECT_NEAR(circle->radius, radius, tolerance);
}

Points noisyCircle(std::uint64_t seed) {
  sim::Random random(seed);
  Points points = arc(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(0.1, 2), 0,
                      random.uniform(1, 6), 25);
  for (auto& p : points) p += 0.03 * Eigen::Vector2d(random.normal(), random.normal());
  return points;
}

/// Kåsa's normal equations, by QR on the design matrix.
Circle kasaOracle(const Points& points) {
  Eigen::MatrixXd a(points.size(), 3);
  Eigen::VectorXd b(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    a.row(i) << points[i].x(), points[i].y(), 1;
    b[i] = points[i].squaredNorm();
  }
  const Eigen::Vector3d s = a.colPivHouseholderQr().solve(b);
  return {s[0] / 2, s[1] / 2, std::sqrt(s[2] + (s[0] * s[0] + s[1] * s[1]) / 4)};
}

struct Bias {
  double centre = 0, radius = 0;
};

/// Mean error along the ray of the centre, and of the radius, over many rendered poles.
template <class Fit>
Bias bias(double depth, double radius, Fit fit) {
  sim::Random random(7);
  Bias mean;
  int n = 0;
  for (int i = 0; i < 400; ++i) {
    Points points;
    for (int row = 0; row < 8; ++row)
      for (const auto& p : rendered(depth, 0.3, radius, 0.003, 0.02, random)) points.push_back(p);
    const auto circle = fit(points);
    if (!circle) continue;
    mean.centre += circle->x * std::cos(0.3) + circle->y * std::sin(0.3) - depth;
    mean.radius += circle->radius - radius;
    ++n;
  }
  EXPECT_GT(n, 390);
  return {mean.centre / n, mean.radius / n};
}

TEST(CircleFit, PointsOnACircleGiveThatCircle) {
  for (const double to : {1.0, 2.5, 6.0}) {
    const Points points = arc(3, -2, 0.7, 0.2, 0.2 + to, 12);
    expectCircle(fitCircleKasa(points), 3, -2, 0.7, 1e-9);
    expectCircle(fitCircleKasaMean(points, false), 3, -2, 0.7, 1e-9);
  }
}

TEST(CircleFit, ThreePointsAreEnough) {
  const Points points = {{1, 0}, {0, 1}, {-1, 0}};
  expectCircle(fitCircleKasa(points), 0, 0, 1, 1e-12);
}

TEST(CircleFit, IsAccurateFarFromTheOrigin) {
  const Points points = arc(4000, -7000, 0.15, 1, 4, 20);
  expectCircle(fitCircleKasa(points), 4000, -7000, 0.15, 1e-7);
}

TEST(CircleFit, KasaEqualsLeastSquares) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const Points points = noisyCircle(seed);
    const Circle expected = kasaOracle(points);
    expectCircle(fitCircleKasa(points), expected.x, expected.y, expected.radius, 1e-8);
  }
}

TEST(CircleFit, KasaMeanHasKasasCentreAndTheMeanDistanceToIt) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const Points points = noisyCircle(seed);
    const auto kasa = fitCircleKasa(points);
    ASSERT_TRUE(kasa);
    double mean = 0;
    for (const auto& p : points)
      mean += std::hypot(p.x() - kasa->x, p.y() - kasa->y) / static_cast<double>(points.size());
    expectCircle(fitCircleKasaMean(points, false), kasa->x, kasa->y, mean, 1e-8);
    expectCircle(fitCircleKasaMean(points, true), kasa->x, kasa->y, mean, 2e-3);
    EXPECT_GT(kasa->radius - mean, 1e-5);  // the root of the mean square is the greater one
  }
}

TEST(CircleFit, KasaMeanInSinglePrecisionRoundsOffsets) {
  const Points points = noisyCircle(1);
  const auto exact = fitCircleKasaMean(points, false), rounded = fitCircleKasaMean(points, true);
  ASSERT_TRUE(exact && rounded);
  EXPECT_NE(exact->x, rounded->x);
  EXPECT_EQ(rounded->radius, static_cast<float>(rounded->radius));
}

TEST(CircleFit, KasaMeanRefusesOnlyWhatIsExactlySingular) {
  Points line;  // on a line but for 1e-9 m
  for (int i = 0; i < 9; ++i) line.emplace_back(7.3 + 0.1 * i + 1e-9 * i * i, 0.7 - 0.13 * i);
  EXPECT_FALSE(fitCircleKasa(line));
  const auto circle = fitCircleKasaMean(line, false);
  ASSERT_TRUE(circle);
  EXPECT_GT(circle->radius, 10);
  EXPECT_FALSE(fitCircleKasaMean({}, false));
  EXPECT_FALSE(fitCircleKasaMean(Points(5, Eigen::Vector2d(4, 3)), false));
  EXPECT_FALSE(fitCircleKasaMean({{4, 1}, {4, 2}, {4, 5}}, false));
  EXPECT_FALSE(fitCircleKasaMean({{4, 1}, {4, 2}, {4, 5}}, true));
}

TEST(CircleFit, NoCircleThroughPointsOnALine) {
  const Points line = {{0, 0}, {1, 2}, {2, 4}, {3, 6}};
  EXPECT_FALSE(fitCircleKasa(line));
  Points rounded;  // on a line but for the last bits
  for (int i = 0; i < 9; ++i) rounded.emplace_back(7.3 + 0.1 * i, 0.7 - 0.13 * i);
  EXPECT_FALSE(fitCircleKasa(rounded));
}

TEST(CircleFit, NoCircleThroughTooFewPoints) {
  EXPECT_FALSE(fitCircleKasa({}));
  EXPECT_FALSE(fitCircleKasa({{0, 0}, {1, 1}}));
}

TEST(CircleFit, NoCircleThroughOnePointSeveralTimes) {
  const Points same(5, Eigen::Vector2d(4, 3));
  EXPECT_FALSE(fitCircleKasa(same));
}

TEST(CircleFit, OnShortArcsKasaIsTooSmall) {
  const double depth = 10, radius = 0.15;
  const Bias kasa = bias(depth, radius, fitCircleKasa);
  EXPECT_LT(kasa.radius, -0.015);
  EXPECT_LT(kasa.centre, -0.02);
}

}  // namespace
}  // namespace polemcl::test_circle_fit
