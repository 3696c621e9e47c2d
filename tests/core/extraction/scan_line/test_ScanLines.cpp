#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "core/extraction/scan_line/ScanLines.h"
#include "support/Clouds.h"
#include "support/Sensors.h"
#include "support/WholeScan.h"

namespace polemcl::test_scan_lines {
namespace {

using namespace polemcl::clouds;

constexpr float kMinRange = 1, kMaxRange = 60;

SensorModel sensorModel(const std::string& model = "hdl64e") {
  return SensorModel(tests::sensorNamed(model));
}

/// Points in and around the view, and every thirtieth of them not a point.
PointList randomCloud(std::size_t size, std::uint64_t seed) {
  sim::Random random(seed);
  PointList points;
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  while (points.size() < size) {
    switch (random.below(90)) {
      case 0:
        points.add(nan, 3, 0);
        break;
      case 1:
        points.add(5, -inf, 0);
        break;
      case 2:
        points.add(0, 0, 0);
        break;
      default:
        points.addPolar(random.uniform(-M_PI, M_PI), random.uniform(-28, 5) * kDegree,
                        random.uniform(0.5, 70));
    }
  }
  return points;
}

/// Every point looked at alone, with the functions of the standard library.
struct BruteForce {
  std::vector<std::vector<Return>> rows;
  WholeScanCounts counts;
  BruteForce(const PointsView& points, const SensorModel& sensor) : rows(sensor.beamCount()) {
    for (std::size_t i = 0; i < points.size; ++i) {
      const float x = points.x[i], y = points.y[i], z = points.z[i];
      const float rho = std::sqrt(x * x + y * y);
      if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z) || (rho == 0 && z == 0)) {
        ++counts.dropped.invalid;
      } else if (rho < kMinRange || rho > kMaxRange) {
        ++counts.dropped.outOfRange;
      } else if (const int row = sensor.row(rho, z); row < 0) {
        ++counts.lines.outOfView;
      } else {
        ++counts.lines.used;
        rows[row].push_back({std::atan2(y, x), rho, z, static_cast<std::uint32_t>(i)});
      }
    }
    for (auto& row : rows)
      std::sort(row.begin(), row.end(), [](const Return& a, const Return& b) {
        return a.point < b.point;  // compared by point, as azimuths differ in their last bits
      });
  }
};

void expectSorted(const ScanLines& lines) {
  for (int row = 0; row < lines.rows(); ++row)
    for (const Return* r = lines.begin(row); lines.end(row) - r > 1; ++r) {
      ASSERT_LE(r->azimuth, r[1].azimuth);
      if (r->azimuth == r[1].azimuth) {
        ASSERT_LE(r->rho, r[1].rho);
        if (r->rho == r[1].rho) {
          ASSERT_LE(r->z, r[1].z);
        }
      }
    }
}

/// Where many returns have a neighbour at their azimuth, as of LiDARs with two returns a firing,
/// one of them stays: for each that does not, one that is not farther.
void expectNearerOnes(const ScanLines& lines, int row, const std::vector<Return>& all,
                      const SensorModel& sensor) {
  const float oneFiring = static_cast<float>(0.05 * sensor.columnAngle());
  std::vector<bool> stays(600000);
  for (const Return* r = lines.begin(row); r < lines.end(row); ++r) stays[r->point] = true;
  for (const Return& other : all) {
    if (stays[other.point]) continue;
    const Return* kept = lines.begin(row) + lines.lowerBound(row, other.azimuth - 1.1f * oneFiring);
    bool found = false;
    for (; kept < lines.end(row) && kept->azimuth < other.azimuth + 1.1f * oneFiring; ++kept)
      found = found || kept->rho <= other.rho;
    ASSERT_TRUE(found) << other.point;
  }
}

