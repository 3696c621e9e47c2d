#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/localization/OdometryCalibration.h"

namespace polemcl::test_odometry_calibration {
namespace {
/// A drive in gentle bends whose odometry has a wrong scale and a yaw bias.
struct Bench {
  double scale, yawBias;  ///< true motion = odometry with these errors
  OdometryCalibration calibration;
  PoseWithCovariance pose;
  std::mt19937 random{1};
  int steps = 0;

  Bench(double scaleError, double bias) : scale(scaleError), yawBias(bias) {
    pose.covariance = Eigen::Vector3d(4e-4, 4e-4, 1e-6).asDiagonal();
  }
  void drive(double metres, bool known = true) {
    std::normal_distribution<double> normal;
    for (double driven = 0; driven < metres; driven += 0.5) {
      const Pose2D odometry{0.5, 0, 0.02 * std::sin(0.05 * ++steps)};
      pose.mean = compose(pose.mean, {0.5 * (1 + scale), 0, odometry.yaw + yawBias * odometry.x});
      PoseWithCovariance found = pose;
      found.mean.x += 0.02 * normal(random);
      found.mean.y += 0.02 * normal(random);
      found.mean.yaw += 0.001 * normal(random);
      calibration.add(odometry, Eigen::Vector3d(1e-6, 1e-6, 1e-8).asDiagonal(),
                      known ? &found : nullptr);
    }
  }
};

TEST(OdometryCalibration, FindsScaleAndYawBiasWithinItsSigmas) {
  for (const auto& [scale, yaw] :
       {std::pair{0.05, 0.0009}, std::pair{-0.03, -0.0003}, std::pair{0.01, 0.00017}}) {
    Bench bench(scale, yaw);
    bench.drive(200);
    const OdometryErrors errors = bench.calibration.errors();
    EXPECT_NEAR(errors.scale, scale, 0.003);
    EXPECT_NEAR(errors.yaw, yaw, 0.0001);
    EXPECT_LT(std::abs(errors.scale - scale), 4 * std::sqrt(errors.covariance(0, 0)));
    EXPECT_LT(std::abs(errors.yaw - yaw), 4 * std::sqrt(errors.covariance(1, 1)));
    EXPECT_LT(std::sqrt(errors.covariance(0, 0)), 0.004);
  }
}

TEST(OdometryCalibration, CorrectsMotionsAndStatesWhatIsLeft) {
  Bench bench(0.05, 0.0009);
  const Pose2D step{0.5, 0.01, 0.1};
  const Eigen::Matrix3d stated = Eigen::Matrix3d::Identity() * 1e-6;
  const double before = bench.calibration.correct(step, stated).covariance(0, 0);
  // At the start 2 %, which over 3 m of such steps add up to 0.06 m.
  const double metres = std::hypot(step.x, step.y), steps = 3 / metres;
  EXPECT_NEAR(std::sqrt(steps * (before - 1e-6)), 3 * 0.02 * step.x / metres, 1e-9);
  const Pose2D wide{5, 0, 0};  // longer than 3 m: counts as it is
  EXPECT_NEAR(bench.calibration.correct(wide, stated).covariance(0, 0), 1e-6 + 0.01, 1e-12);
  bench.drive(200);
  const CorrectedMotion corrected = bench.calibration.correct(step, stated);
  EXPECT_NEAR(corrected.motion.x, 0.525, 0.0015);
  EXPECT_NEAR(corrected.motion.yaw, 0.1 + 0.00045, 0.00005);
  EXPECT_LT(corrected.covariance(0, 0), before / 10);
}

// A comparison of 8 m that says 1.5 % +- 1 % and 0.045 +- 0.03 deg/m.
TEST(OdometryCalibration, BelievesOneUncertainComparisonByASmallPartOnly) {
  OdometryCalibration calibration;
  PoseWithCovariance begin, end;
  begin.covariance = end.covariance = Eigen::Vector3d(0.0032, 0.0032, 9e-6).asDiagonal();
  end.mean = {8 * 1.015, 0, 8 * 0.0008};
  calibration.add({}, Eigen::Matrix3d::Zero(), &begin);
  calibration.add({8, 0, 0}, Eigen::Matrix3d::Zero(), &end);
  const OdometryErrors errors = calibration.errors();
  EXPECT_GT(errors.scale, 0.0005);
  EXPECT_LT(errors.scale, 0.006);
  EXPECT_GT(errors.yaw, 0.00002);
  EXPECT_LT(errors.yaw, 0.0003);
  EXPECT_LT(std::abs(0.015 - errors.scale), 2 * std::sqrt(errors.covariance(0, 0)))
      << "what is not corrected is not known";

  OdometryCalibration sure(true, false);
  sure.add({}, Eigen::Matrix3d::Zero(), &begin);
  sure.add({8, 0, 0}, Eigen::Matrix3d::Zero(), &end);
  EXPECT_GT(sure.errors().scale, 2 * errors.scale);
}

TEST(OdometryCalibration, WithoutAMatchedPoleTheErrorsOfAllMotionsAddUp) {
  const OdometryCalibration calibration;
  const Eigen::Matrix3d none = Eigen::Matrix3d::Zero();
  double variance = 0, driven = 0;
  for (const double metres : {0.5, 0.1, 4.0, 7.0, 1.0, 0.0, 2.0}) {
    const Pose2D motion{metres, 0, 0};
    variance += calibration.correct(motion, none).covariance(0, 0) +
                calibration.unseenCovariance(motion, driven)(0, 0);
    driven += metres;
  }
  EXPECT_NEAR(std::sqrt(variance), driven * OdometryCalibration::scaleSigma, 0.02 * driven * 0.1);
  EXPECT_EQ(calibration.unseenCovariance({1, 0, 0}, 0.5), none) << "correct() covers the first 3 m";
  EXPECT_EQ(OdometryCalibration(false).unseenCovariance({1, 0, 0}, 100), none);
}

TEST(OdometryCalibration, WithoutPosesItsErrorsGrowWithTheWay) {
  OdometryCalibration calibration(true);
  const Eigen::Matrix2d first = calibration.errors().covariance;
  for (int i = 0; i < 500; ++i) calibration.add({2, 0, 0}, Eigen::Matrix3d::Identity(), nullptr);
  const Eigen::Matrix2d grown = calibration.errors().covariance - first;
  EXPECT_NEAR(std::sqrt(grown(0, 0)), std::sqrt(1000.0) * 5e-4, 1e-9);
  EXPECT_NEAR(std::sqrt(grown(1, 1)), std::sqrt(1000.0) * 1.7e-5, 1e-9);
}

// By the odometry just less than half a turn, by the poses just more.
TEST(OdometryCalibration, LearnsFromATurnBack) {
  Bench bench(0.02, 0.0009);
  const double before = bench.calibration.errors().covariance(0, 0);
  const Pose2D odometry{0.5, 0, (M_PI - 0.003) / 16};
  for (int i = 0; i <= 16; ++i) {
    if (i > 0)
      bench.pose.mean = compose(bench.pose.mean, {0.5 * 1.02, 0, odometry.yaw + 0.0009 * 0.5});
    bench.calibration.add(odometry, Eigen::Vector3d(1e-6, 1e-6, 1e-8).asDiagonal(), &bench.pose);
  }
  EXPECT_LT(bench.pose.mean.yaw, 0);
  EXPECT_LT(bench.calibration.errors().covariance(0, 0), before / 2);
}

TEST(OdometryCalibration, LearnsNothingWithoutPoses) {
  Bench bench(0.05, 0.0009);
  bench.drive(100, false);
  EXPECT_EQ(bench.calibration.errors().scale, 0);
  EXPECT_GT(bench.calibration.errors().covariance(0, 0), 0.02 * 0.02) << "it walks on";
}

TEST(OdometryCalibration, AJumpOfThePoseIsNoScale) {
  Bench bench(0, 0);
  bench.drive(100);
  bench.pose.mean.x += 5;
  bench.drive(20);
  EXPECT_NEAR(bench.calibration.errors().scale, 0, 0.003);
}

TEST(OdometryCalibration, PosesThatAreExactInSomeDirectionsDoNoHarm) {
  OdometryCalibration calibration;
  PoseWithCovariance begin, end;
  end.mean.x = 8.2;
  begin.covariance(1, 1) = end.covariance(1, 1) = 1e-4;
  calibration.add({}, Eigen::Matrix3d::Zero(), &begin);
  calibration.add({8, 0, 0}, Eigen::Matrix3d::Zero(), &end);
  EXPECT_TRUE(std::isfinite(calibration.errors().scale));
  EXPECT_TRUE(calibration.errors().covariance.allFinite());
}

TEST(OdometryCalibration, SwitchedOffItChangesNothing) {
  const OdometryCalibration calibration(false);
  const CorrectedMotion motion = calibration.correct({1, 2, 3}, Eigen::Matrix3d::Identity());
  EXPECT_EQ(motion.motion.x, 1);
  EXPECT_EQ(motion.covariance, Eigen::Matrix3d::Identity());
}

TEST(OdometryCalibration, StopsChangeNothing) {
  Bench drives(0.05, 0.0009), stops(0.05, 0.0009);
  for (int i = 0; i < 40; ++i) {
    drives.drive(5.5);
    stops.drive(5.5);
    for (int k = 0; k < 100; ++k) stops.calibration.add({}, Eigen::Matrix3d::Zero(), &stops.pose);
  }
  EXPECT_NEAR(stops.calibration.errors().scale, drives.calibration.errors().scale, 1e-3);
  EXPECT_NEAR(stops.calibration.errors().yaw, drives.calibration.errors().yaw, 5e-5);
}

}  // namespace
}  // namespace polemcl::test_odometry_calibration
