/// \file test_Extremes.cpp
/// \brief The least and the most of everything: covariances, numbers of poles in a map and in a
/// scan, places.

#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include <polemcl/core/mapping/PoleMapBuilder.h>
#include <polemcl/localizer/Localizer.h>
#include <polemcl/localizer/MapBuilder.h>
#include <polemcl/localizer/Settings.h>
#include <polemcl/mrpt/observation/CObservationPoles.h>
#include "core/common/Transform.h"
#include "mrpt/filter/LocalizationPipeline.h"

namespace polemcl::test_extremes {
namespace {

const int kExtremesSeeded = setenv("RC_PARAMS", "seed=1 noshrink=1", 0);
constexpr double kLeast = std::numeric_limits<double>::denorm_min();

double between(double low, double high) {
  return low + (high - low) * (*rc::gen::inRange(0, 1000001) / 1e6);
}

MapPole mapPole(double x, double y) {
  MapPole pole;
  pole.x = x;
  pole.y = y;
  pole.radius = 0.1;
  pole.covariance = Eigen::Matrix2d::Identity() * 4e-4;
  return pole;
}

/// A street of 60 poles, unevenly spaced.
std::vector<MapPole> street() {
  std::vector<MapPole> poles;
  for (int i = 0; i < 60; ++i)
    poles.push_back(mapPole(4.0 * i + (i * i) % 7 * 0.5, i % 2 == 0 ? 6 : -7));
  return poles;
}

std::vector<PoleDetection> seenFrom(double x, const std::vector<MapPole>& map) {
  std::vector<PoleDetection> poles;
  for (const MapPole& pole : map) {
    if (std::hypot(pole.x - x, pole.y) > 50) continue;
    PoleDetection detection;
    detection.x = pole.x - x;
    detection.y = pole.y;
    detection.radius = 0.1;
    detection.confidence = 0.9;
    detection.covariance = Eigen::Matrix2d::Identity() * 4e-4;
    poles.push_back(detection);
  }
  return poles;
}

Localizer localizerIn(const std::vector<MapPole>& map, const Settings& settings = {}) {
  const auto poles = std::make_shared<CPoleMap>();
  poles->setPoles(map);
  return {settings, LocalizationMap(poles), 1};
}

PoleScan scanAt(int i, const std::vector<MapPole>& seen) {
  PoleScan scan;
  scan.time = 0.1 * i;
  scan.motion = PoseWithCovariance{{0.7, 0, 0}, 1e-6 * Eigen::Matrix3d::Identity()};
  scan.poles_robot = seenFrom(0.7 * i, seen);
  return scan;
}

LocalizationUpdate drive(Localizer& localizer, const std::vector<MapPole>& seen) {
  LocalizationUpdate update;
  for (int i = 0; i < 40; ++i) update = localizer.step(scanAt(i, seen));
  return update;
}

}  // namespace

TEST(Extremes, OnePoleInTheMapGivesAPoseThatIsNotOk) {
  ASSERT_EQ(kExtremesSeeded, 0);
  const std::vector<MapPole> map{mapPole(20, 6)};
  Localizer localizer = localizerIn(map);
  localizer.start({}, 1.0, 0.1);
  const LocalizationUpdate update = drive(localizer, map);
  ASSERT_TRUE(update.estimate);
  EXPECT_TRUE(update.estimate->covariance.allFinite());
  EXPECT_NE(update.health.state, HealthState::ok);
}

TEST(Extremes, AMapOf200000PolesIsLocalizedIn) {
  const std::vector<MapPole> near = street();
  std::vector<MapPole> all = near;
  for (int i = 0; all.size() < 200000; ++i) {  // a grid, 40 m apart, round the street
    const MapPole pole = mapPole(40.0 * (i % 500) - 10000, 40.0 * (i / 500) - 8000);
    if (std::hypot(pole.x - 120, pole.y) > 200) all.push_back(pole);
  }
  Localizer localizer = localizerIn(all);
  localizer.start({}, 1.0, 0.1);
  const LocalizationUpdate update = drive(localizer, near);
  EXPECT_EQ(update.health.state, HealthState::ok);
  EXPECT_NEAR(update.estimate->mean.x, 0.7 * 39, 0.05);
  EXPECT_NEAR(update.estimate->mean.y, 0, 0.05);
}

/// Scans with 10,000 poles more, of little confidence: they are left out, in filter and map.
TEST(Extremes, OfScansOf10000PolesTheMostConfidentAreUsed) {
  const std::vector<MapPole> map = street();
  Localizer localizer = localizerIn(map);
  localizer.start({}, 1.0, 0.1);
  Settings settings;
  MapBuilder full(settings), few(settings);
  LocalizationUpdate update;
  std::mt19937 random(1);
  for (int i = 0; i < 117; ++i) {
    CObservationPoles scan;
    scan.timestamp = mrpt::Clock::fromDouble(1 + 0.1 * i);
    scan.points = 100;
    scan.poles = seenFrom(0.7 * i, map);
    const std::size_t clear = scan.poles.size();
    for (int k = 0; k < 10000; ++k) {
      PoleDetection clutter = scan.poles[0];
      clutter.x = static_cast<double>(random() % 10000) / 100 - 50;
      clutter.y = static_cast<double>(random() % 10000) / 100 - 50;
      clutter.confidence = 0.3;
      scan.poles.push_back(clutter);
    }
    PoleScan frame = scanAt(i, map);
    frame.poles_robot = scan.poles;
    update = localizer.step(frame);
    EXPECT_EQ(update.poles, 200u);
    full.add(scan, {0.7 * i, 0, 0});
    scan.poles.resize(200);
    ASSERT_LT(clear, 200u);
    few.add(scan, {0.7 * i, 0, 0});
  }
  EXPECT_NEAR(update.estimate->mean.x, 0.7 * 116, 0.05);
  const std::vector<MapPole> found = full.poles(), expected = few.poles();
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].x, expected[i].x);
}

