#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/common/Angles.h"
#include "core/common/Transform.h"
#include "mrpt/live/LiveQueue.h"
#include "support/TrialFixture.h"

namespace polemcl::test_trials {

TEST_F(FaultTrials, WindowsHoldLeadFaultAndTail) {
  const TrialDrive whole = drive();
  int longer = 0;
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    options.fault.fault = Fault::slip;
    std::mt19937_64 random(seed);
    const Trial slip = injectFault(whole, options.fault, random);
    EXPECT_EQ(slip.begin, 40u);  // 8 s of 0.2 s
    EXPECT_EQ(slip.end, 70u);
    ASSERT_EQ(slip.frames.size(), slip.truth.size());
    EXPECT_NEAR(slip.driven.back() - slip.driven[slip.end], 60, 2.5);
    const auto motion = [&](std::size_t i) { return *whole.frames[slip.origin + i].motion; };
    const auto factorOf = [&](std::size_t i) {
      return slip.frames[i].motion->mean.x / motion(i).mean.x;
    };
    const double slipping = factorOf(slip.begin);
    EXPECT_NEAR(std::abs(slipping - 1), 0.2, 1e-6);
    longer += slipping > 1;
    for (std::size_t i = 1; i < slip.frames.size(); ++i) {
      const double factor = i >= slip.begin && i < slip.end ? slipping : 1;
      EXPECT_NEAR(factorOf(i), factor, 1e-6) << i;
      EXPECT_NEAR(slip.frames[i].motion->mean.yaw, factor * motion(i).mean.yaw, 1e-12) << i;
      EXPECT_TRUE(
          slip.frames[i].motion->covariance.isApprox(factor * factor * motion(i).covariance))
          << i;
      EXPECT_NEAR(slip.frames[i].time - slip.frames[i - 1].time, 0.2, 1e-5);
      EXPECT_EQ(slip.truth[i].x, whole.truth[slip.origin + i].x);
    }
  }
  EXPECT_GT(longer, 3);  // of 19: half, by chance
  EXPECT_LT(longer, 16);
}

TEST_F(FaultTrials, EachFaultSpoilsItsOwn) {
  const Trial blind = inject(Fault::blind), stuck = inject(Fault::stuck);
  const auto faulty = [](const Trial& trial, std::size_t i) {
    return i >= trial.begin && i < trial.end;
  };
  for (std::size_t i = 1; i < blind.frames.size(); ++i)
    EXPECT_EQ(blind.frames[i].poles_robot.empty(), faulty(blind, i)) << i;
  for (std::size_t i = 1; i < stuck.frames.size(); ++i) {
    EXPECT_EQ(stuck.frames[i].motion->mean.x == 0, faulty(stuck, i)) << i;
    // It is sure of standing still.
    const double sigma = std::sqrt(stuck.frames[i].motion->covariance(0, 0));
    EXPECT_EQ(sigma <= io::motionFloorMetres * (1 + 1e-9), faulty(stuck, i)) << i << ' ' << sigma;
  }
}

TEST_F(FaultTrials, FaultsOfTheLidarSpoilTheScans) {
  const Trial moved = inject(Fault::moved), snow = inject(Fault::snow);
  const TrialDrive whole = drive();
  std::vector<Eigen::Vector2d> behind, seen;
  for (std::size_t i = 0; i < moved.frames.size(); ++i) {
    const auto& poles = moved.frames[i].poles_robot;
    const auto& right = whole.frames[moved.origin + i].poles_robot;
    ASSERT_EQ(poles.size(), right.size());
    const bool faulty = i >= moved.begin && i < moved.end;
    for (std::size_t k = 0; k < poles.size(); ++k) {
      const PoleDetection &pole = poles[k], &before = right[k];
      if (!faulty || before.x >= 0) {
        EXPECT_EQ(std::hypot(pole.x - before.x, pole.y - before.y), 0) << i;
        continue;
      }
      behind.push_back(centreOf(before));
      seen.push_back(centreOf(pole));
    }
  }
  // One rigid motion for all.
  ASSERT_GT(behind.size(), 10u);
  const Eigen::Vector2d arm = behind.back() - behind.front(), turned = seen.back() - seen.front();
  const double yaw = std::atan2(arm.x() * turned.y() - arm.y() * turned.x(), arm.dot(turned));
  const Eigen::Vector2d shift = seen.front() - rotationOf(yaw) * behind.front();
  EXPECT_GT(std::abs(yaw), 1 * degree);
  EXPECT_LT(std::abs(yaw), 5 * degree);
  EXPECT_GT(shift.norm(), 0.1);
  EXPECT_LT(shift.norm(), 0.5);
  for (std::size_t k = 0; k < seen.size(); ++k)
    EXPECT_LT((seen[k] - rotationOf(yaw) * behind[k] - shift).norm(), 1e-9) << k;
  double usual = 0;
  for (std::size_t i = 0; i < snow.frames.size(); ++i)
    usual += static_cast<double>(whole.frames[snow.origin + i].poles_robot.size());
  usual /= static_cast<double>(snow.frames.size());
  for (std::size_t i = 0; i < snow.frames.size(); ++i) {
    const bool faulty = i >= snow.begin && i < snow.end;
    const std::size_t added =
        snow.frames[i].poles_robot.size() - whole.frames[snow.origin + i].poles_robot.size();
    EXPECT_NEAR(static_cast<double>(added), faulty ? 2 * usual : 0, faulty ? 1 : 0) << i;
  }
  EXPECT_NE(snow.frames[snow.begin].poles_robot.back().x,
            snow.frames[snow.begin + 1].poles_robot.back().x);
}

