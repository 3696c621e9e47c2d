#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <numeric>

#include "core/extraction/range_image/CircleFit.h"
#include "core/extraction/scan_line/PoleFitting.h"
#include "support/RayCast.h"
#include "support/Sensors.h"
#include "support/WholeScan.h"

namespace polemcl::test_pole_fitting {
namespace {

using namespace polemcl::clouds;

/// Twelve beams, the number that meets a pole of 1 m at 10 m; firing steps of 3 mrad.
SensorModel twelveBeams() {
  return SensorModel(tests::uniformSensor(12, 2, -4, 2094));
}

/// A pole before far walls, scanned with beams 2 mrad wide, and its segments.
struct Scan {
  double bearing;
  SensorModel sensor = twelveBeams();
  ScanLines lines{sensor};
  PointList points;
  std::vector<ScanLineSegment> segments;
  std::vector<std::uint32_t> used;
  Scan(double distance, double bearingOfPole, double radius, std::uint64_t seed,
       double sigma = 0.02, const std::vector<Wall>& before = {})
      : bearing(bearingOfPole) {
    Scene scene;
    scene.cylinders.push_back({distance * std::cos(bearing), distance * std::sin(bearing), radius});
    scene.walls = {{60, -60, 60, 60}, {60, 60, -60, 60}, {-60, 60, -60, -60}, {-60, -60, 60, -60}};
    scene.walls.insert(scene.walls.end(), before.begin(), before.end());
    Casting casting{sigma, 0.002, seed};
    casting.bearing = bearing;
    casting.half = 0.15;
    points = cast(scene, sensor, casting);
    findSlices(distance);
  }
  /// The same scan turned.
  Scan(const Scan& other, double yaw, double distance)
      : bearing(other.bearing + yaw), points(turned(other.points.view(), yaw)) {
    findSlices(distance);
  }
  float column() const { return static_cast<float>(sensor.columnAngle()); }
  std::optional<PoleFit> fit() const { return fitPole(lines, segments, used, {column()}); }

