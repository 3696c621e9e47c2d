/// \file test_GlobalLocalizerCovariance.cpp
/// \brief Are the poses found without a start as uncertain as their covariances say?

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "core/global_localization/GlobalLocalizer.h"
#include "support/PoleCity.h"

namespace polemcl::test_global_localizer_covariance {

using tests::CityOptions;
using tests::DriveOptions;
using tests::Frame;
using tests::PoleCity;

namespace {

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

}  // namespace

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

}  // namespace polemcl::test_global_localizer_covariance