TEST_F(FaultTrials, HalfOfThePolesOfTheMapAreGone) {
  const TrialDrive whole = drive();
  const auto mapped = [&](const std::vector<PoleDetection>& poles, const Pose2D& pose) {
    return static_cast<double>(std::count_if(poles.begin(), poles.end(), [&](const auto& pole) {
      const Pose2D at = compose(pose, {pole.x, pole.y, 0});
      return whole.map.poles->index().nearest(at.x, at.y, 1).has_value();
    }));
  };
  double seen = 0, left = 0;
  for (std::uint64_t seed = 1; seed < 9; ++seed) {
    const Trial gone = inject(Fault::halfGone, seed);
    for (std::size_t i = 0; i < gone.frames.size(); ++i) {
      const auto &poles = gone.frames[i].poles_robot,
                 &all = whole.frames[gone.origin + i].poles_robot;
      const double ofMap = mapped(all, gone.truth[i]), ofMapLeft = mapped(poles, gone.truth[i]);
      // Others stay.
      EXPECT_EQ(static_cast<double>(all.size()) - ofMap,
                static_cast<double>(poles.size()) - ofMapLeft);
      if (i < gone.begin || i >= gone.end) {
        EXPECT_EQ(poles.size(), all.size()) << i;
        continue;
      }
      seen += ofMap;
      left += ofMapLeft;
    }
  }
  EXPECT_NEAR(left / seen, 0.5, 0.15);
}

TEST_F(FaultTrials, AnOdometryWithAnotherClockTellsTheMotionOfAnotherTime) {
  TrialDrive steady = drive();
  for (std::size_t i = 1; i < steady.frames.size(); ++i)  // the longer, the later
    steady.frames[i].motion->mean = {0.01 * static_cast<double>(i), 0, 0};
  options.fault.fault = Fault::clock;
  int early = 0;
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    std::mt19937_64 random(seed);
    const Trial clock = injectFault(steady, options.fault, random);
    for (std::size_t i = 1; i < clock.frames.size(); ++i) {
      const double change =  // of 0.01 m a scan, in s: a scan is 0.2 s
          (clock.frames[i].motion->mean.x - steady.frames[clock.origin + i].motion->mean.x) / 0.05;
      if (i < clock.begin || i >= clock.end) {
        EXPECT_NEAR(change, 0, 1e-9) << i;
        continue;
      }
      EXPECT_GT(std::abs(change), 0.09) << i;
      EXPECT_LT(std::abs(change), 0.51) << i;
      early += i == clock.begin && change < 0;
    }
  }
  EXPECT_GT(early, 3);  // of 19: half, by chance
  EXPECT_LT(early, 16);
}

TEST_F(FaultTrials, ScansThatComeAfterNewerOnesAreLeftOutButNotTheirMotion) {
  TrialDrive steady = drive();
  for (std::size_t i = 1; i < steady.frames.size(); ++i)
    steady.frames[i].motion =
        PoseWithCovariance{{1, 0, 0}, Eigen::Vector3d(0.01, 0.02, 0).asDiagonal()};
  options.fault.fault = Fault::late;
  double faulty = 0, used = 0;
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    std::mt19937_64 random(seed);
    const Trial late = injectFault(steady, options.fault, random);
    EXPECT_EQ(late.begin, 40u);
    faulty += 30;  // 6 s of 0.2 s
    used += static_cast<double>(late.end - late.begin);
    ASSERT_EQ(late.frames.size(), late.truth.size());
    ASSERT_EQ(late.frames.size(), late.driven.size());
    const auto scanOf = [&](std::size_t i) {
      const double before = late.frames[i].time - late.frames[0].time;
      return static_cast<std::size_t>(std::lround(before / 0.2));
    };
    EXPECT_EQ(scanOf(late.end), 70u);
    for (std::size_t i = 1; i < late.frames.size(); ++i) {
      const std::size_t step = scanOf(i) - scanOf(i - 1);
      if (scanOf(i) <= 40 || scanOf(i) > 70)
        EXPECT_EQ(step, 1u) << i;
      else
        EXPECT_TRUE(step >= 1 && step <= 6) << step;  // 1 s late at most
      const PoseWithCovariance& motion = *late.frames[i].motion;
      EXPECT_NEAR(motion.mean.x, static_cast<double>(step), 1e-9);
      EXPECT_NEAR(motion.covariance(0, 0), 0.01 * static_cast<double>(step), 1e-9);
      EXPECT_NEAR(motion.covariance(1, 1), 0.02 * static_cast<double>(step), 1e-9);
      const std::size_t at = late.origin + scanOf(i);
      EXPECT_EQ(late.truth[i].x, steady.truth[at].x);
      EXPECT_EQ(late.driven[i], steady.driven[at] - steady.driven[late.origin]);
      EXPECT_EQ(late.frames[i].poles_robot.size(), steady.frames[at].poles_robot.size());
    }
  }
  EXPECT_NEAR(used / faulty, 0.59, 0.08);  // of delays that are uniform
}

