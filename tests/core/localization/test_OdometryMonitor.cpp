#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/localization/OdometryMonitor.h"
#include "support/PoleCity.h"
#include "support/Poles.h"
#include "support/StraightDrive.h"

namespace polemcl::test_odometry_monitor {
namespace {

/// A drive through a city at 10 Hz, `step` metres a scan, odometry off by 2 % of each component.
struct CheckedDrive {
  std::vector<tests::Frame> frames;
  double step = 0.7;

  CheckedDrive(std::uint64_t seed, double metres, double stepMetres = 0.7, double density = 1,
               double falsePerFrame = 1.5)
      : step(stepMetres) {
    tests::CityOptions options;
    options.seed = seed;
    options.density = density;
    const tests::PoleCity city(options);
    sim::Random random(seed + 100);
    tests::Way way;
    do way = tests::resample(city.randomWay(random, metres), step);
    while (turnsBack(way));
    tests::DriveOptions driving;
    driving.falsePerFrame = falsePerFrame;
    frames = tests::drive(city.surroundings(), way, driving, random);
  }
  /// At the city's edge ways turn round on the spot, which no vehicle does.
  static bool turnsBack(const tests::Way& way) {
    for (std::size_t i = 2; i < way.size(); ++i)
      if ((way[i] - way[i - 1]).dot(way[i - 1] - way[i - 2]) < 0) return true;
    return false;
  }
  static Eigen::Matrix3d covarianceOf(const Pose2D& motion) {
    const auto variance = [](double value, double floor) {
      return 4e-4 * value * value + floor * floor;
    };
    return Eigen::Vector3d(variance(motion.x, 1e-3), variance(motion.y, 1e-3),
                           variance(motion.yaw, 1e-4))
        .asDiagonal();
  }
  /// `spoilt` makes the odometry of a scan.
  std::vector<MonitoredMotion> run(
      OdometryMonitor& check,
      const std::function<Pose2D(std::size_t, const Pose2D&)>& spoilt) const {
    std::vector<MonitoredMotion> results;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const Pose2D motion = spoilt(i, frames[i].motion);
      results.push_back(check.add(100 + 0.1 * static_cast<double>(i), motion, covarianceOf(motion),
                                  frames[i].poles_robot));
    }
    return results;
  }
};

Pose2D scaled(const Pose2D& motion, double factor) {
  return {factor * motion.x, factor * motion.y, factor * motion.yaw};
}

/// Error of the way composed from scan `from` to `to`, m.
double drift(const CheckedDrive& drive, const std::vector<MonitoredMotion>& motions,
             std::size_t from, std::size_t to) {
  Pose2D pose = drive.frames[from].truth;
  for (std::size_t i = from + 1; i <= to; ++i) pose = compose(pose, motions[i].motion);
  return std::hypot(pose.x - drive.frames[to].truth.x, pose.y - drive.frames[to].truth.y);
}

/// Two scans with a motion between them: `seen` by the poles, `stated` by the odometry.
MonitoredMotion afterTwoScans(const std::vector<Eigen::Vector2d>& places, const Pose2D& seen,
                              const Pose2D& stated,
                              const Eigen::Matrix3d& covariance = 1e-8 *
                                                                  Eigen::Matrix3d::Identity()) {
  std::vector<PoleDetection> before, after;
  for (const Eigen::Vector2d& place : places) {
    const Pose2D at = relative(seen, {place.x(), place.y(), 0});
    before.push_back(tests::detectionAt(place.x(), place.y(), 1e-4));
    after.push_back(tests::detectionAt(at.x, at.y, 1e-4));
  }
  OdometryMonitor check;
  check.add(0, {}, covariance, before);
  return check.add(0.1, stated, covariance, after);
}

const std::vector<Eigen::Vector2d> kAllRound = {{12, 6}, {15, -7},  {-9, 8},
                                                {22, 5}, {-13, -6}, {2, -9}};

/// How many scans replaced the odometry.
std::size_t countReplaced(const std::vector<PoleScan>& scans) {
  OdometryMonitor check;
  std::size_t replaced = 0;
  for (const PoleScan& scan : scans) {
    const auto motion = scan.motion.value_or(PoseWithCovariance());
    replaced += check.add(scan.time, motion.mean, motion.covariance, scan.poles_robot).replaced;
  }
  return replaced;
}

/// In a turn, three far poles on one side do not tell the motion well. They do not outweigh that no
/// vehicle stops at once.
TEST(OdometryMonitor, FewFarPolesDoNotConfirmAnImpossibleStop) {
  const Pose2D motion{0.78, 0, 0.07};
  OdometryMonitor check;
  Pose2D pose;
  for (int i = 0; i < 12; ++i, pose = compose(pose, motion)) {
    std::vector<PoleDetection> poles;
    for (const auto& [x, y] : {std::pair{6.8, 16.4}, {2.3, 18.8}, {-5.8, 23.2}}) {
      const Pose2D at = relative(pose, {x, y, 0});
      poles.push_back(tests::detectionAt(at.x, at.y, 1e-2));
    }
    const bool isStuck = i >= 8;
    const auto result =
        check.add(0.1 * i, isStuck ? Pose2D() : motion, CheckedDrive::covarianceOf(motion), poles);
    EXPECT_EQ(result.replaced, isStuck) << i;
  }
}

TEST(OdometryMonitor, LeavesAHealthyOdometryAlone) {
  for (const double step : {0.02, 0.3, 0.7, 1.5})
    for (const std::uint64_t seed : {1, 2, 3}) {
      const CheckedDrive drive(seed, step < 0.1 ? 30 : 400, step);
      OdometryMonitor check;
      std::size_t agreed = 0;
      const auto results = drive.run(check, [](std::size_t, const Pose2D& m) { return m; });
      for (std::size_t i = 0; i < results.size(); ++i) {
        EXPECT_FALSE(results[i].replaced) << step << ' ' << seed << ' ' << i;
        EXPECT_EQ(results[i].motion.x, drive.frames[i].motion.x);
        agreed += results[i].verdict == OdometryVerdict::agrees;
      }
      EXPECT_GT(agreed, results.size() / 2);
    }
}

TEST(OdometryMonitor, EvenRowsOfPolesDoNotSpeakAgainstTheOdometry) {
  for (const double distance : {2.0, 4.0, 5.0})
    for (const std::uint64_t seed : {1, 2, 3})
      EXPECT_EQ(countReplaced(tests::straightDrive(tests::evenRow(distance), 2, {}, seed)), 0u)
          << distance << ' ' << seed;
}

TEST(OdometryMonitor, PolesThatMoveAlongWithTheVehicleDoNotStopIt) {
  for (const std::uint64_t seed : {1, 2, 3})
    EXPECT_EQ(countReplaced(tests::straightDrive(tests::streetPoles(), 1, tests::kLorry, seed)), 0u)
        << seed;
}

TEST(OdometryMonitor, AStuckOdometryIsReplacedAtOnceAndBelievedAgain) {
  for (const double step : {0.5, 1.5})
    for (const std::uint64_t seed : {4, 5, 6}) {
      const CheckedDrive drive(seed, 300 * step, step, 2);
      OdometryMonitor check;
      const auto results = drive.run(check, [](std::size_t i, const Pose2D& motion) {
        return i >= 50 && i < 150 ? Pose2D() : motion;
      });
      for (std::size_t i = 0; i < results.size(); ++i) {
        const bool contradicted = results[i].verdict == OdometryVerdict::contradicted;
        if (i < 50 || i > 165) {
          EXPECT_FALSE(contradicted) << i;
        }
        if (i >= 53 && i < 150) {
          EXPECT_TRUE(contradicted) << i;
        }
      }
      EXPECT_LT(drift(drive, results, 49, 160), 0.03 * 110 * step) << step << ' ' << seed;
    }
}

// Odometry so uncertain that only a whole second contradicts it. It is 1.4 m off then: farther than
// poles are paired.
TEST(OdometryMonitor, ASlipShowsWhichASecondOnlyTells) {
  OdometryMonitor check;
  MonitoredMotion motion;
  for (int i = 0; i <= 15; ++i) {
    std::vector<PoleDetection> poles;
    for (int k = -6; k < 8; ++k) {
      const double x = 6 * k + 2 * std::sin(7.0 * k) - 0.7 * i;
      if (std::abs(x) < 25) poles.push_back(tests::detectionAt(x, k % 2 ? 5 : -6, 1e-3));
    }
    const Eigen::Matrix3d covariance = Eigen::Vector3d(2.6e-3, 1e-5, 1e-6).asDiagonal();
    motion = check.add(0.1 * i, {0.84, 0, 0}, covariance, poles);
    EXPECT_FALSE(i < 9 && motion.replaced) << i;
  }
  EXPECT_EQ(motion.verdict, OdometryVerdict::contradicted);
  EXPECT_NEAR(motion.motion.x, 0.7, 0.05);
}

// 7 m/s, then nothing: no vehicle stops in a tenth of a second. After 5 s it must have.
TEST(OdometryMonitor, WithoutPolesASuddenStopIsDoubtedForAWhile) {
  OdometryMonitor check;
  const Eigen::Matrix3d covariance = 1e-6 * Eigen::Matrix3d::Identity();
  for (int i = 0; i < 100; ++i) {
    const bool stuck = i >= 20, doubted = stuck && i < 70;
    const double step = stuck ? 0 : 0.7;
    const MonitoredMotion motion = check.add(100 + 0.1 * i, {step, 0, 0}, covariance, {});
    EXPECT_EQ(motion.replaced, doubted) << i;
    EXPECT_EQ(motion.verdict == OdometryVerdict::contradicted, doubted) << i;
    EXPECT_NEAR(motion.motion.x, doubted ? 0.7 : step, 1e-12) << i;
    EXPECT_NEAR(motion.covariance(0, 0), doubted ? 0.35 * 0.35 : 0, 1e-4) << i;
  }
}

// Hard braking from 14 m/s, with scan times that are 10 ms off.
/// Scans 3.6 m and 0.9 s apart, so that a stop may be hard braking. Each sees four poles, two of
/// them again: too few to tell a motion, and half of them, as the monitor assumes at first.
struct SparseDrive {
  OdometryMonitor check;
  int scan = 0, count = 0;
  std::vector<PoleDetection> poles() const {
    std::vector<PoleDetection> seen;
    for (const int k : {scan, scan + 1})
      for (const int side : {-1, 1}) {
        const double turn = 0.618 * (2 * k + side), aside = 5 + 8 * (turn - std::floor(turn));
        seen.push_back(tests::detectionAt(8 + 3.6 * (k - scan) + side, side * aside, 1e-4));
      }
    return seen;
  }
  MonitoredMotion drive(const Pose2D& stated) {
    ++scan;
    return check.add(0.9 * ++count, stated, 1e-6 * Eigen::Matrix3d::Identity(), poles());
  }
  MonitoredMotion drive(double stated) { return drive(Pose2D{stated, 0, 0}); }
};

TEST(OdometryMonitor, PolesOfWhichNoneIsSeenAgainContradict) {
  SparseDrive drive;
  for (int i = 0; i < 40; ++i) EXPECT_EQ(drive.drive(3.6).verdict, OdometryVerdict::unknown) << i;
  // A chance of 1 in 16 each, so of 1 in 4096 after the third.
  for (int i = 0; i < 2; ++i) EXPECT_EQ(drive.drive(0).verdict, OdometryVerdict::unknown) << i;
  for (int i = 0; i < 3; ++i) {
    const MonitoredMotion motion = drive.drive(0);
    EXPECT_EQ(motion.verdict, OdometryVerdict::contradicted) << i;
    EXPECT_NEAR(motion.motion.x, 3.6, 1e-9) << "the speed before";
  }
  EXPECT_EQ(drive.drive(3.6).verdict, OdometryVerdict::unknown);
}

// A bus hides four poles at once, and shows four corners.
TEST(OdometryMonitor, FourPolesAtOnceAreNotEnough) {
  SparseDrive drive;
  for (int i = 0; i < 40; ++i) {
    drive.scan = -1;  // it stands
    drive.drive(0);
  }
  drive.scan = 9;
  EXPECT_EQ(drive.drive(0).verdict, OdometryVerdict::unknown);
  drive.scan = 19;
  EXPECT_EQ(drive.drive(0).verdict, OdometryVerdict::contradicted) << "eight are";
}

// Snow, say: from now on nothing is seen again. That is not the fault of the odometry.
TEST(OdometryMonitor, AfterFiveSecondsTheOdometryIsBelievedWithoutPolesSeenAgain) {
  SparseDrive drive;
  for (int i = 0; i < 40; ++i) drive.drive(3.6);
  double contradicted = 0;
  for (int i = 0; i < 40; ++i) {
    drive.scan += 10;  // other poles
    contradicted += drive.drive(3.6).verdict == OdometryVerdict::contradicted;
  }
  EXPECT_GT(contradicted, 0);
  EXPECT_LE(contradicted, 6);
}

// The poles are behind, and false ones flicker. The vehicle brakes and turns: that is no fault.
TEST(OdometryMonitor, PolesThatVanishDoNotReplaceAnOdometryThatHasNotChanged) {
  SparseDrive drive;
  for (int i = 0; i < 40; ++i) drive.drive(3.6);
  for (int i = 0; i < 8; ++i) {
    drive.scan += 10;
    const Pose2D stated{i < 3 ? 3.6 : 2.5, 0, i < 3 ? 0 : 0.3};
    const MonitoredMotion motion = drive.drive(stated);
    EXPECT_FALSE(motion.replaced) << i;
    EXPECT_EQ(motion.motion.x, stated.x) << i;
    EXPECT_EQ(motion.motion.yaw, stated.yaw) << i;
  }
}

TEST(OdometryMonitor, PolesThatFlickerFromTheBeginningDoNotStopTheVehicle) {
  SparseDrive drive;
  for (int i = 0; i < 20; ++i) {
    drive.scan += 10;
    EXPECT_FALSE(drive.drive(3.6).replaced) << i;
  }
}

// As after a stall of the network: then two scans are 5 ms apart, and the next comes 195 ms later.
TEST(OdometryMonitor, StampsCloseTogetherTellNoSpeed) {
  for (const double before : {0.0, 1.0, 5.0}) {
    OdometryMonitor check;
    for (int i = 0; i < 200; ++i) {
      const double early = i > 0 && i % 10 == 1 ? 0.095 : 0;
      const auto motion =
          check.add(before + 0.1 * i - early, {1.5, 0, 0}, 1e-6 * Eigen::Matrix3d::Identity(), {});
      EXPECT_FALSE(motion.replaced) << i;
    }
  }
}

// All scans of a stall are stamped when they come, 1 ms apart.
TEST(OdometryMonitor, ScansInABurstAfterAStallDoNotReplaceTheOdometry) {
  for (const double step : {0.3, 1.0, 2.0})
    for (const int burst : {2, 3, 6, 9}) {
      SCOPED_TRACE(testing::Message() << step << " m, " << burst << " scans");
      OdometryMonitor check;
      for (int i = 0; i < 200; ++i) {
        const int late = i % 50 >= 20 && i % 50 < 20 + burst ? 20 + burst - 1 - i % 50 : 0;
        const auto motion = check.add(100 + 0.1 * i + 0.099 * late, {step, 0, 0},
                                      1e-6 * Eigen::Matrix3d::Identity(), {});
        EXPECT_FALSE(motion.replaced) << i;
      }
    }
}

TEST(OdometryMonitor, AnOdometryThatStopsDuringAGapIsReplacedAScanLater) {
  OdometryMonitor check;
  const auto add = [&](double time, double metres) {
    return check.add(time, {metres, 0, 0}, 1e-6 * Eigen::Matrix3d::Identity(), {});
  };
  for (int i = 0; i < 20; ++i) add(0.1 * i, 1);
  const MonitoredMotion late = add(2.3, 0);
  EXPECT_EQ(late.verdict, OdometryVerdict::contradicted);
  EXPECT_EQ(late.motion.x, 0) << "a burst may follow";
  const MonitoredMotion next = add(2.4, 0);
  EXPECT_TRUE(next.replaced);
  EXPECT_NEAR(next.motion.x, 1, 1e-6);
}

TEST(OdometryMonitor, APoleThatIsSeenAgainSpeaksForTheOdometry) {
  SparseDrive drive;
  for (int i = 0; i < 40; ++i) drive.drive(3.6);
  for (const double stated : {0.0, 0.0, 3.6, 0.0, 0.0})
    EXPECT_EQ(drive.drive(stated).verdict, OdometryVerdict::unknown);
}

TEST(OdometryMonitor, WithoutPolesHardBrakingIsBelieved) {
  OdometryMonitor check;
  double speed = 14;
  for (int i = 0; i < 60; ++i) {
    if (i > 20) speed = std::max(0.0, speed - 0.9);
    const double late = i % 2 == 0 ? 0.01 : -0.01;
    const Pose2D motion{0.1 * speed, 0, 0};
    EXPECT_FALSE(check.add(100 + 0.1 * i + late, motion, Eigen::Matrix3d::Zero(), {}).replaced)
        << i;
  }
}

TEST(OdometryMonitor, ASlippingOdometryIsReplacedWithinASecond) {
  for (const double factor : {0.8, 1.2})
    for (const std::uint64_t seed : {7, 8, 9}) {
      const CheckedDrive drive(seed, 210, 0.7, 2);
      OdometryMonitor check;
      const auto results = drive.run(check, [&](std::size_t i, const Pose2D& motion) {
        return i >= 50 && i < 200 ? scaled(motion, factor) : motion;
      });
      std::size_t contradicted = 0;
      for (std::size_t i = 0; i < results.size(); ++i) {
        const bool is = results[i].verdict == OdometryVerdict::contradicted;
        contradicted += is && i >= 60 && i < 200;
        if (i < 50 || i > 215) {
          EXPECT_FALSE(is) << i;
        }
      }
      EXPECT_GE(contradicted, 133u);
      EXPECT_LT(drift(drive, results, 49, 210), 4) << factor << ' ' << seed;  // slipped: 21 m
    }
}

TEST(OdometryMonitor, AStandingVehicleWithSpinningWheelsIsNoticed) {
  const CheckedDrive drive(10, 8, 0.01, 2);
  OdometryMonitor check;
  const auto results = drive.run(check, [](std::size_t i, const Pose2D& motion) {
    return i >= 100 ? Pose2D{0.4, 0, 0} : motion;
  });
  for (std::size_t i = 105; i < results.size(); ++i) {
    EXPECT_EQ(results[i].verdict, OdometryVerdict::contradicted) << i;
    EXPECT_NEAR(results[i].motion.x, 0, 0.2) << i;
  }
}

TEST(OdometryMonitor, AJumpToAnotherPlaceIsNotTakenForAMotion) {
  const CheckedDrive before(11, 100), later(12, 100);
  OdometryMonitor check;
  CheckedDrive both = before;
  both.frames.insert(both.frames.end(), later.frames.begin(), later.frames.end());
  const auto results = both.run(check, [](std::size_t, const Pose2D& motion) { return motion; });
  for (std::size_t i = 0; i < before.frames.size() + 40; ++i) {
    const Pose2D& motion = results[i].motion;
    EXPECT_LT(std::hypot(motion.x, motion.y), 5);
  }
  EXPECT_EQ(results.back().verdict, OdometryVerdict::agrees);
}

TEST(OdometryMonitor, WithoutPolesTheOdometryIsAllThereIs) {
  OdometryMonitor check;
  for (int i = 0; i < 50; ++i) {
    const double step = i > 20 ? std::max(0.0, 0.7 - 0.05 * (i - 20)) : 0.7;  // brakes
    const auto result = check.add(0.1 * i, {step, 0, 0}, 1e-6 * Eigen::Matrix3d::Identity(), {});
    EXPECT_EQ(result.verdict, OdometryVerdict::unknown);
    EXPECT_FALSE(result.replaced);
  }
}

TEST(OdometryMonitor, BlindAmidAFaultItKeepsTheSpeedForAWhile) {
  const CheckedDrive drive(13, 210);
  OdometryMonitor check;
  CheckedDrive blinded = drive;
  for (std::size_t i = 100; i < 200; ++i) blinded.frames[i].poles_robot.clear();
  const auto results = blinded.run(
      check, [](std::size_t i, const Pose2D& motion) { return i >= 50 ? Pose2D() : motion; });
  for (std::size_t i = 100; i < 149; ++i) {  // 5 s at 10 Hz
    EXPECT_TRUE(results[i].replaced);
    EXPECT_NEAR(results[i].motion.x, 0.7, 0.25) << i;
    EXPECT_GT(results[i].covariance(0, 0), 0.01);
  }
  for (std::size_t i = 155; i < 200; ++i) EXPECT_FALSE(results[i].replaced) << i;
}

TEST(OdometryMonitor, AnUncertainOdometryIsNotContradictedForWhatItAdmits) {
  const CheckedDrive drive(14, 140);
  OdometryMonitor check;
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    const Pose2D motion = scaled(drive.frames[i].motion, i >= 50 ? 1.2 : 1);
    // It says 1.2 m a step: 0.14 m is nothing.
    const auto result =
        check.add(0.1 * static_cast<double>(i), motion,
                  Eigen::Vector3d(1.44, 1.44, 0.01).asDiagonal(), drive.frames[i].poles_robot);
    EXPECT_FALSE(result.replaced) << i;
  }
}