void expectEqualsBruteForce(const PointsView& points, const SensorModel& sensor, ScanLines& lines,
                            bool hasTwins = false) {
  const WholeScanCounts counts = buildWhole(lines, points, kMinRange, kMaxRange);
  const BruteForce expected(points, sensor);
  EXPECT_EQ(counts.lines.used, expected.counts.lines.used);
  EXPECT_EQ(counts.dropped.invalid, expected.counts.dropped.invalid);
  EXPECT_EQ(counts.dropped.outOfRange, expected.counts.dropped.outOfRange);
  EXPECT_EQ(counts.lines.outOfView, expected.counts.lines.outOfView);
  EXPECT_EQ(counts.lines.onGround, 0u);
  ASSERT_EQ(lines.rows(), sensor.beamCount());
  for (int row = 0; row < lines.rows(); ++row) {
    if (hasTwins) {
      expectNearerOnes(lines, row, expected.rows[row], sensor);
      continue;
    }
    std::vector<Return> found(lines.begin(row), lines.end(row));
    std::sort(found.begin(), found.end(),
              [](const Return& a, const Return& b) { return a.point < b.point; });
    ASSERT_EQ(found.size(), expected.rows[row].size()) << row;
    ASSERT_EQ(lines.size(row), found.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Return &a = found[i], &b = expected.rows[row][i];
      ASSERT_EQ(a.point, b.point);
      ASSERT_NEAR(a.azimuth, b.azimuth, 1e-6);
      ASSERT_EQ(a.rho, b.rho);
      ASSERT_EQ(a.z, b.z);
      ASSERT_EQ(lines.x(a), points.x[a.point]);
      ASSERT_EQ(lines.y(a), points.y[a.point]);
    }
  }
  expectSorted(lines);
}

/// Copies on the heap of just the right size, so that reading past the end shows under a sanitizer.
struct ExactCopy {
  explicit ExactCopy(const PointList& p)
      : x(new float[p.size()]), y(new float[p.size()]), z(new float[p.size()]), size(p.size()) {
    std::copy(p.x.begin(), p.x.end(), x.get());
    std::copy(p.y.begin(), p.y.end(), y.get());
    std::copy(p.z.begin(), p.z.end(), z.get());
  }
  std::unique_ptr<float[]> x, y, z;
  std::size_t size;
  PointsView view() const { return {x.get(), y.get(), z.get(), size}; }
};

TEST(ScanLines, EqualsABruteForceOnCloudsOfAnySize) {
  const SensorModel sensor = sensorModel();
  for (const std::size_t size :
       {0, 1, 2, 3, 4, 7, 8, 9, 15, 16, 17, 31, 33, 1000, 4097, 20000, 600000}) {
    SCOPED_TRACE(size);
    ScanLines lines(sensor);
    const ExactCopy copy(randomCloud(size, size));
    expectEqualsBruteForce(copy.view(), sensor, lines, size == 600000);
  }
}

TEST(ScanLines, CloudsInTheOrderOfRingsOrFiringsEqualABruteForce) {
  const SensorModel sensor = sensorModel("vlp16");
  sim::Random random(6);
  for (const bool rings : {true, false})
    for (const double direction : {1.0, -1.0})
      for (const double cut : {0.0, 75.0, 180.0}) {
        SCOPED_TRACE(testing::Message() << rings << ' ' << direction << ' ' << cut);
        constexpr int kColumns = 900, kRows = 16;
        PointList points;
        for (int i = 0; i < kColumns * kRows; ++i) {
          const int row = rings ? i / kColumns : i % kRows;
          const int column = rings ? i % kColumns : i / kRows;
          // Neighbours change places, and some points are of another beam.
          const double azimuth =
              cut + direction *
                        (column + 0.25 * (column % 3) + random.uniform(-0.1, 0.1) +
                         (column % 5 == 0 ? 1.5 : 0)) *
                        360 / kColumns;
          const double elevation = 15 - 2 * row + (random.below(100) == 0 ? 2 : 0);
          points.addPolar(std::remainder(azimuth, 360) * kDegree, elevation * kDegree,
                          random.uniform(5, 50));
        }
        ScanLines lines(sensor);
        expectEqualsBruteForce(points.view(), sensor, lines);
      }
}