/// Each scan is taken as soon as it is there, if at all; the odometry of its time is there.
TEST(UsedScans, AreThoseOfALiveDrive) {
  const auto fromQueue = [](const std::vector<double>& arrivals) {
    LiveQueue queue;
    RawlogEntry entry;
    const auto odometry = mrpt::obs::CObservationOdometry::Create();
    odometry->timestamp = mrpt::Clock::fromDouble(3);
    queue.push(odometry);
    queue.next(entry);
    std::vector<std::size_t> inOrder(arrivals.size()), taken;
    std::iota(inOrder.begin(), inOrder.end(), 0);
    std::stable_sort(inOrder.begin(), inOrder.end(),
                     [&](std::size_t a, std::size_t b) { return arrivals[a] < arrivals[b]; });
    for (const std::size_t i : inOrder) {
      const auto scan = CObservationPoles::Create();
      scan->timestamp = mrpt::Clock::fromDouble(0.1 * static_cast<double>(i));
      const std::size_t dropped = queue.dropped();
      queue.push(scan);
      if (queue.dropped() > dropped) continue;
      queue.next(entry);
      taken.push_back(i);
    }
    return taken;
  };
  std::mt19937_64 random(4);
  for (int drive = 0; drive < 20; ++drive) {
    std::vector<double> arrivals;
    for (int i = 0; i < 25; ++i) arrivals.push_back(0.1 * i + uniform(random, 0, 1));
    arrivals[5] = arrivals[6];  // at once, in their order
    EXPECT_EQ(usedScans(arrivals), fromQueue(arrivals));
  }
  EXPECT_EQ(usedScans({1, 3, 2, 4}), (std::vector<std::size_t>{0, 2, 3}));
  EXPECT_TRUE(usedScans({}).empty());
}

TEST_F(FaultTrials, AKidnappingJumpsAsFarAsToldAndTimeGoesOn) {
  for (std::uint64_t seed = 1; seed < 8; ++seed) {
    const Trial jump = inject(Fault::kidnap, seed);
    const double distance = errorOf(jump.truth[jump.begin], jump.truth[jump.begin - 1]).metres;
    EXPECT_GT(distance, 18);
    EXPECT_LT(distance, 202);
    EXPECT_NEAR(jump.jump, distance, 2);
    for (std::size_t i = 1; i < jump.frames.size(); ++i)
      EXPECT_NEAR(jump.frames[i].time - jump.frames[i - 1].time, 0.2, 1e-5);
    EXPECT_LT(std::abs(jump.frames[jump.begin].motion->mean.x), 2);  // nothing of the jump
    EXPECT_EQ(jump.driven[jump.begin], jump.driven[jump.begin - 1]);
  }
}

TEST_F(FaultTrials, TheOdometryJumpsAndMayComeBack) {
  const TrialDrive whole = drive();
  int back = 0;
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    const Trial jump = inject(Fault::jump, seed);
    back += jump.end == jump.begin + 2;
    for (std::size_t i = 1; i < jump.frames.size(); ++i) {
      const Pose2D &seen = jump.frames[i].motion->mean,
                   &right = whole.frames[jump.origin + i].motion->mean;
      const bool faulty = i >= jump.begin && i < jump.end;
      EXPECT_NEAR(std::hypot(seen.x - right.x, seen.y - right.y), faulty ? jump.jump : 0, 1e-9);
      EXPECT_EQ(seen.yaw, right.yaw);
    }
    EXPECT_GE(jump.jump, 0.5);
    EXPECT_LE(jump.jump, 3);
  }
  EXPECT_GT(back, 3);  // of 19: half, by chance
  EXPECT_LT(back, 16);
}

}  // namespace polemcl::test_trials
