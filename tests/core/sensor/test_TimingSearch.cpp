#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/common/Deskew.h"
#include "core/sensor/TimingSearch.h"

namespace polemcl::test_timing_search {

namespace {

/// A drive of 300 m with bends and changing speed, poles on both sides, 2 cm of noise, a scan each
/// 0.1 s; each pole is measured at the moment that `timing` says.
std::vector<TimedScan> drive(const ScanTiming& timing) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0, 0.02);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Velocity> speeds;
  std::vector<Pose2D> poses{{0, 0, 0}};
  constexpr int fine = 200;  // steps a second
  for (int k = 0; k < 60 * fine; ++k) {
    const double t = static_cast<double>(k) / fine;
    speeds.push_back({6 + 4 * std::sin(t), 0, 0.4 * std::sin(0.7 * t)});
    poses.push_back(compose(poses.back(), motionAfter(speeds.back(), 1.0 / fine)));
  }
  std::vector<Eigen::Vector2d> poles;
  for (std::size_t k = 0; k < poses.size(); k += 2 * fine) {
    const Pose2D at = compose(poses[k], {0, (k / fine) % 4 ? 7.0 : -6.0, 0});
    poles.emplace_back(at.x + uniform(random), at.y + uniform(random));
  }
  const auto poseAt = [&](double time) {
    const auto k = static_cast<std::size_t>(time * fine);
    return compose(poses[k], motionAfter(speeds[k], time - static_cast<double>(k) / fine));
  };
  std::vector<TimedScan> scans;
  for (double time = 1; time < 55; time += 0.1) {
    TimedScan scan{time, poseAt(time), {}};
    for (const Eigen::Vector2d& pole : poles) {
      Pose2D seen = relative(scan.pose_map_robot, {pole.x(), pole.y(), 0});
      for (int round = 0; round < 3; ++round)  // until azimuth and moment agree
        seen = relative(poseAt(time + timing.offset(std::atan2(seen.y, seen.x))),
                        {pole.x(), pole.y(), 0});
      if (std::hypot(seen.x, seen.y) > 30) continue;
      const double azimuth = std::atan2(seen.y, seen.x);
      scan.poles_robot.push_back({seen.x + noise(random), seen.y + noise(random), azimuth});
    }
    scans.push_back(scan);
  }
  return scans;
}

double turned(double a, double b) {
  return std::abs(std::remainder(a - b, 2 * M_PI));
}

}  // namespace

TEST(TimingSearch, FindsDirectionAndCut) {
  for (const ScanTiming& truth : {ScanTiming{Turn::clockwise, 0.1, M_PI, 0.5},
                                  ScanTiming{Turn::counterclockwise, 0.1, M_PI / 2, 0.5}}) {
    const TimingEstimate found = searchTiming(drive(truth), 0.1);
    EXPECT_EQ(found.timing.turn, truth.turn);
    EXPECT_LE(turned(found.timing.cut, truth.cut), 16 * M_PI / 180);
    EXPECT_EQ(found.timing.clock, 0);
    EXPECT_GT(found.turnSignificance, 10);
    EXPECT_LT(found.after, found.before);
    EXPECT_GT(found.pairs, 1000u);
  }
}

TEST(TimingSearch, LeavesCompensatedScansAlone) {
  const TimingEstimate found = searchTiming(drive({Turn::compensated}), 0.1);
  EXPECT_EQ(found.timing.turn, Turn::compensated);
  EXPECT_EQ(found.timing.clock, 0);
  EXPECT_EQ(found.before, found.after);
}

TEST(TimingSearch, FindsTheOffsetOfTheClocks) {
  ScanTiming late{Turn::compensated};
  late.clock = 0.08;
  const TimingEstimate alone = searchTiming(drive(late), 0.1);
  EXPECT_EQ(alone.timing.turn, Turn::compensated);
  EXPECT_NEAR(alone.timing.clock, 0.08, 0.011);
  const TimingEstimate both = searchTiming(drive({Turn::clockwise, 0.1, M_PI, 0.5, -0.05}), 0.1);
  EXPECT_EQ(both.timing.turn, Turn::clockwise);
  EXPECT_NEAR(both.timing.clock, -0.05, 0.016);
}

TEST(TimingSearch, FindsRangesThatAreOff) {
  const ScanTiming timing{Turn::clockwise, 0.1, M_PI, 0.5};
  const Eigen::Vector2d lidar(1.5, 0.3);
  std::vector<TimedScan> scans = drive(timing);
  const RangeCorrection none = searchRangeCorrection(scans, timing, lidar).value();
  EXPECT_NEAR(none.offset, 0, 0.004);
  EXPECT_NEAR(none.scale, 1, 0.0003);
  EXPECT_LT(none.significance, 4);
  EXPECT_FALSE(none.isClear());
  for (TimedScan& scan : scans) {
    for (TimedPole& pole : scan.poles_robot) {
      const Eigen::Vector2d ray = Eigen::Vector2d(pole.x, pole.y) - lidar;
      const Eigen::Vector2d measured =
          lidar + ray.normalized() * (ray.norm() - 0.06) / 0.998;  // scale * measured + offset
      pole.x = measured.x();
      pole.y = measured.y();
    }
  }
  const RangeCorrection found = searchRangeCorrection(scans, timing, lidar).value();
  EXPECT_NEAR(found.offset, 0.06, 0.005);
  EXPECT_NEAR(found.scale, 0.998, 0.0004);
  EXPECT_GT(found.significance, 10);
  EXPECT_TRUE(found.isClear());
  EXPECT_FALSE((RangeCorrection{0.6, 1, 0.1, 0.05, 20}.isClear()));  // [sensor] would refuse them
  EXPECT_FALSE((RangeCorrection{0, 1.2, 0.1, 0.05, 20}.isClear()));
  EXPECT_NEAR(found.after, none.before, 0.002);
  EXPECT_GT(found.before, found.after + 0.002);
}

TEST(TimingSearch, SaysNothingWithoutPairs) {
  const TimingEstimate none = searchTiming({}, 0.1);
  EXPECT_EQ(none.pairs, 0u);
  EXPECT_EQ(none.timing.turn, Turn::compensated);
  EXPECT_EQ(searchTiming({{0, {}, {{5, 5, 0}}}}, 0.1).pairs, 0u);
  EXPECT_FALSE(searchRangeCorrection({}, {}, {0, 0}));
}

}  // namespace polemcl::test_timing_search
