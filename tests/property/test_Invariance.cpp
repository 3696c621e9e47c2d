/// \file test_Invariance.cpp
/// \brief What no input may change, on scenes drawn by RapidCheck: a rigid motion of everything
/// moves the results along, and the order of poles says nothing.
/// Scenes are the same each time; RC_PARAMS="seed=N" draws others, and looks for the smallest scene
/// that fails.

#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include <polemcl/core/localization/PoleLikelihood.h>
#include <polemcl/core/mapping/PoleMapBuilder.h>
#include <polemcl/localizer/Localizer.h>
#include <polemcl/localizer/Settings.h>
#include "core/common/PoleIndex.h"
#include "core/common/Transform.h"
#include "core/global_localization/GlobalLocalizer.h"
#include "core/localization/ScanRegistration.h"
#include "mrpt/filter/LocalizationPipeline.h"

namespace polemcl::test_invariance {
namespace {

const int kSeeded = setenv("RC_PARAMS", "seed=1 noshrink=1", 0);

double within(double low, double high) {
  return low + (high - low) * (*rc::gen::inRange(0, 1000001) / 1e6);
}
/// Anywhere in UTM; headings often at ±π and at right angles.
Pose2D anyMotion() {
  const double yaw =
      *rc::gen::inRange(0, 3) == 0 ? M_PI / 2 * *rc::gen::inRange(-2, 3) : within(-M_PI, M_PI);
  return {within(-9e5, 9e5), within(0, 9e6), yaw};
}
std::vector<MapPole> anyMap(std::size_t most) {
  std::vector<MapPole> map(static_cast<std::size_t>(*rc::gen::inRange<int>(1, most + 1)));
  for (MapPole& pole : map) {
    pole.x = within(-60, 60);
    pole.y = within(-60, 60);
    pole.radius = 0.1;
    pole.covariance = Eigen::Matrix2d::Identity() * 4e-4;
  }
  return map;
}
MapPole moved(const Pose2D& motion, MapPole pole) {
  const Pose2D at = compose(motion, {pole.x, pole.y, 0});
  pole.x = at.x;
  pole.y = at.y;
  pole.covariance =
      symmetrized<2>(rotationOf(motion.yaw) * pole.covariance * rotationOf(motion.yaw).transpose());
  return pole;
}
std::vector<MapPole> moved(const Pose2D& motion, std::vector<MapPole> map) {
  for (MapPole& pole : map) pole = moved(motion, pole);
  return map;
}
/// Poles that no error of a detection makes one.
std::vector<MapPole> apartFromEachOther(std::vector<MapPole> map) {
  std::vector<MapPole> kept;
  for (const MapPole& pole : map)
    if (std::none_of(kept.begin(), kept.end(), [&](const MapPole& other) {
          return (centreOf(pole) - centreOf(other)).norm() < 3;
        }))
      kept.push_back(pole);
  return kept;
}
/// What is seen of the map from a pose, with some noise; maybe a fifth of it far off.
std::vector<PoleDetection> seen(const std::vector<MapPole>& map, const Pose2D& pose,
                                bool farOff = true) {
  std::vector<PoleDetection> poles;
  for (const MapPole& pole : map) {
    const Pose2D at = relative(pose, {pole.x, pole.y, 0});
    PoleDetection detection;
    detection.x = at.x + within(-0.05, 0.05);
    detection.y = at.y + within(-0.05, 0.05);
    if (farOff && *rc::gen::inRange(0, 5) == 0) detection.x += within(-5, 5);
    detection.radius = 0.1;
    detection.confidence = within(0.3, 1);
    detection.covariance << 4e-4, 1e-4, 1e-4, 9e-4;
    poles.push_back(detection);
  }
  return poles;
}
template <class Value>
std::vector<Value> shuffled(std::vector<Value> values) {
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  std::shuffle(values.begin(), values.end(), random);
  return values;
}
double apart(const Pose2D& a, const Pose2D& b) {
  return std::hypot(a.x - b.x, a.y - b.y) + std::abs(std::remainder(a.yaw - b.yaw, 2 * M_PI));
}

}  // namespace

RC_GTEST_PROP(Invariance, MotionsUndoEachOther, ()) {
  ASSERT_EQ(kSeeded, 0);
  const Pose2D a = anyMotion(), b = anyMotion();
  RC_ASSERT(apart(relative(a, compose(a, b)), b) < 1e-7);  // 1e7 m have 2e-9
  RC_ASSERT(std::abs(compose(a, b).yaw) <= M_PI);
}

RC_GTEST_PROP(Invariance, LikelihoodOfAWorldMovedAsAWhole, ()) {
  LikelihoodOptions options;
  options.model = *rc::gen::element(LikelihoodModel::mixture, LikelihoodModel::paper);
  const auto map = anyMap(40);
  const Pose2D pose{within(-1, 1), within(-1, 1), within(-0.1, 0.1)}, motion = anyMotion();
  const auto poles = seen(map, {});
  const double here = logLikelihood(poles, pose, PoleIndex(map), options);
  const double there =
      logLikelihood(poles, compose(motion, pose), PoleIndex(moved(motion, map)), options);
  RC_ASSERT(std::abs(here - there) < 1e-3 * (1 + std::abs(here)));
}

RC_GTEST_PROP(Invariance, LikelihoodOfShuffledPoles, ()) {
  const auto map = anyMap(40);
  const auto poles = seen(map, {});
  const double one = logLikelihood(poles, {}, PoleIndex(map), {});
  const double other = logLikelihood(shuffled(poles), {}, PoleIndex(shuffled(map)), {});
  RC_ASSERT(std::abs(one - other) < 1e-9 * (1 + std::abs(one)));
}

RC_GTEST_PROP(Invariance, RegistrationOfShuffledPoles, ()) {
  const auto map = anyMap(40);
  const auto before = seen(map, {}), after = seen(map, {0.5, 0.02, 0.03});
  const auto one = refineMotion(before, after, {}, {});
  const auto other = refineMotion(shuffled(before), shuffled(after), {}, {});
  RC_ASSERT(one.pairs == other.pairs);
  RC_ASSERT(apart(one.motion, other.motion) < 1e-6);
}

RC_GTEST_PROP(Invariance, MapOfAWorldMovedAsAWhole, ()) {
  const auto world = apartFromEachOther(anyMap(30));
  const Pose2D motion = anyMotion();
  std::vector<MappingScan> here;
  for (int i = 0; i < 8; ++i) {
    const Pose2D pose{2.1 * i, 0.01 * i, 0};
    here.push_back({pose, seen(world, pose, false)});
  }
  auto there = here;
  for (MappingScan& scan : there) {
    scan.pose_map_robot = compose(motion, scan.pose_map_robot);
    scan.poles_robot = shuffled(scan.poles_robot);
  }
  const auto map = moved(motion, buildPoleMap(here, {}).poles);
  const auto other = buildPoleMap(there, {}).poles;
  RC_ASSERT(map.size() == other.size());
  for (const MapPole& pole : map)
    RC_ASSERT(std::any_of(other.begin(), other.end(), [&](const MapPole& found) {
      return std::hypot(pole.x - found.x, pole.y - found.y) < 1e-5;
    }));
}

TEST(Invariance, SearchInAWorldMovedAsAWhole) {
  int resolved = 0;
  const auto holds = [&] {
    const auto map = anyMap(60);
    const Pose2D motion = anyMotion(), start{within(-20, 20), within(-20, 20), within(-M_PI, M_PI)};
    LocalSubmap submap;
    for (int i = 0; i < 4; ++i) {
      const Pose2D step{i > 0 ? 1.0 : 0.0, 0, 0};
      submap.add(step, 1e-6 * Eigen::Matrix3d::Identity(),
                 seen(map, compose(start, {1.0 * i, 0, 0})));
    }
    const GlobalResult here = GlobalLocalizer(map).localize(submap);
    const GlobalResult there = GlobalLocalizer(shuffled(moved(motion, map))).localize(submap);
    RC_ASSERT(here.verdict == there.verdict);
    if (here.verdict != GlobalVerdict::resolved) return;
    ++resolved;
    RC_ASSERT(apart(compose(motion, here.hypotheses[0].pose_map_robot),
                    there.hypotheses[0].pose_map_robot) < 1e-3);
  };
  EXPECT_TRUE(rc::check("a search in a world moved as a whole", holds));
  EXPECT_GT(resolved, 50) << "of 100 scenes";
}

/// Thirty steps ahead, from each of which all poles are seen.
LocalizationUpdate driven(const std::vector<MapPole>& map, const Pose2D& motion) {
  const auto poles = std::make_shared<CPoleMap>();
  poles->setPoles(moved(motion, map));
  Localizer localizer(Settings(), LocalizationMap(poles), 1);
  localizer.start(motion, 1.0, 0.1);
  LocalizationUpdate update;
  for (int i = 0; i < 30; ++i) {
    PoleScan scan;
    scan.time = 0.1 * i;
    scan.motion = PoseWithCovariance{{0.7, 0, 0}, 1e-6 * Eigen::Matrix3d::Identity()};
    std::vector<PoleDetection> all;
    for (const MapPole& pole : map) {
      PoleDetection detection;
      detection.x = pole.x - 0.7 * i;
      detection.y = pole.y;
      detection.radius = 0.1;
      detection.confidence = 0.9;
      detection.covariance = Eigen::Matrix2d::Identity() * 4e-4;
      all.push_back(detection);
    }
    scan.poles_robot = all;
    update = localizer.step(scan);
  }
  return update;
}

// Particles are drawn along the axes of the map, so a turned map has others.
TEST(Invariance, PoseInAWorldMovedAsAWhole) {
  int compared = 0;
  const auto holds = [&] {
    const auto map = apartFromEachOther(anyMap(60));
    const Pose2D motion = anyMotion();
    const LocalizationUpdate here = driven(map, {}), there = driven(shuffled(map), motion);
    if (here.health.state != HealthState::ok || there.health.state != HealthState::ok) return;
    ++compared;
    const double most = 5 * std::sqrt(here.estimate->covariance.trace());
    RC_ASSERT(apart(here.estimate->mean, {0.7 * 29, 0, 0}) < most);
    RC_ASSERT(apart(compose(motion, here.estimate->mean), there.estimate->mean) < most);
  };
  EXPECT_TRUE(rc::check("a drive in a world moved as a whole", holds));
  EXPECT_GT(compared, 50) << "of 100 scenes";
}

}  // namespace polemcl::test_invariance