/// A step gives numbers or says what is wrong, and the next good scan after a start gives a pose.
RC_GTEST_PROP(Extremes, NoNumberBreaksAStep, ()) {
  const std::vector<MapPole> map = street();
  Localizer localizer = localizerIn(map);
  localizer.start({}, 1.0, 0.1);
  const auto variance = [] {
    return *rc::gen::element(0.0, kLeast, 1e-300, 1e-12, 1e-4, 1.0, 1e4, 1e300,
                             std::numeric_limits<double>::infinity());
  };
  int steps = 0;
  for (int i = 0; i < 4; ++i) {
    PoleScan scan = scanAt(i, map);
    scan.motion->covariance = Eigen::Vector3d(variance(), variance(), variance()).asDiagonal();
    for (PoleDetection& pole : scan.poles_robot) {
      pole.covariance = Eigen::Vector2d(variance(), variance()).asDiagonal();
      if (*rc::gen::inRange(0, 5) == 0)
        pole.x = *rc::gen::element(0.0, kLeast, -kLeast, 1e-300, between(-1e9, 1e9));
      if (*rc::gen::inRange(0, 5) == 0) pole.radius = *rc::gen::element(0.0, kLeast, 1e300);
    }
    try {
      const LocalizationUpdate update = localizer.step(scan);
      ++steps;
      if (!update.estimate) continue;
      RC_ASSERT(std::isfinite(update.estimate->mean.x + update.estimate->mean.yaw));
      RC_ASSERT(update.estimate->covariance.allFinite());
    } catch (const Error&) {  // says what is wrong
    }
  }
  RC_CLASSIFY(steps > 0);
  localizer.start({2.8, 0, 0}, 1.0, 0.1);
  LocalizationUpdate update;
  for (int i = 4; i < 14; ++i) update = localizer.step(scanAt(i, map));
  RC_ASSERT(update.estimate.has_value());
  RC_ASSERT(std::hypot(update.estimate->mean.x - 9.1, update.estimate->mean.y) < 0.1);
}

}  // namespace polemcl::test_extremes