TEST(ScanLines, KeepsNothingOfTheScanBefore) {
  const SensorModel sensor = sensorModel("hdl32e");
  ScanLines lines(sensor);
  for (const std::size_t size : {5000, 17, 9000, 0, 300})
    expectEqualsBruteForce(randomCloud(size, size).view(), sensor, lines);
}

TEST(ScanLines, OneBearingWithManyReturnsIsSorted) {
  const SensorModel sensor = sensorModel();
  PointList points;
  sim::Random random(4);
  for (int i = 0; i < 500; ++i)
    points.addPolar(1 + 1e-5 * random.below(50), -0.02, 10 + 0.25 * random.below(20));
  ScanLines lines(sensor);
  expectEqualsBruteForce(points.view(), sensor, lines, true);
}

TEST(ScanLines, TheAxesHaveTheirAzimuths) {
  const SensorModel sensor = sensorModel();
  PointList points;
  points.add(10, 0, 0);
  points.add(0, 10, 0);
  points.add(-10, 0, 0);
  points.add(-10, -0.0, 0);
  points.add(0, -10, 0);
  points.add(7, 7, 0);
  ScanLines lines(sensor);
  buildWhole(lines, points.view(), kMinRange, kMaxRange);
  std::vector<float> azimuth(points.size());
  for (int row = 0; row < lines.rows(); ++row)
    for (const Return* r = lines.begin(row); r < lines.end(row); ++r)
      azimuth[r->point] = r->azimuth;
  EXPECT_NEAR(azimuth[0], 0, 1e-7);
  EXPECT_NEAR(azimuth[1], M_PI / 2, 5e-7);
  EXPECT_NEAR(azimuth[2], M_PI, 5e-7);
  EXPECT_NEAR(azimuth[3], -M_PI, 5e-7);
  EXPECT_NEAR(azimuth[4], -M_PI / 2, 5e-7);
  EXPECT_NEAR(azimuth[5], M_PI / 4, 5e-7);
}

TEST(ScanLines, OrderOfPointsIsOfNoConsequence) {
  const SensorModel sensor = sensorModel();
  PointList points = randomCloud(20000, 5);
  points.append(randomCloud(2000, 5).view());  // duplicates
  for (int i = 0; i < 40; ++i) {               // alike in azimuth and range
    points.add(10, 3, -0.001 * (i % 7));
    points.add(2 + i * 0x1p-22, 20, 0.01);  // even when the last bits of x differ
  }
  ScanLines lines(sensor), others(sensor);
  buildWhole(lines, points.view(), kMinRange, kMaxRange);
  for (const std::uint64_t seed : {1, 2, 3}) {
    const PointList mixed = shuffled(points.view(), seed);
    buildWhole(others, mixed.view(), kMinRange, kMaxRange);
    for (int row = 0; row < lines.rows(); ++row) {
      ASSERT_EQ(lines.size(row), others.size(row));
      for (std::size_t i = 0; i < lines.size(row); ++i) {
        const Return &a = lines.begin(row)[i], &b = others.begin(row)[i];
        ASSERT_EQ(a.azimuth, b.azimuth);
        ASSERT_EQ(a.rho, b.rho);
        ASSERT_EQ(a.z, b.z);
        ASSERT_EQ(lines.x(a), others.x(b));
        ASSERT_EQ(lines.y(a), others.y(b));
      }
    }
  }
}