// Six poles tell a motion to about 2 cm and 2 mrad. Tolerated are 0.1 m and 0.02 rad.
TEST(OdometryMonitor, SixPolesContradictWhatIsClearlyBeyondTheTolerance) {
  for (const Pose2D& slight : {Pose2D{0.08, 0, 0}, Pose2D{0, 0, 0.015}})
    EXPECT_EQ(afterTwoScans(kAllRound, slight, {}).verdict, OdometryVerdict::agrees);
  for (const Pose2D& clear : {Pose2D{0.4, 0, 0}, Pose2D{0, 0, 0.04}}) {
    const MonitoredMotion result = afterTwoScans(kAllRound, clear, {});
    EXPECT_EQ(result.verdict, OdometryVerdict::contradicted);
    EXPECT_NEAR(result.motion.x, clear.x, 1e-6);
    EXPECT_NEAR(result.motion.yaw, clear.yaw, 1e-6);
  }
}

// Both motions begin in one frame, and so does their covariance, however far the vehicle turns.
TEST(OdometryMonitor, ErrorsInATurnCountWhereTheyAre) {
  const Eigen::Matrix3d along = Eigen::Vector3d(0.09, 1e-6, 1e-8).asDiagonal();
  const Pose2D stated{1, 0, 1.5};
  EXPECT_EQ(afterTwoScans(kAllRound, {1, 0.5, 1.5}, stated, along).verdict,
            OdometryVerdict::contradicted);
  EXPECT_EQ(afterTwoScans(kAllRound, {1.5, 0, 1.5}, stated, along).verdict,
            OdometryVerdict::agrees);
}

