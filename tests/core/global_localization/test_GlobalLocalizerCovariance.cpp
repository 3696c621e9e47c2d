// Are the poses found without a start as uncertain as their covariances say, and poles as
// far off as is tolerated?

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "core/global_localization/GlobalLocalizer.h"
#include "core/global_localization/PoseRefinement.h"
#include "support/PoleCity.h"
#include "support/Poles.h"

namespace polemcl::test_global_localizer_covariance {
namespace {

using tests::CityOptions;
using tests::DriveOptions;
using tests::Frame;
using tests::PoleCity;

/// Mean squared errors of resolved places, in units of their covariances.
struct Consistency {
  double pose = 0, position = 0, heading = 0;  ///< 3, 2 and 1 where covariances are right
  int places = 0;
};

/// \param unknown Error of the map beyond what its covariances say, along an axis, m.
Consistency consistencyOf(const DriveOptions& driving, const SubmapOptions& submapping,
                          const Eigen::Matrix3d* motionCovariance, double unknown) {
  Consistency sum;
  for (const std::uint64_t seed : {1071, 1072, 1073, 1074}) {
    CityOptions options;
    options.seed = seed;
    const PoleCity world(options);
    std::vector<MapPole> map = world.map();
    sim::Random off(seed);
    for (MapPole& pole : map) pole.x += off.normal(0, unknown), pole.y += off.normal(0, unknown);
    const GlobalLocalizer localizer(map);
    for (std::uint64_t travel = 0; travel < 60; ++travel) {
      sim::Random random(travel);
      const auto frames =
          tests::drive(world.surroundings(), world.randomWay(random, 60), driving, random);
      LocalSubmap submap(submapping);
      for (const Frame& frame : frames)
        motionCovariance ? submap.add(frame.motion, *motionCovariance, frame.poles_robot)
                         : submap.add(frame.motion, frame.poles_robot);
      const GlobalResult result = localizer.localize(submap);
      if (result.verdict != GlobalVerdict::resolved) continue;
      const Pose2D &found = result.hypotheses[0].pose_map_robot, &truth = frames.back().truth;
      const Eigen::Matrix3d& covariance = result.hypotheses[0].covariance;
      const Eigen::Vector3d error(found.x - truth.x, found.y - truth.y,
                                  wrapAngle(found.yaw - truth.yaw));
      const Eigen::Vector2d offset = error.head<2>();
      const Eigen::Matrix2d ofPosition = covariance.topLeftCorner<2, 2>();
      sum.pose += error.dot(covariance.inverse() * error);
      sum.position += offset.dot(ofPosition.inverse() * offset);
      sum.heading += error.z() * error.z() / covariance(2, 2);
      ++sum.places;
    }
  }
  return {sum.pose / sum.places, sum.position / sum.places, sum.heading / sum.places, sum.places};
}

using Places = std::vector<Eigen::Vector2d>;

/// A robot at the origin that has seen poles once, and their map. A pole seen is off from its map
/// pole by 0.1 m along an axis: 0.005 m^2 as seen, 0.0025 on the map, 0.05 m beyond both.
struct SeenOnce {
  SeenOnce(const Places& seen, const Places& mapped)
      : submap(submapOf(seen)), map(mapOf(mapped), options()), query(submap, map.options) {}
  static LocalSubmap submapOf(const Places& seen) {
    SubmapOptions exact;
    exact.floor = 0;
    LocalSubmap submap(exact);
    std::vector<PoleDetection> poles;
    for (const Eigen::Vector2d& at : seen)
      poles.push_back(tests::detectionAt(at.x(), at.y(), 0.005));
    submap.add({}, poles);
    return submap;
  }
  static std::vector<MapPole> mapOf(const Places& mapped) {
    std::vector<MapPole> map;
    for (const Eigen::Vector2d& at : mapped)
      map.push_back(tests::mapPoleAt(at.x(), at.y(), 0.0025));
    return map;
  }
  static GlobalOptions options() {
    GlobalOptions result;
    result.minHits = 1;
    result.maxRefined = 100;
    result.sigma = 0.05;
    return result;
  }
  LocalSubmap submap;
  PreparedMap map;
  Constellation query;
};

// Where all is as the options say: exact odometry, and map poles off by their covariance and sigma.
TEST(GlobalLocalizerCovariance, ItsCovarianceIsWhatItsErrorsAre) {
  DriveOptions exact;
  exact.odometryNoise = 0;
  SubmapOptions submap;
  submap.floor = 0.001;
  submap.scale = 0.0001;
  const Eigen::Matrix3d none = Eigen::Matrix3d::Zero();
  const Consistency c = consistencyOf(exact, submap, &none, GlobalOptions().sigma);
  ASSERT_GE(c.places, 235);
  // 99 of 100 cases: 2.58·sqrt(2·degrees/235), of 3, 2 and 1 degrees of freedom.
  EXPECT_NEAR(c.pose, 3, 0.412);
  EXPECT_NEAR(c.position, 2, 0.337);
  EXPECT_NEAR(c.heading, 1, 0.238);
}

// With the default options on a map as good as it says: sigma allows for worse ones, and the walks
// for worse headings. Poles share the drift of the odometry, which is taken as each one's own.
TEST(GlobalLocalizerCovariance, ItsCovarianceIsCautiousByDefault) {
  const Consistency c = consistencyOf({}, {}, nullptr, 0);
  ASSERT_GE(c.places, 235);
  EXPECT_NEAR(c.pose, 1.90, 0.26);  // measured, ± 2.58 of its standard deviations
  EXPECT_NEAR(c.position, 1.62, 0.27);
  EXPECT_NEAR(c.heading, 0.27, 0.065);
}

// Laid on two poles 20 m apart, each off by 0.1 m along an axis: the variance of their middle is
// 0.01 m^2 / 2, that of their direction 2 * 0.01 / 20^2. The pole adds its own 0.01 m^2; 2.5
// standard deviations of it all are tolerated.
TEST(GlobalLocalizerCovariance, APolesToleranceHasThePairsErrorAndItsOwn) {
  const Places places = {{10, -10}, {10, 10}, {10, 0}, {30, 0}};
  const SeenOnce robot(places, places);
  const std::vector<QueryPole>& poles = robot.query.queryPoles();
  ASSERT_EQ(poles.size(), 4u);
  const PairTolerance tolerance(robot.map, robot.query, poles[0], poles[1]);
  EXPECT_NEAR(tolerance.of(poles[2]), 2.5 * std::sqrt(0.005 + 0.01), 1e-6);
  EXPECT_NEAR(tolerance.of(poles[3]), 2.5 * std::sqrt(0.005 + 5e-5 * 20 * 20 + 0.01), 1e-6);
}

// One of five poles stands 0.85 m off on the map. No pair of the others tolerates more than 0.71 m.
TEST(GlobalLocalizerCovariance, APoleBeyondItsToleranceIsNoHit) {
  const Places seen = {{-9, 2}, {11, -4}, {3, 13}, {-6, -12}, {14, 9}};
  Places mapped = seen;
  const SeenOnce right(seen, mapped);
  mapped.back() += Eigen::Vector2d(0.6, 0.6);
  const SeenOnce wrong(seen, mapped);
  const auto best = [](const SeenOnce& robot) {
    return ConstellationSearch(robot.map, robot.query).run().at(0).hits;
  };
  EXPECT_EQ(best(right), 3u);  // beyond the pair
  EXPECT_EQ(best(wrong), 2u);
}

// A ring of 50 poles seen from its middle: headings 7.2 degrees apart fit alike, and all are tried.
TEST(GlobalLocalizerCovariance, HeadingsSevenDegreesApartAreDifferentCandidates) {
  Places seen, mapped;
  for (int i = 0; i < 50; ++i) {
    const double azimuth = i * M_PI / 25, turned = azimuth + 0.01;
    seen.emplace_back(15 * std::cos(azimuth), 15 * std::sin(azimuth));
    mapped.emplace_back(1 + 15 * std::cos(turned), 1 + 15 * std::sin(turned));
  }
  const SeenOnce robot(seen, mapped);
  std::size_t count = 0;
  for (const PoseCandidate& one : ConstellationSearch(robot.map, robot.query).run())
    count += std::hypot(one.pose_map_robot.x - 1, one.pose_map_robot.y - 1) < 0.1;
  EXPECT_EQ(count, 50u);
}

// Six poles on a circle, on the map 2.4 sigma farther out and farther in by turns: no motion makes
// that better. Twelve coordinates less three unknowns share the sum of the squares.
TEST(GlobalLocalizerCovariance, ResidualsWidenItByTheirDegreesOfFreedom) {
  const auto varianceAlongX = [](double off) {
    Places seen, mapped;
    for (int i = 0; i < 6; ++i) {
      const Eigen::Vector2d out(std::cos(i * M_PI / 3), std::sin(i * M_PI / 3));
      seen.push_back(12 * out);
      mapped.push_back((i % 2 ? 12 + off : 12 - off) * out);
    }
    const SeenOnce robot(seen, mapped);
    GlobalHypothesis found;
    PoseRefinement refinement(robot.map, robot.query, robot.submap.pose());
    EXPECT_TRUE(refinement.run({{}, 4, 0, 3}, found));
    EXPECT_EQ(found.matched, 6u);
    return found.covariance(0, 0);
  };
  EXPECT_NEAR(varianceAlongX(0), 0.01 / 6, 1e-6);
  EXPECT_NEAR(varianceAlongX(0.24), 0.01 / 6 * (6 * 2.4 * 2.4 / 9), 1e-5);
}

}  // namespace
}  // namespace polemcl::test_global_localizer_covariance
