#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/slam/PoleMotions.h"
#include "support/PoleCity.h"
#include "support/Refusal.h"
#include "support/StraightDrive.h"

namespace polemcl::test_pole_motions {
namespace {
using tests::Frame;
using tests::PoleCity;

/// A drive of 80 m at 10 Hz, a scan each metre unless said, with the odometry of the city's drives.
class PoleMotionsTest : public testing::Test {
 protected:
  PoleMotionsTest() { drive(1); }
  void drive(double step) {
    scans.clear();
    truth.clear();
    tests::CityOptions options;
    options.seed = 1201;
    const PoleCity city(options);
    sim::Random random(5);
    const std::vector<Frame> frames = tests::drive(
        city.surroundings(), tests::resample(city.randomWay(random, 80), step), {}, random);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      PoleScan scan;
      scan.time = 0.1 * static_cast<double>(i);
      scan.poles_robot = frames[i].poles_robot;
      if (i > 0) scan.motion = PoseWithCovariance{frames[i].motion, covariance()};
      scans.push_back(scan);
      truth.push_back(frames[i].truth);
    }
  }
  /// The covariance that the odometry states: 2 cm and 0.1 degree.
  static Eigen::Matrix3d covariance() { return Eigen::Vector3d(4e-4, 4e-4, 3e-6).asDiagonal(); }
  void forgetMotions(std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) scans[i].motion.reset();
  }
  void blind(std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) scans[i].poles_robot.clear();
  }
  /// Greatest error of a motion that is within its covariance by five sigmas, m.
  double worst(std::size_t begin, std::size_t end) const {
    double most = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Pose2D off = relative(relative(truth[i - 1], truth[i]), scans[i].motion->mean);
      EXPECT_LT(std::hypot(off.x, off.y), 5 * std::sqrt(scans[i].motion->covariance(0, 0))) << i;
      EXPECT_LT(std::abs(off.yaw), 5 * std::sqrt(scans[i].motion->covariance(2, 2))) << i;
      most = std::max(most, std::hypot(off.x, off.y));
    }
    return most;
  }
  /// Error of all these motions together, m.
  double errorOfWay(std::size_t begin, std::size_t end) const {
    Pose2D way;
    for (std::size_t i = begin; i < end; ++i) way = compose(way, scans[i].motion->mean);
    const Pose2D right = relative(truth[begin - 1], truth[end - 1]);
    return std::hypot(way.x - right.x, way.y - right.y);
  }
  std::vector<PoleScan> scans;
  std::vector<Pose2D> truth;
};

TEST_F(PoleMotionsTest, AllMotionsByThePoles) {
  forgetMotions(1, scans.size());
  const FilledMotions filled = fillMotions(scans);
  EXPECT_TRUE(filled.all);
  EXPECT_LE(filled.coasted, 3u);  // the first metres tell no speed
  EXPECT_LT(worst(1, scans.size()), 0.25);
}

TEST_F(PoleMotionsTest, OnlyTheGapsAreFilled) {
  const std::vector<PoleScan> before = scans;
  forgetMotions(30, 50);
  const FilledMotions filled = fillMotions(scans);
  EXPECT_FALSE(filled.all);
  EXPECT_EQ(filled.byPoles + filled.coasted, 20u);
  EXPECT_LT(worst(30, 50), 0.25);
  for (std::size_t i = 1; i < scans.size(); ++i)
    EXPECT_TRUE((i >= 30 && i < 50) || scans[i].motion->mean.x == before[i].motion->mean.x);
}

/// The motion goes on for a while, with a covariance that says so.
TEST_F(PoleMotionsTest, CoastsOverAFewBlindScans) {
  forgetMotions(1, scans.size());
  blind(40, 45);
  const FilledMotions filled = fillMotions(scans);
  EXPECT_GE(filled.coasted, 5u);  // the first one after them has poles in common with scan 39
  EXPECT_LE(filled.coasted, 8u);
  worst(1, scans.size());
  EXPECT_GT(scans[42].motion->covariance(0, 0), scans[30].motion->covariance(0, 0));
}

/// Each gap may be as long; the odometry between them knows the way.
TEST_F(PoleMotionsTest, CoastsOverSeveralGapsOfTheOdometry) {
  for (const std::size_t begin : {20, 50}) {
    forgetMotions(begin, begin + 15);
    blind(begin, begin + 15);
  }
  EXPECT_EQ(fillMotions(scans).coasted, 30u);
}

TEST_F(PoleMotionsTest, GuessesNoPathWithoutOdometry) {
  forgetMotions(1, scans.size());
  for (const std::size_t begin : {20, 40, 60}) blind(begin, begin + 15);
  EXPECT_REFUSED(fillMotions(scans), "without odometry, the poles do not tell ",
                 " motions, the first before ", "its path would be a guess");
}