// Nothing is known yet of how often poles are seen again, whenever the clock begins.
TEST(OdometryMonitor, TheSecondScanOfADriveContradictsNothingByPolesNotSeenAgain) {
  for (const double begin : {0.0, 1e9}) {
    OdometryMonitor check;
    MonitoredMotion result;
    for (int scan = 0; scan < 2; ++scan) {
      std::vector<PoleDetection> poles;
      for (int i = 0; i < 10; ++i) {
        const double range = scan == 0 ? 10 : 30, angle = 0.6 * i + 0.05 * i * i * (scan + 1);
        poles.push_back(tests::detectionAt(range * std::cos(angle), range * std::sin(angle), 1e-4));
      }
      result =
          check.add(begin + 0.1 * scan, {0.7, 0, 0}, 1e-6 * Eigen::Matrix3d::Identity(), poles);
    }
    EXPECT_EQ(result.verdict, OdometryVerdict::unknown) << begin;
  }
}

// 40 m ahead, a turn looks like a slide to the side: both motions fit the poles to a decimetre.
TEST(OdometryMonitor, AMotionThatFitsHardlyBetterContradictsNothing) {
  const std::vector<Eigen::Vector2d> ahead = {{38, 2}, {42, -2}, {38, -2}, {42, 2}};
  const MonitoredMotion result = afterTwoScans(ahead, {0.7, -0.76, 0.019}, {0.7, 0, 0});
  EXPECT_EQ(result.verdict, OdometryVerdict::agrees);
  EXPECT_FALSE(result.replaced);
}

TEST(OdometryMonitor, AGapEndsTheComparison) {
  const CheckedDrive drive(15, 70);
  OdometryMonitor check;
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    const double time = 0.1 * static_cast<double>(i) + (i >= 50 ? 120 : 0);
    const Pose2D motion = i == 50 ? Pose2D{90, 0, 1} : drive.frames[i].motion;
    const auto result =
        check.add(time, motion, CheckedDrive::covarianceOf(motion), drive.frames[i].poles_robot);
    EXPECT_FALSE(result.replaced) << i;
    if (i == 50) {
      EXPECT_EQ(result.verdict, OdometryVerdict::unknown);
    }
  }
}

}  // namespace
}  // namespace polemcl::test_odometry_monitor