 private:
  void findSlices(double distance) {
    buildWhole(lines, points.view(), 1, 100);
    std::vector<ScanLineSegment> all;
    ScanLineSegmenter(sensor, {}).find(lines, all);
    for (const ScanLineSegment& s : all)
      if (std::abs(s.rho - distance) < 1) segments.push_back(s);
    used.resize(segments.size());
    std::iota(used.begin(), used.end(), 0u);
  }
};

struct Statistics {
  double depth = 0, lateral = 0;  ///< mean error of the centre along and across the ray, m
  double radius = 0;              ///< mean error, m
  double rms = 0;                 ///< of the centre's distance from the truth, m
  double nees = 0;                ///< mean squared error of the centre, in units of its covariance
  double residual = 0;            ///< mean, m
};

template <class Fit>
Statistics statistics(double distance, double radius, Fit fit) {
  constexpr int kScans = 40;
  Statistics s;
  int fits = 0;
  for (int i = 0; i < kScans; ++i) {
    const Scan scan(distance, 2.4 * i, radius, 1000 + i);
    const std::optional<PoleFit> found = fit(scan);
    if (!found) continue;
    const double c = std::cos(scan.bearing), sn = std::sin(scan.bearing);
    const Eigen::Vector2d error(found->x - distance * c, found->y - distance * sn);
    s.depth += error.x() * c + error.y() * sn;
    s.lateral += -error.x() * sn + error.y() * c;
    s.radius += found->radius - radius;
    s.rms += error.squaredNorm();
    s.nees += error.dot(found->covariance.inverse() * error);
    s.residual += found->residual;
    ++fits;
  }
  EXPECT_EQ(fits, kScans) << distance << ' ' << radius;
  for (double* sum : {&s.depth, &s.lateral, &s.radius, &s.rms, &s.nees, &s.residual}) *sum /= fits;
  s.rms = std::sqrt(s.rms);
  return s;
}
Statistics statistics(double distance, double radius) {
  return statistics(distance, radius, [](const Scan& scan) { return scan.fit(); });
}

TEST(PoleFitting, PostsAreFoundWithoutBias) {
  for (const double distance : {5.0, 10.0, 20.0}) {
    double nees = 0;
    for (const double radius : {0.03, 0.06, 0.1, 0.15}) {
      SCOPED_TRACE(std::to_string(radius) + " at " + std::to_string(distance));
      const Statistics s = statistics(distance, radius);
      EXPECT_LT(std::abs(s.depth), 0.01);
      EXPECT_LT(std::abs(s.lateral), 0.002);
      EXPECT_LT(std::abs(s.radius), 0.006);
      EXPECT_LT(s.rms, 0.013);
      EXPECT_LT(s.nees, 2);  // two dimensions: no more than the covariance says
      nees += s.nees / 4;
    }
    // The covariance has a floor for what poles are unlike cylinders, which these are not: 2 would
    // be exact, 0.16, 0.31 and 0.65 are measured. Sharp to a seventh of the standard deviation.
    EXPECT_NEAR(nees,
                distance == 5    ? 0.16
                : distance == 10 ? 0.31
                                 : 0.65,
                distance == 5    ? 0.05
                : distance == 10 ? 0.09
                                 : 0.19)
        << distance;
  }
}

// Where a beam is as wide as the pole, and on thick trunks, the front is not known that well.
TEST(PoleFitting, TrunksAndFarPolesAreFoundWithLittleBias) {
  for (const double radius : {0.03, 0.1, 0.25, 0.35})
    for (const double distance : {10.0, 20.0, 35.0}) {
      SCOPED_TRACE(std::to_string(radius) + " at " + std::to_string(distance));
      const Statistics s = statistics(distance, radius);
      EXPECT_LT(std::abs(s.depth), 0.006 + 0.0005 * distance);
      EXPECT_LT(std::abs(s.lateral), 0.003);
      EXPECT_LT(std::abs(s.radius), 0.004 + 0.0004 * distance);
      EXPECT_LT(s.rms, 0.03);
    }
}

TEST(PoleFitting, IsMuchBetterThanACircleThroughThePoints) {
  const auto circle = [](const Scan& scan) -> std::optional<PoleFit> {
    std::vector<Eigen::Vector2d> xy;
    for (const ScanLineSegment& s : scan.segments)
      for (std::uint32_t i = s.first; i < s.first + s.count; ++i) {
        const Return& r = scan.lines.begin(s.row)[i];
        xy.emplace_back(scan.lines.x(r), scan.lines.y(r));
      }
    const auto c = fitCircleKasa(xy);
    if (!c) return std::nullopt;
    PoleFit fit;
    fit.x = static_cast<float>(c->x);
    fit.y = static_cast<float>(c->y);
    fit.radius = static_cast<float>(c->radius);
    return fit;
  };
  for (const double radius : {0.04, 0.07, 0.1})
    EXPECT_LT(statistics(10, radius).rms, 0.5 * statistics(10, radius, circle).rms) << radius;
}

TEST(PoleFitting, ResidualIsTheNoiseOfTheRanges) {
  const double residual = statistics(8, 0.12).residual;
  EXPECT_GT(residual, 0.012);
  EXPECT_LT(residual, 0.025);
  EXPECT_LT(Scan(8, 1, 0.12, 1, 0).fit()->residual, 0.012);
  EXPECT_GT(Scan(8, 1, 0.12, 1, 0.08).fit()->residual, 0.03);
}

TEST(PoleFitting, AcrossTheSeam) {
  const Scan scan(10, M_PI, 0.1, 5);
  const auto fit = scan.fit();
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->x, -10, 0.02);
  EXPECT_NEAR(fit->y, 0, 0.01);
  EXPECT_NEAR(fit->radius, 0.1, 0.02);
}

// Some rows of a thin pole far away lie wholly on one side of the seam.
TEST(PoleFitting, AcrossTheSeamOneReturnAtATime) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto fit = Scan(25, M_PI, 0.04, seed).fit();
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->x, -25, 0.04);
    EXPECT_NEAR(fit->y, 0, 0.02);
  }
}

TEST(PoleFitting, AlongTheRayTheCentreIsLessCertainThanAcrossIt) {
  for (const double bearing : {0.0, 0.8, 2.5}) {
    const auto fit = Scan(20, bearing, 0.03, 3).fit();
    ASSERT_TRUE(fit);
    const Eigen::Vector2d along(std::cos(bearing), std::sin(bearing)),
        across(-along.y(), along.x());
    EXPECT_GT(along.dot(fit->covariance * along), 1.2 * across.dot(fit->covariance * across));
  }
}

TEST(PoleFitting, CovarianceIsPositiveDefiniteAndGrowsWithDistance) {
  double before = 0;
  for (const double distance : {5.0, 15.0, 30.0}) {
    const auto fit = Scan(distance, 0.7, 0.1, 3).fit();
    ASSERT_TRUE(fit);
    const Eigen::Vector2d values =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(fit->covariance).eigenvalues();
    EXPECT_GT(values[0], 1e-6);
    EXPECT_NEAR(fit->covariance(0, 1), fit->covariance(1, 0), 1e-12);
    EXPECT_GT(values.sum(), before);
    before = values.sum();
  }
}

