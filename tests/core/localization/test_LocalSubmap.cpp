#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <optional>

#include "core/localization/LocalSubmap.h"
#include "support/PoleCity.h"
#include "support/Poles.h"
#include "support/Refusal.h"

namespace polemcl::test_local_submap {
namespace {

PoleDetection seen(double x, double y, double variance = 0.01) {
  return tests::detectionAt(x, y, variance);
}

/// No floor to speak of, no error of scale.
SubmapOptions exact() {
  SubmapOptions options;
  options.floor = 1e-6;
  options.scale = 0;
  return options;
}

/// As exact(), and poles that are not seen stay.
SubmapOptions patient() {
  SubmapOptions options = exact();
  options.minShare = 0;
  return options;
}

const double kNan = std::nan("");

TEST(LocalSubmap, AveragesByInformation) {
  LocalSubmap submap(exact());
  submap.add({}, {seen(10, 2, 0.01)});
  submap.add({}, {seen(10.2, 2, 0.03)});  // a third of the weight of the first
  ASSERT_EQ(submap.poles().size(), 1u);
  const SubmapPole& pole = submap.poles()[0];
  EXPECT_NEAR(pole.centre.x(), 10.05, 1e-6);
  EXPECT_NEAR(pole.centre.y(), 2, 1e-6);
  EXPECT_NEAR(pole.covariance(0, 0), 0.0075, 1e-6);
  EXPECT_EQ(pole.hits, 2u);
  EXPECT_EQ(pole.chances, 2u);
}

TEST(LocalSubmap, WhatDetectionsShareDoesNotAverageOut) {
  SubmapOptions options;
  options.floor = 0.05;
  LocalSubmap submap(options);
  for (int i = 0; i < 1000; ++i) submap.add({}, {seen(10, 0)});
  EXPECT_NEAR(submap.poles()[0].covariance(0, 0), 0.0025 + 0.01 / 1000, 1e-6);
}

TEST(LocalSubmap, BringsViewsFromDifferentPlacesTogether) {
  LocalSubmap submap;
  submap.add({}, {seen(10, 5)});
  submap.add({10, 0, M_PI / 2}, {seen(5, 0)});  // now straight ahead
  ASSERT_EQ(submap.poles().size(), 1u);
  EXPECT_NEAR((submap.poles()[0].centre - Eigen::Vector2d(10, 5)).norm(), 0, 1e-9);
  EXPECT_NEAR(submap.pose().x, 10, 1e-12);
  EXPECT_NEAR(submap.pose().yaw, M_PI / 2, 1e-12);
  EXPECT_NEAR(submap.driven(), 10, 1e-12);
}

TEST(LocalSubmap, OpensAnotherPoleBeyondTheGate) {
  SubmapOptions options = exact();
  options.gate = 3;  // of sqrt(0.01 + 0.01) = 0.1414 m: 0.424 m
  LocalSubmap submap(options);
  submap.add({}, {seen(10, 0)});
  submap.add({}, {seen(10.43, 0)});
  EXPECT_EQ(submap.poles().size(), 2u);
  LocalSubmap other(options);
  other.add({}, {seen(10, 0)});
  other.add({}, {seen(10.42, 0)});
  EXPECT_EQ(other.poles().size(), 1u);
}

TEST(LocalSubmap, GatesByTheCovarianceAlongTheError) {
  PoleDetection pole = seen(20, 0);
  pole.covariance << 0.25, 0, 0, 0.0004;  // 0.5 m along the line of sight, 2 cm across it
  LocalSubmap submap(exact());
  submap.add({}, {pole});
  pole.x = 21;
  submap.add({}, {pole});
  EXPECT_EQ(submap.poles().size(), 1u);
  pole.y = 0.5;
  submap.add({}, {pole});
  EXPECT_EQ(submap.poles().size(), 2u);
}

TEST(LocalSubmap, GivesAPoleOneDetectionAFrameAndThatTheNearest) {
  LocalSubmap submap(exact());
  submap.add({}, {seen(10, 0)});
  submap.add({}, {seen(10.3, 0), seen(10.1, 0)});
  ASSERT_EQ(submap.poles().size(), 2u);
  EXPECT_EQ(submap.poles()[0].hits, 2u);
  EXPECT_NEAR(submap.poles()[0].centre.x(), 10.05, 1e-6);
  EXPECT_NEAR(submap.poles()[1].centre.x(), 10.3, 1e-6);
}

TEST(LocalSubmap, CountsMissedChancesOnlyInView) {
  SubmapOptions options;
  options.viewRange = 25;
  LocalSubmap submap(options);
  submap.add({}, {seen(20, 0), seen(30, 0)});
  submap.add({}, {});
  ASSERT_EQ(submap.poles().size(), 2u);
  EXPECT_EQ(submap.poles()[0].chances, 2u);
  EXPECT_EQ(submap.poles()[1].chances, 1u);
  submap.add({10, 0, 0}, {});  // both in view
  EXPECT_EQ(submap.poles()[0].chances, 3u);
  EXPECT_EQ(submap.poles()[1].chances, 2u);
}

TEST(LocalSubmap, ForgetsWithDistanceNotWithTime) {
  SubmapOptions options;
  options.length = 50;
  options.minShare = 0;
  LocalSubmap submap(options);
  submap.add({}, {seen(30, 0)});
  for (int i = 0; i < 50; ++i) submap.add({1, 0, 0}, {});
  EXPECT_EQ(submap.poles().size(), 1u);
  submap.add({1, 0, 0}, {});
  EXPECT_EQ(submap.poles().size(), 0u);
}

TEST(LocalSubmap, DropsWhatIsHardlyEverSeenButNothingSure) {
  SubmapOptions options;
  options.sureHits = 3;
  LocalSubmap submap(options);
  for (int i = 0; i < 3; ++i) submap.add({}, {seen(10, 0)});
  submap.add({}, {seen(0, 10)});
  for (int i = 0; i < 8; ++i) submap.add({}, {});
  EXPECT_EQ(submap.poles().size(), 2u);  // nine chances
  submap.add({}, {});
  ASSERT_EQ(submap.poles().size(), 1u);
  EXPECT_EQ(submap.poles()[0].hits, 3u);
  for (int i = 0; i < 100; ++i) submap.add({}, {});
  EXPECT_EQ(submap.poles().size(), 1u);
}

TEST(LocalSubmap, StaysSmallWhileStandingAmongFalseDetections) {
  LocalSubmap submap;
  sim::Random random(3);
  for (int i = 0; i < 2000; ++i) {
    std::vector<PoleDetection> poles;
    for (int k = 0; k < 5; ++k)
      poles.push_back(seen(random.uniform(-17, 17), random.uniform(-17, 17), 0.001));
    submap.add({}, poles);
  }
  EXPECT_LT(submap.poles().size(), 150u);
  EXPECT_EQ(submap.path().size(), 2u);
}

TEST(LocalSubmap, OlderPolesAreLessCertain) {
  SubmapOptions options;
  options.positionWalk = 0.02;
  options.headingWalk = 0;
  options.turnWalk = 0;
  options.scale = 0.01;
  LocalSubmap submap(options);
  submap.add({}, {seen(10, 0)});
  for (int i = 0; i < 50; ++i) submap.add({1, 0, 0}, {});
  const SubmapPole& pole = submap.poles()[0];
  const double own = pole.covariance(0, 0), walked = 50 * 0.0004;
  EXPECT_NEAR(submap.presentCovariance(pole)(0, 0), own + walked + 0.25, 1e-9);
  EXPECT_NEAR(submap.presentCovariance(pole)(1, 1), own + walked, 1e-9);
  EXPECT_NEAR(submap.presentCovariance(pole, false)(0, 0), own + walked, 1e-9);
}

TEST(LocalSubmap, UsesTheMotionsOwnCovariance) {
  LocalSubmap submap(exact());
  submap.add({}, {seen(10, 0)});
  const Eigen::Matrix3d covariance = Eigen::Vector3d(0.04, 0.09, 0).asDiagonal();
  submap.add({1, 0, 0}, covariance, {});
  const Eigen::Matrix2d present = submap.presentCovariance(submap.poles()[0]);
  EXPECT_NEAR(present(0, 0), 0.05, 1e-6);
  EXPECT_NEAR(present(1, 1), 0.10, 1e-6);
}

TEST(LocalSubmap, HandsOutPolesAsTheRobotWouldSeeThem) {
  SubmapOptions options = exact();
  options.positionWalk = options.headingWalk = options.turnWalk = 0;
  LocalSubmap submap(options);
  PoleDetection pole = seen(10, 5);
  pole.covariance << 0.04, 0, 0, 0.01;
  submap.add({}, {pole});
  submap.add({10, 0, M_PI / 2}, {});
  EXPECT_TRUE(submap.detections(2).empty());
  const std::vector<PoleDetection> poles = submap.detections(1);
  ASSERT_EQ(poles.size(), 1u);
  EXPECT_NEAR(poles[0].x, 5, 1e-9);
  EXPECT_NEAR(poles[0].y, 0, 1e-9);
  EXPECT_NEAR(poles[0].covariance(0, 0), 0.01, 1e-6);
  EXPECT_NEAR(poles[0].covariance(1, 1), 0.04, 1e-6);
  EXPECT_EQ(poles[0].points, 1u);
}

TEST(LocalSubmap, KeepsThePathOfTheLastMetres) {
  SubmapOptions options;
  options.length = 20;
  LocalSubmap submap(options);
  submap.add({}, {});
  for (int i = 0; i < 400; ++i) submap.add({0.125, 0, 0}, {});
  EXPECT_GE(submap.path().size(), 20u);
  EXPECT_LE(submap.path().size(), 22u);
  EXPECT_NEAR(submap.path().back().x(), 50, 1e-9);
  EXPECT_NEAR(submap.path().front().x(), 30, 1.01);
}

TEST(LocalSubmap, DoesNotUseDetectionsWithoutConfidence) {
  PoleDetection doubtful = seen(10, 0);
  doubtful.confidence = 0;
  LocalSubmap submap;
  submap.add({}, {doubtful});
  EXPECT_TRUE(submap.poles().empty());
}

TEST(LocalSubmap, ClearStartsAnew) {
  LocalSubmap submap;
  submap.add({}, {seen(10, 0)});
  submap.add({1, 0, 1}, {});
  submap.clear();
  EXPECT_TRUE(submap.poles().empty());
  EXPECT_EQ(submap.frames(), 0u);
  submap.add({99, 0, 0}, {seen(10, 0)});  // the motion before a first frame has no meaning
  EXPECT_EQ(submap.pose().x, 0);
  EXPECT_EQ(submap.poles()[0].centre.x(), 10);
}

/// Against the truth of 80 simulated drives.
struct Consistency {
  double squared = 0;  ///< mean squared error in units of the covariance: 2 if that is exact
  std::size_t poles = 0, strays = 0;
};

Consistency consistencyOf(const tests::DriveOptions& driving, const SubmapOptions& options,
                          const std::optional<Eigen::Matrix3d>& motionCovariance) {
  Consistency result;
  for (std::uint64_t seed = 11; seed < 15; ++seed) {
    const tests::PoleCity city({seed});
    sim::Random random(seed + 12);
    for (int run = 0; run < 20; ++run) {
      const std::vector<tests::Frame> frames =
          tests::drive(city.surroundings(), city.randomWay(random, 60), driving, random);
      LocalSubmap submap(options);
      for (const tests::Frame& frame : frames)
        submap.add(frame.motion, motionCovariance.value_or(walkCovariance(frame.motion, options)),
                   frame.poles_robot);
      const Pose2D& truth = frames.back().truth;
      for (const PoleDetection& pole : submap.detections(4)) {
        const Pose2D at = compose(truth, {pole.x, pole.y, 0});
        Eigen::Vector2d best(1e9, 0);
        for (const auto* things : {&city.surroundings().poles, &city.surroundings().clutter})
          for (const Eigen::Vector2d& thing : *things) {
            const Eigen::Vector2d error = thing - Eigen::Vector2d(at.x, at.y);
            if (error.norm() < best.norm()) best = error;
          }
        const Eigen::Vector2d error_robot = Eigen::Rotation2Dd(-truth.yaw) * best;
        ++result.poles;
        if (best.norm() > 1)
          ++result.strays;
        else
          result.squared += error_robot.dot(pole.covariance.inverse() * error_robot);
      }
    }
  }
  result.squared /= static_cast<double>(result.poles - result.strays);
  return result;
}

TEST(LocalSubmap, PolesAreAsCertainAsItSays) {
  tests::DriveOptions exact;
  exact.odometryNoise = exact.falsePerFrame = 0;
  SubmapOptions options;
  options.floor = 0.001;
  options.scale = 0.0001;
  const Consistency c = consistencyOf(exact, options, Eigen::Matrix3d::Zero());
  EXPECT_GT(c.poles, 2000u);
  EXPECT_EQ(c.strays, 0u);
  EXPECT_NEAR(c.squared, 2.1, 0.2);  // a little above 2: now and then a neighbour takes part
}

// The default allows for an error of the odometry's scale, which these drives do not have.
TEST(LocalSubmap, PolesAreMoreCertainThanItSaysByDefault) {
  const Consistency c = consistencyOf({}, {}, std::nullopt);
  EXPECT_GT(c.poles, 2000u);
  EXPECT_LE(c.strays, c.poles / 500);
  EXPECT_NEAR(c.squared, 0.84, 0.13);  // measured, ± 2.6 standard deviations of 80 drives' mean
}

TEST(LocalSubmap, RefusesNumbersThatAreNone) {
  LocalSubmap submap;
  submap.add({}, {seen(10, 0)});
  EXPECT_REFUSED(submap.add({kNan, 0, 0}, {}), "motion before frame 1");
  EXPECT_REFUSED(submap.add({0, 0, kNan}, {}), "motion before frame 1");
  EXPECT_REFUSED(submap.add({}, {seen(10, 0), seen(kNan, 0)}), "pole 1 of frame 1");
  EXPECT_REFUSED(submap.add({}, {seen(1.1e9, 0)}), "more than 1e9 m away");
  EXPECT_REFUSED(submap.add({}, {seen(10, 0, -0.01)}), "positive semidefinite");
  PoleDetection crooked = seen(10, 0);
  crooked.covariance(0, 1) = 0.005;
  EXPECT_REFUSED(submap.add({}, {crooked}), "symmetric");
  PoleDetection overSure = seen(10, 0);
  overSure.confidence = 1.1;
  EXPECT_REFUSED(submap.add({}, {overSure}), "confidence");
  EXPECT_REFUSED(submap.add({}, -Eigen::Matrix3d::Identity(), {}), "covariance of the motion");
  EXPECT_EQ(submap.frames(), 1u);  // nothing has changed
  EXPECT_EQ(submap.poles()[0].hits, 1u);
}

TEST(LocalSubmap, TakesEachDetectionOnceAveraged) {
  LocalSubmap submap(exact());
  submap.add({}, {seen(10, 2, 0.01)});
  EXPECT_TRUE(submap.take(2, 1).empty());  // one hit may be nothing
  submap.add({}, {seen(10.2, 2, 0.03)});
  const auto first = submap.take(2, 1);
  ASSERT_EQ(first.size(), 1u);
  EXPECT_NEAR(first[0].x, 10.05, 1e-6);
  EXPECT_NEAR(first[0].covariance(0, 0), 0.0075, 1e-6);
  EXPECT_EQ(first[0].points, 2u);
  EXPECT_TRUE(submap.take(2, 1).empty());  // given out already

  // Half a metre on, too soon; a metre on, the mean of what came since and of nothing before.
  const Eigen::Matrix3d sure = Eigen::Matrix3d::Zero();
  submap.add({0.5, 0, 0}, sure, {seen(9.4, 2, 0.02)});
  EXPECT_TRUE(submap.take(2, 1).empty());
  submap.add({0.5, 0, 0}, sure, {seen(9.0, 2, 0.02)});
  const auto second = submap.take(2, 1);
  ASSERT_EQ(second.size(), 1u);
  EXPECT_NEAR(second[0].x, 8.95, 1e-6);  // of 9.4 - 0.5 and 9.0, from here
  EXPECT_NEAR(second[0].covariance(0, 0), 0.01, 1e-6);
}

// Frames are a little less than the distance apart: waiting for the next would double it.
TEST(LocalSubmap, TakesAtTheFrameNearestToTheDistance) {
  LocalSubmap submap(exact());
  const Eigen::Matrix3d sure = Eigen::Matrix3d::Zero();
  submap.add({}, {seen(10, 2)});
  submap.add({}, {seen(10, 2)});
  ASSERT_EQ(submap.take(2, 0.5).size(), 1u);
  submap.add({0.2, 0, 0}, sure, {seen(9.8, 2)});
  EXPECT_TRUE(submap.take(2, 0.5).empty());
  submap.add({0.29, 0, 0}, sure, {seen(9.51, 2)});
  EXPECT_EQ(submap.take(2, 0.5).size(), 1u);
  submap.add({0.2, 0, 0}, sure, {seen(9.31, 2)});
  EXPECT_TRUE(submap.take(2, 0.5).empty());
}

TEST(LocalSubmap, FarFromTheStartItsCovariancesAreThoseNearIt) {
  const auto afterKilometres = [](int kilometres) {
    LocalSubmap submap(patient());
    submap.add({}, {});
    const Eigen::Matrix3d rough = Eigen::Vector3d(0.25, 0.25, 4e-4).asDiagonal();
    const Eigen::Matrix3d fine = Eigen::Vector3d(1e-6, 1e-6, 1e-8).asDiagonal();
    for (int i = 0; i < 100 * kilometres; ++i) submap.add({10, 0, 0}, rough, {});
    submap.add({1, 0, 0}, rough, {seen(5, 5, 1e-4)});
    for (int i = 0; i < 30; ++i) submap.add({0.01, 0, 0}, fine, {});
    submap.add({0.01, 0, 0}, fine, {seen(5.2, -5, 1e-4)});
    for (int i = 0; i < 30; ++i) submap.add({0.01, 0, 0}, fine, {});
    return std::pair(submap.presentCovariance(submap.poles().at(0)),
                     submap.presentCovariance(submap.poles().at(1)));
  };
  const auto [near, nearLater] = afterKilometres(0);
  for (const int kilometres : {9, 11, 600}) {
    const auto [far, farLater] = afterKilometres(kilometres);
    EXPECT_LT((far - near).norm(), 1e-7) << kilometres;
    EXPECT_LT((farLater - nearLater).norm(), 1e-7) << kilometres;
  }
}

// The origin moves on between the sightings of two poles: what drift lies between them stays.
TEST(LocalSubmap, TheDriftBetweenPolesStaysWhereTheOriginMovesOn) {
  const auto between = [](double begin) {
    LocalSubmap submap(patient());
    const Eigen::Matrix3d fine = Eigen::Vector3d(1e-4, 1e-4, 1e-5).asDiagonal();
    submap.add({}, {});
    submap.add({begin, 0, 0}, fine, {seen(5, 5, 1e-4)});
    for (int i = 0; i < 20; ++i) submap.add({1, 0, 0}, fine, {});
    submap.add({1, 0, 0}, fine, {seen(5, -5, 1e-4)});
    const SubmapPole &then = submap.poles().at(0), &now = submap.poles().at(1);
    return OdometryDrift::between(then.drift, now.drift, then.centre);
  };
  const Eigen::Matrix2d expected = between(100);
  EXPECT_GT(expected(1, 1), 0.002);
  EXPECT_LT((between(9990) - expected).norm(), 1e-9);
}

TEST(LocalSubmap, TakesOnlyWhatIsSeenNow) {
  LocalSubmap submap(exact());
  submap.add({}, {seen(10, 2)});
  submap.add({}, {seen(10, 2)});
  submap.add({}, {});
  EXPECT_TRUE(submap.take(2, 0).empty());
  submap.add({}, {seen(10, 2)});
  EXPECT_EQ(submap.take(2, 0).size(), 1u);
}

Eigen::Matrix3d diagonal(double x, double y, double yaw) {
  return Eigen::Vector3d(x, y, yaw).asDiagonal();
}

TEST(OdometryDrift, AStepsPositionNoiseTurnsWithTheRobot) {
  const OdometryDrift then;
  OdometryDrift now;  // uncertain in the direction of the drive
  now.add({std::sqrt(3), 1}, M_PI / 6, diagonal(0.04, 0.01, 0));
  const Eigen::Matrix2d covariance = OdometryDrift::between(then, now, {7, 3});
  EXPECT_NEAR(covariance(0, 0), 0.75 * 0.04 + 0.25 * 0.01, 1e-12);
  EXPECT_NEAR(covariance(1, 1), 0.25 * 0.04 + 0.75 * 0.01, 1e-12);
  EXPECT_NEAR(covariance(0, 1), std::sqrt(3) / 4 * (0.04 - 0.01), 1e-12);
}

TEST(OdometryDrift, ATurnSwingsWhatLiesFar) {
  const OdometryDrift then;
  OdometryDrift now;
  now.add({5, 0}, 0, diagonal(0, 0, 1e-4));  // 0.01 rad
  EXPECT_NEAR(OdometryDrift::between(then, now, {5, 0}).norm(), 0, 1e-12);
  const Eigen::Matrix2d ahead = OdometryDrift::between(then, now, {25, 0});
  EXPECT_NEAR(ahead(1, 1), 0.04, 1e-12);  // 20 m · 0.01 sideways
  EXPECT_NEAR(ahead(0, 0), 0, 1e-12);
  const Eigen::Matrix2d across = OdometryDrift::between(then, now, {8, 4});  // along (-4, 3)
  EXPECT_NEAR(across(0, 0), 16e-4, 1e-12);
  EXPECT_NEAR(across(1, 1), 9e-4, 1e-12);
  EXPECT_NEAR(across(0, 1), -12e-4, 1e-12);
  EXPECT_EQ(across(1, 0), across(0, 1));
}

TEST(OdometryDrift, CountsOnlyTheStepsBetween) {
  OdometryDrift then;
  then.add({100, 0}, 0, diagonal(1, 1, 1));
  OdometryDrift now = then;
  EXPECT_EQ(OdometryDrift::between(then, now, {3, 4}).norm(), 0);
  now.add({101, 0}, 0, diagonal(0.01, 0.01, 0));
  EXPECT_NEAR(OdometryDrift::between(then, now, {3, 4})(0, 0), 0.01, 1e-12);
}

}  // namespace

}  // namespace polemcl::test_local_submap