/// A wheel slips, an encoder starts anew, a turn is told twice: the poles tell the way there.
TEST_F(PoleMotionsTest, TheyTellWhereTheOdometryIsWrong) {
  scans.erase(scans.begin(), scans.begin() + 20);  // few poles stand there
  truth.erase(truth.begin(), truth.begin() + 20);
  const std::vector<PoleScan> right = scans;
  for (const Pose2D& wrong : {Pose2D{1.6, 0, 0}, Pose2D{-1.5, 0, 0}, Pose2D{-40, 12, 1},
                              Pose2D{0, 0, 0.3}, Pose2D{0.6, 0, 0}})
    for (const std::size_t at : {1, 2, 20}) {
      SCOPED_TRACE(testing::Message() << wrong.x << ' ' << wrong.yaw << " at " << at);
      scans = right;
      scans[at].motion->mean = compose(scans[at].motion->mean, wrong);
      const FilledMotions filled = fillMotions(scans);
      EXPECT_EQ(filled.contradicted, 1u);
      EXPECT_DOUBLE_EQ(filled.firstContradicted, scans[at].time);
      EXPECT_EQ(filled.byPoles + filled.coasted, 0u);
      EXPECT_FALSE(filled.all);
      EXPECT_LT(worst(at, at + 1), 0.25);
      for (std::size_t i = 1; i < scans.size(); ++i)
        EXPECT_TRUE(i == at || scans[i].motion->mean.x == right[i].motion->mean.x) << i;
    }
}

/// Wheels that stand still on ice: each motion is wrong.
TEST_F(PoleMotionsTest, TheyTellTheWayOfASlide) {
  for (std::size_t i = 30; i < 50; ++i) scans[i].motion->mean = {};
  EXPECT_GE(fillMotions(scans).contradicted, 19u) << "one scan has few poles in common";
  EXPECT_LT(errorOfWay(30, 50), 1.5) << "of 20 m";
}

/// In slow drives each motion is off by little: it shows over a second.
TEST_F(PoleMotionsTest, TheyTellTheWayOfASlowSlide) {
  for (const double share : {0.0, 0.5}) {
    drive(0.3);
    for (std::size_t i = 100; i < 140; ++i) {
      scans[i].motion->mean.x *= share;
      scans[i].motion->mean.y *= share;
    }
    EXPECT_GE(fillMotions(scans).contradicted, 30u);
    EXPECT_LT(errorOfWay(100, 140), 1.5) << "of 12 m";
  }
}

/// Scans 2 m and 0.3 s apart. Where few poles are seen for longer than scans are compared, the
/// motion goes on, not the slip.
TEST_F(PoleMotionsTest, ASlipIsNotBelievedWhereThePolesSayNothing) {
  drive(2);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scans[i].time = 0.3 * static_cast<double>(i);
    if (i >= 12 && i < 30) scans[i].motion->mean.x *= 1.6;
    if (i >= 18 && i < 23) scans[i].poles_robot.clear();
  }
  EXPECT_GE(fillMotions(scans).contradicted, 16u);
  EXPECT_LT(errorOfWay(18, 23), 1.5) << "of 10 m";
  EXPECT_GT(scans[21].motion->covariance(0, 0), scans[18].motion->covariance(0, 0));
}

/// An odometry turned by 90 degrees, one that goes backwards, one that always turns, and one that
/// is too long.
TEST_F(PoleMotionsTest, AnOdometryThatIsMostlyWrongIsNotUsed) {
  const std::vector<PoleScan> right = scans;
  const auto spoil = [](Pose2D& motion, int how) {
    if (how == 0) motion = {-motion.y, motion.x, motion.yaw};
    if (how == 1) motion = relative(motion, Pose2D());
    if (how == 2) motion.yaw += 0.2;
    if (how == 3) motion.x *= 1.5;
  };
  for (int how = 0; how < 4; ++how) {
    SCOPED_TRACE(how);
    scans = right;
    for (std::size_t i = 1; i < scans.size(); ++i) spoil(scans[i].motion->mean, how);
    const FilledMotions filled = fillMotions(scans);
    EXPECT_TRUE(filled.refuted);
    EXPECT_TRUE(filled.all);
    EXPECT_EQ(filled.motions, scans.size() - 1);
    EXPECT_GT(3 * filled.contradicted, filled.motions);
    EXPECT_LT(worst(1, scans.size()), 0.25);
  }
}