TEST(PoleFitting, TurningTheScanTurnsCentreAndCovariance) {
  const double distance = 20;
  const Scan scan(distance, 0.2, 0.1, 11);
  const auto fit = scan.fit();
  ASSERT_TRUE(fit);
  for (const double yaw : {0.5, 1.4, 2.9415, -2.2}) {  // the third brings it to the seam
    const auto other = Scan(scan, yaw, distance).fit();
    ASSERT_TRUE(other);
    Eigen::Matrix2d turn;
    turn << std::cos(yaw), -std::sin(yaw), std::sin(yaw), std::cos(yaw);
    const Eigen::Vector2d expected = turn * Eigen::Vector2d(fit->x, fit->y);
    EXPECT_NEAR(other->x, expected.x(), 1e-3);
    EXPECT_NEAR(other->y, expected.y(), 1e-3);
    EXPECT_NEAR(other->radius, fit->radius, 1e-3);
    const Eigen::Matrix2d covariance = turn * fit->covariance * turn.transpose();
    EXPECT_LT((other->covariance - covariance).norm(), 0.02 * covariance.norm());
  }
}

// A wall hides one half. Its edge is no edge of the pole, so the other one has to do.
TEST(PoleFitting, APoleHalfHiddenIsNotPulledAside) {
  const double radius = 0.15;
  for (const bool rightHidden : {true, false}) {
    double lateral = 0;
    for (int i = 0; i < 20; ++i) {
      const Wall wall = rightHidden ? Wall{5, -3, 5, 0} : Wall{5, 0, 5, 3};
      const Scan scan(10, 0, radius, 50 + i, 0.02, {wall});
      ASSERT_FALSE(scan.segments.empty());
      for (const ScanLineSegment& s : scan.segments)
        ASSERT_EQ(rightHidden ? s.right : s.left, Side::occluded);
      const auto fit = scan.fit();
      ASSERT_TRUE(fit);
      EXPECT_NEAR(fit->x, 10, 0.1);
      EXPECT_NEAR(fit->y, 0, 0.1);
      lateral += fit->y / 20;
    }
    EXPECT_LT(std::abs(lateral), 0.04);  // the middle of what is seen is 0.075 m aside
  }
}

// The fit is moved to the height of the sensor, but not beyond what was seen of the pole.
TEST(PoleFitting, IsGivenAtTheSegmentNearestToTheSensorsHeight) {
  Scan scan(10, 0.3, 0.1, 1);
  EXPECT_EQ(scan.fit()->tilt.gap, 0);
  std::vector<std::uint32_t> below;
  for (const std::uint32_t u : scan.used)
    if (scan.segments[u].z < -0.1f) below.push_back(u);
  ASSERT_GE(below.size(), 3u);
  scan.used = below;
  EXPECT_FLOAT_EQ(scan.fit()->tilt.gap, -scan.segments[below.front()].z);
}

TEST(PoleFitting, OfNoSlicesThereIsNoFit) {
  const Scan scan(10, 0, 0.1, 1);
  EXPECT_FALSE(fitPole(scan.lines, scan.segments, {}, {scan.column()}));
}

TEST(PoleFitting, OnlyTheSlicesNamedAreUsed) {
  Scan scan(10, 0.3, 0.1, 1);
  ASSERT_GE(scan.segments.size(), 4u);
  scan.segments[0].azimuthEnd += 0.1f;  // a segment of something else
  scan.segments[0].first = 0;
  const auto all = scan.fit();
  scan.used.erase(scan.used.begin());
  const auto rest = scan.fit();
  ASSERT_TRUE(all && rest);
  EXPECT_NEAR(rest->x, 10 * std::cos(0.3), 0.03);
  EXPECT_NEAR(rest->y, 10 * std::sin(0.3), 0.03);
  EXPECT_GT(std::hypot(all->x - rest->x, all->y - rest->y), 0.01);
}

TEST(PoleFitting, RoughAxisIsWithinAFewCentimetres) {
  for (const double radius : {0.05, 0.12, 0.25})
    for (const double distance : {5.0, 12.0, 25.0})
      for (const double bearing : {0.0, 1.9, M_PI}) {
        const Scan scan(distance, bearing, radius, 21, 0.01);
        const PoleAxis axis = roughAxis(scan.segments, scan.used, scan.column());
        EXPECT_NEAR(axis.x, distance * std::cos(bearing), 0.06);
        EXPECT_NEAR(axis.y, distance * std::sin(bearing), 0.06);
        EXPECT_NEAR(axis.radius, radius, 0.04);
      }
}

}  // namespace
}  // namespace polemcl::test_pole_fitting