TEST(ScanLines, WhatBecomesOfPointsIsCounted) {
  const SensorModel sensor = sensorModel("vlp16");  // ±15°
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  PointList points;
  points.add(nan, 0, 0);
  points.add(10, nan, 0);
  points.add(10, 0, nan);
  points.add(inf, 0, 0);
  points.add(10, 0, -inf);
  points.add(0, 0, 0);
  points.add(0, -0.0, 0);  // invalid: 7
  points.add(0.99, 0, 0);
  points.add(0, -60.01, 0);
  points.add(0, 0, 5);  // straight above: no horizontal range; out of range: 3
  points.add(10, 0, 5);
  points.add(-10, 3, -5);  // out of view: 2
  points.add(1, 0, 0.0174533);
  points.add(0, 60, 1.04724);  // used: 2, on the bounds of range
  ScanLines lines(sensor);
  const WholeScanCounts counts = buildWhole(lines, points.view(), kMinRange, kMaxRange);
  EXPECT_EQ(counts.dropped.invalid, 7u);
  EXPECT_EQ(counts.dropped.outOfRange, 3u);
  EXPECT_EQ(counts.lines.outOfView, 2u);
  EXPECT_EQ(counts.lines.used, 2u);
}

TEST(ScanLines, WithoutALeastRangeAPointStraightAboveIsOutOfView) {
  const SensorModel sensor = sensorModel("vlp16");
  PointList points;
  points.add(0, 0, 5);
  points.add(0, 0, -5);
  ScanLines lines(sensor);
  EXPECT_EQ(buildWhole(lines, points.view(), 0, kMaxRange).lines.outOfView, 2u);
}

TEST(ScanLines, WhatLiesOnTheGroundIsLeftOut) {
  const SensorModel sensor = sensorModel();
  GroundGrid ground;
  PointList points;
  for (int i = 0; i < 3600; ++i)  // a slope of 5 %, and reflections below it
    for (const double rho : {6.0, 11.0, 17.0}) {
      const double azimuth = 0.1 * i * kDegree, x = rho * std::cos(azimuth),
                   y = rho * std::sin(azimuth);
      points.add(x, y, -1.7 + 0.05 * x);
      if (i % 300 == 0) points.add(x, y, -2.4 + 0.05 * x);
    }
  const std::size_t onGround = points.size();
  for (const double azimuth : {0.3, 2.1, -1.0})
    for (const double height : {0.45, 0.9, 1.5})
      points.add(10 * std::cos(azimuth), 10 * std::sin(azimuth),
                 -1.7 + 0.5 * std::cos(azimuth) + height);
  ground.build(points.view(), kMinRange, kMaxRange, 1.73f);
  ScanLines lines(sensor);
  const ScanLines::Counts& counts = lines.build(points.view(), ground, 0.35f);
  EXPECT_EQ(counts.onGround, onGround);
  EXPECT_EQ(counts.used, 9u);
}

TEST(ScanLines, LowerBoundEqualsABinarySearch) {
  const SensorModel sensor = sensorModel("vlp16");
  PointList points = randomCloud(8000, 11);
  for (int b = 0; b <= ScanLines::kParts; ++b)  // on the borders of the parts
    points.addPolar(-M_PI + 2 * M_PI * b / ScanLines::kParts, 1 * kDegree, 20);
  ScanLines lines(sensor);
  buildWhole(lines, points.view(), kMinRange, kMaxRange);
  for (int row = 0; row < lines.rows(); ++row) {
    const auto expect = [&](float azimuth) {
      const Return* found =
          std::lower_bound(lines.begin(row), lines.end(row), azimuth,
                           [](const Return& r, float value) { return r.azimuth < value; });
      ASSERT_EQ(lines.lowerBound(row, azimuth), static_cast<std::size_t>(found - lines.begin(row)))
          << row << ' ' << azimuth;
    };
    for (const Return* r = lines.begin(row); r < lines.end(row); ++r) {
      expect(r->azimuth);
      expect(std::nextafter(r->azimuth, 10.f));
      expect(std::nextafter(r->azimuth, -10.f));
    }
    for (int b = 0; b <= ScanLines::kParts; ++b)
      expect(static_cast<float>(-M_PI + 2 * M_PI * b / ScanLines::kParts));
    expect(-static_cast<float>(M_PI));
    expect(static_cast<float>(M_PI));
  }
}

}  // namespace
}  // namespace polemcl::test_scan_lines