/// The poles cannot tell the whole way: what is told of it stays.
TEST_F(PoleMotionsTest, AnOdometryThatNothingReplacesStays) {
  for (std::size_t i = 1; i < scans.size(); ++i) scans[i].motion->mean.x *= 1.5;
  blind(40, 65);
  const FilledMotions filled = fillMotions(scans);
  EXPECT_FALSE(filled.refuted);
  EXPECT_FALSE(filled.all);
  EXPECT_NE(scans[62].motion->mean.x, 0);
}

/// Errors that an odometry has, and what few poles contradict, are not theirs to judge.
TEST_F(PoleMotionsTest, APoorOdometryStays) {
  const std::vector<PoleScan> right = scans;
  const auto expectKept = [&] {
    const std::vector<PoleScan> told = scans;
    EXPECT_EQ(fillMotions(scans).contradicted, 0u);
    for (std::size_t i = 1; i < scans.size(); ++i)
      EXPECT_EQ(scans[i].motion->mean.x, told[i].motion->mean.x) << i;
  };
  expectKept();
  for (PoleScan& scan : scans)
    if (scan.motion) {
      scan.motion->mean.x *= 1.08;
      scan.motion->mean.yaw += 0.004;
    }
  expectKept();
  scans = right;
  scans[40].motion->mean.x += 1.5;
  for (std::size_t i = 29; i < 51; ++i)
    scans[i].poles_robot.resize(std::min<std::size_t>(3, scans[i].poles_robot.size()));
  expectKept();
}

/// Posts at an even distance fit a shifted motion, those on a lorry a vehicle that stands.
TEST(PoleMotions, MisleadingPolesSayNothing) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    auto lorry = tests::straightDrive(tests::streetPoles(), 1, tests::kLorry, seed);
    EXPECT_EQ(fillMotions(lorry).contradicted, 0u) << seed;
    for (const double distance : {2.0, 4.0, 5.0}) {
      auto row = tests::straightDrive(tests::evenRow(distance), 2, {}, seed);
      EXPECT_EQ(fillMotions(row).contradicted, 0u) << distance << ' ' << seed;
    }
  }
}

/// Scans at these places along x: five poles stay in view, eight others are seen before and eight
/// more behind 9 m.
std::vector<PoleScan> withGap(const std::vector<std::pair<double, double>>& timesAndPlaces) {
  const std::vector<Eigen::Vector2d> common{{12, 5}, {19, -7}, {23, 9}, {31, 4}, {34, -11}},
      before{{-20, 6}, {-14, -9}, {-9, 12}, {-3, -5}, {2, 8}, {5, -13}, {9, 15}, {11, -4}},
      behind{{48, -6}, {51, 10}, {55, -14}, {57, 3}, {61, 8}, {66, -9}, {70, 13}, {40, 6}};
  std::vector<PoleScan> scans;
  for (const auto& [time, place] : timesAndPlaces) {
    PoleScan scan;
    scan.time = time;
    for (const auto* poles : {&common, place < 9 ? &before : &behind})
      for (const Eigen::Vector2d& pole : *poles) {
        PoleDetection seen;
        seen.x = pole.x() - place;
        seen.y = pole.y();
        seen.covariance = 4e-4 * Eigen::Matrix2d::Identity();
        scan.poles_robot.push_back(seen);
      }
    scans.push_back(scan);
  }
  return scans;
}

TEST(PoleMotions, AChangeOfSpeedInAGapIsToldByThePolesInCommon) {
  std::vector<std::pair<double, double>> drive;
  for (int i = 0; i < 6; ++i) drive.emplace_back(0.1 * i, 0.75 * i);
  drive.emplace_back(1.6, 0.75 * 5 + 9.3);  // after 1.1 s, 8.3 m at the speed before
  std::vector<PoleScan> scans = withGap(drive);
  const FilledMotions filled = fillMotions(scans);
  EXPECT_EQ(filled.coasted, 0u);
  EXPECT_NEAR(scans.back().motion->mean.x, 9.3, 0.1);

  drive.back().second += 6;  // no vehicle
  std::vector<PoleScan> jumped = withGap(drive);
  const FilledMotions guessed = fillMotions(jumped);
  EXPECT_EQ(guessed.coasted, 1u);
  EXPECT_NEAR(guessed.longestCoast, 1.1, 1e-9);
}

TEST_F(PoleMotionsTest, RefusesWhereNothingTellsTheWay) {
  forgetMotions(1, scans.size());
  blind(40, 65);
  EXPECT_REFUSED(fillMotions(scans), "no odometry leads to scan 60 at 6.0", "poles");
  blind(0, 25);
  forgetMotions(1, scans.size());
  EXPECT_REFUSED(fillMotions(scans), "no odometry leads to scan 21 at 2.1");
}

}  // namespace
}  // namespace polemcl::test_pole_motions
