// Order, odometry and overload of scans from sensors; times are numbers here.

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <thread>

#include "mrpt/live/LiveQueue.h"
#include "mrpt/rawlog/PoleSequence.h"
#include "support/Refusal.h"
#include "support/SequenceFiles.h"

namespace polemcl::test_live_queue {
namespace {

using namespace tests::sequence;

CObservation::Ptr scan(double time, const std::string& label = "lidar") {
  auto observation = std::make_shared<CObservationPoles>(poles(time));
  observation->sensorLabel = label;
  return observation;
}

CObservation::Ptr odometry(double time, double x) {
  auto observation = CObservationOdometry::Create();
  observation->timestamp = mrpt::Clock::fromDouble(time);
  observation->odometry = {x, 0, 0};
  return observation;
}

/// Takes everything from a queue that has ended: `s1.5 o2 ...`.
std::string content(LiveQueue& queue) {
  std::ostringstream all;
  for (RawlogEntry entry; queue.next(entry);) {
    const bool isScan = entry.arrival.has_value();
    all << (isScan ? 's' : 'o') << mrpt::Clock::toDouble(entry.observation->timestamp) << ' ';
  }
  return all.str();
}

/// Never lets a scan wait for its odometry in vain.
LiveQueueOptions patient() {
  LiveQueueOptions options;
  options.odometryWait = 1e6;
  return options;
}

TEST(LiveQueue, GivesScansInTheOrderOfTheirTimesAfterTheOdometry) {
  LiveQueue queue;
  for (const double time : {3.0, 1.0, 2.0}) queue.push(scan(time));
  for (const double time : {1.5, 3.5, 2.5}) queue.push(odometry(time, 0));
  queue.end();
  EXPECT_EQ(content(queue), "o1.5 o3.5 o2.5 s1 s2 s3 ");
  EXPECT_EQ(queue.dropped(), 0u);
}

TEST(LiveQueue, DropsTheOldestScanThatWaitsAndNoOdometry) {
  LiveQueue queue;
  for (int i = 1; i <= 8; ++i) {
    queue.push(odometry(i, i));
    queue.push(scan(i));
  }
  queue.end();
  EXPECT_EQ(content(queue), "o1 o2 o3 o4 o5 o6 o7 o8 s4 s5 s6 s7 s8 ");
  EXPECT_EQ(queue.dropped(), 3u);
}

TEST(LiveQueue, DropsAScanOlderThanTheLastOneTaken) {
  LiveQueue queue(patient());
  queue.push(scan(2));
  queue.push(odometry(9, 0));
  RawlogEntry entry;
  ASSERT_TRUE(queue.next(entry) && queue.next(entry));
  queue.push(scan(1.5));
  queue.push(scan(2));
  queue.push(scan(3));
  queue.end();
  EXPECT_EQ(content(queue), "s3 ");
  EXPECT_EQ(queue.dropped(), 2u);
}

TEST(SteadyTimes, ClocksThatAreSetBackByDifferentTimesGoOnAlike) {
  SteadyTimes times;
  const SteadyTimes::Clock::time_point begin;
  const auto later = begin + std::chrono::seconds(1);
  for (const std::string sensor : {"front", "rear"})
    EXPECT_DOUBLE_EQ(times.of(sensor, 100, begin), 100);
  EXPECT_DOUBLE_EQ(times.of("front", 40, later), 101);
  EXPECT_DOUBLE_EQ(times.of("rear", 36.5, later), 101) << "3.5 s more";
  EXPECT_DOUBLE_EQ(times.offset("front"), 61);
  EXPECT_DOUBLE_EQ(times.offset("rear"), 64.5);
}

/// The computer's clock is right throughout, at 1000 s and ten times a second later.
TEST(SteadyTimes, AStrayTimeDoesNotLast) {
  const SteadyTimes::Clock::time_point begin;
  const auto timesOf = [&](const std::vector<double>& off) {
    SteadyTimes times(1000, begin);
    std::vector<double> all;
    for (std::size_t i = 0; i < off.size(); ++i) {
      const double now = 1000 + 0.1 * static_cast<double>(i);
      const auto arrival = begin + std::chrono::milliseconds(100 * i);
      all.push_back(times.of("sensor", now + off[i], arrival) - now);
    }
    return all;
  };
  const std::vector<double> late = timesOf({0, 0, -4.5, 0, 0}), ahead = timesOf({0, 5, 5, 5, 0, 0});
  EXPECT_NEAR(late[2], 0, 1e-9) << "it counts for the time of its arrival";
  EXPECT_NEAR(late[4], 0, 1e-9);
  EXPECT_NEAR(ahead[3], 5, 1e-9);
  EXPECT_NEAR(ahead[5], 0, 1e-9);
  EXPECT_NEAR(timesOf({4, 4, 0, 0})[3], 0, 1e-9) << "a sender's clock that is set right";
}

/// The computer's clock is set back by 60 s while odometry of before is still on its way.
TEST(LiveQueue, AClockThatIsSetBackDoesNotSilenceTheSensors) {
  LiveQueueOptions options = patient();
  std::vector<std::string> warnings;
  options.warn = [&](const std::string& text) { warnings.push_back(text); };
  LiveQueue queue(options);
  const auto odometer = [](double time) {
    const auto observation = odometry(time, 0);
    observation->sensorLabel = "wheels";
    return observation;
  };
  queue.push(odometer(100));
  queue.push(scan(100));
  queue.push(scan(40.5));
  queue.push(odometer(100.25));
  queue.push(odometer(40.5));
  queue.push(odometer(41));
  queue.push(scan(41));
  queue.end();
  std::vector<double> scans, odometries;
  for (RawlogEntry entry; queue.next(entry);)
    (entry.arrival ? scans : odometries)
        .push_back(mrpt::Clock::toDouble(entry.observation->timestamp));
  // The first scan after the step counts for the time of its arrival, here at once.
  ASSERT_EQ(scans.size(), 3u);
  ASSERT_EQ(odometries.size(), 4u);
  EXPECT_NEAR(scans[1], 100, 0.5);
  EXPECT_NEAR(scans[2] - scans[1], 0.5, 1e-6);
  EXPECT_NEAR(odometries[1], 100.25, 1e-6);
  EXPECT_NEAR(odometries[2], scans[1], 1e-6) << "the same moment of the same clock";
  EXPECT_NEAR(odometries[3], scans[2], 1e-6);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_HAS(warnings[0], "the clock of lidar was set back by 59.5 s");
  EXPECT_HAS(warnings[1], "the clock of wheels was set back by 59.5 s");
}

/// The clock of a sensor is 5 s ahead for a while; that of the computer is right throughout.
TEST(LiveQueue, ScansAndOdometryComeAgainAfterAClockThatWasAhead) {
  LiveQueueOptions options = patient();
  std::vector<std::string> warnings;
  options.warn = [&](const std::string& text) { warnings.push_back(text); };
  LiveQueue queue(options);
  const double now = mrpt::Clock::nowDouble();
  RawlogEntry entry;
  for (const double off : {5.0, 0.0}) {
    queue.push(odometry(now + off, 0));
    queue.push(scan(now + off));
    ASSERT_TRUE(queue.next(entry));
    EXPECT_FALSE(entry.arrival);
    ASSERT_TRUE(queue.next(entry));
    EXPECT_NEAR(mrpt::Clock::toDouble(entry.observation->timestamp), now + off, 1e-6);
  }
  EXPECT_EQ(queue.dropped(), 0u);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_HAS(warnings[1], "the times of lidar are those of this computer again");
}

/// A reading of 5 s ahead must not be a neighbour of those that come then.
TEST(LiveQueue, OdometryOfAClockThatWasAheadIsForgotten) {
  const auto queue = std::make_shared<LiveQueue>(patient());
  const double now = mrpt::Clock::nowDouble();
  for (const auto& [after, x] : {std::pair(0.0, 0.0), {5.0, 0.05}, {0.1, 0.1}, {4.9, 4.9}})
    queue->push(odometry(now + after, x));
  for (const double after : {0.0, 0.1, 4.95}) queue->push(scan(now + after));
  queue->end();
  double way = 0;
  const auto counts = streamPoles(queue, "sensors.ini", options(),
                                  [&](const ReadScan& taken) { way += taken.motion->mean.x; });
  EXPECT_EQ(counts.scans, 3u);
  EXPECT_NEAR(way, 4.95, 1e-3);
}

/// Another thread asks; the scan must not come before the odometry of its time.
TEST(LiveQueue, AScanWaitsForTheOdometryOfItsTime) {
  LiveQueue queue(patient());
  queue.push(odometry(0.9, 0));
  queue.push(scan(1));
  auto taken = std::async(std::launch::async, [&] {
    std::string order;
    for (RawlogEntry entry; order.size() < 3 && queue.next(entry);)
      order += entry.arrival ? 's' : 'o';
    return order;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(30));  // a wrong queue gives it meanwhile
  queue.push(odometry(1, 0));
  EXPECT_EQ(taken.get(), "oos");
}

TEST(LiveQueue, AScanDoesNotWaitForOdometryForever) {
  LiveQueueOptions options;
  options.odometryWait = 0.05;
  LiveQueue queue(options);
  const auto begin = std::chrono::steady_clock::now();
  queue.push(scan(1));
  RawlogEntry entry;
  ASSERT_TRUE(queue.next(entry));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(50));
  EXPECT_GE(*entry.arrival, begin);
}

TEST(LiveQueue, EndsAtOnceWhenTheDriveDoes) {
  bool goesOn = true;
  LiveQueueOptions options = patient();
  options.goesOn = [&] { return goesOn; };
  LiveQueue queue(options);
  queue.push(odometry(1, 0));
  queue.push(scan(1));
  RawlogEntry entry;
  EXPECT_TRUE(queue.next(entry));
  goesOn = false;
  EXPECT_FALSE(queue.next(entry));
}

TEST(LiveQueue, RefusesScansOfASecondSensor) {
  LiveQueue queue;
  queue.push(scan(1, "front"));
  queue.push(scan(2, "rear"));
  queue.push(scan(3, "front"));
  EXPECT_EQ(content(queue), "s1 ");
  EXPECT_HAS(queue.failure(), "two sensors, front and rear");
  EXPECT_HAS(queue.failure(), "lidars = front rear in [vehicle]");
  EXPECT_HAS(queue.failure(), "rawlog-grabber-ignore");
  queue.end("another");
  EXPECT_HAS(queue.failure(), "front and rear") << "the first reason counts";
}

TEST(LiveQueue, TakesTheScansOfAllListedLidars) {
  LiveQueueOptions options = patient();
  options.lidars = {"front", "rear"};
  LiveQueue queue(options);
  queue.push(odometry(9, 0));
  queue.push(scan(1, "front"));
  RawlogEntry entry;
  ASSERT_TRUE(queue.next(entry) && queue.next(entry));
  queue.push(scan(0.97, "rear"));  // older than the last one taken, but of another LiDAR
  queue.push(scan(1, "front"));    // this one is not newer
  for (int i = 0; i < 10; ++i) queue.push(scan(2 + i, i % 2 ? "front" : "rear"));
  queue.push(scan(20, "roof"));
  EXPECT_EQ(content(queue), "s2 s3 s4 s5 s6 s7 s8 s9 s10 s11 ") << "five of each may wait";
  EXPECT_EQ(queue.dropped(), 2u);
  EXPECT_HAS(queue.failure(), "scans of the sensor roof, which [vehicle] lidars does not list");
}

/// The rear LiDAR fails after its first scan: scans of the front one come without it.
TEST(LiveQueue, ALidarThatFailsDoesNotHoldUpTheOther) {
  const auto queue = std::make_shared<LiveQueue>([] {
    LiveQueueOptions two = patient();
    two.lidars = {"front", "rear"};
    two.longest = 100;
    return two;
  }());
  SequenceOptions two = options();
  for (const char* label : {"front", "rear"})
    two.vehicle.lidars.push_back({label, two.extraction.sensor, two.extraction.extraction});
  for (int i = 0; i < 20; ++i) {
    queue->push(odometry(0.1 * i, i));
    queue->push(scan(0.1 * i, "front"));
    if (i == 0) queue->push(scan(0.01, "rear"));
  }
  queue->push(odometry(2, 20));
  queue->end();
  std::vector<double> ways;
  const auto counts = streamPoles(queue, "sensors.ini", two, [&](const ReadScan& taken) {
    ways.push_back(taken.motion->mean.x);
  });
  EXPECT_EQ(ways.size(), 20u);
  EXPECT_EQ(counts.lidars[1].scans, 1u);
  EXPECT_EQ(counts.lidars[1].missing, 19u);
}

/// One scan is worked on while 20 come: 5 are left. Their motions add up to the whole way.
TEST(LiveQueue, UnderOverloadTheMotionOfDroppedScansIsKept) {
  const auto queue = std::make_shared<LiveQueue>(patient());
  SequenceOptions one = options();
  one.threads = 1;
  one.motion.covarianceFactor = 1;
  queue->push(odometry(0, 0));
  queue->push(scan(0));
  double way = 0;
  std::vector<double> times;
  std::vector<std::size_t> dropped;
  const auto counts = streamPoles(queue, "sensors.ini", one, [&](const ReadScan& taken) {
    if (times.empty()) {
      for (int i = 1; i <= 20; ++i) {
        queue->push(odometry(i, 0.5 * i));
        queue->push(scan(i));
      }
      queue->end();
    }
    EXPECT_EQ(taken.index, times.size());
    times.push_back(taken.time);
    dropped.push_back(taken.dropped);
    way += taken.motion->mean.x;
  });
  EXPECT_EQ(times.size() + counts.dropped, 21u);
  EXPECT_EQ(times, (std::vector<double>{0, 16, 17, 18, 19, 20}));
  EXPECT_EQ(dropped, (std::vector<std::size_t>{0, 15, 15, 15, 15, 15}));
  EXPECT_EQ(counts.dropped, 15u);
  EXPECT_NEAR(way, 10, 1e-9);
}

TEST(LiveQueue, ScansWithoutOdometryAreLeftOutAndTheMotionGoesOn) {
  const auto queue = std::make_shared<LiveQueue>();
  // None before 1.5; a gap from 3 to 6.
  for (const double time : {2.0, 2.5, 3.0, 6.0, 7.0}) queue->push(odometry(time, time));
  for (const double time : {0.0, 2.0, 3.0, 7.8}) queue->push(scan(time));
  queue->push(scan(7.4));
  queue->end();
  std::vector<double> times, motions;
  const auto counts = streamPoles(queue, "sensors.ini", options(), [&](const ReadScan& taken) {
    times.push_back(taken.time);
    motions.push_back(taken.motion->mean.x);
  });
  EXPECT_EQ(times, (std::vector<double>{2, 3, 7.4}));
  ASSERT_EQ(motions.size(), 3u);
  EXPECT_EQ(motions[1], 1);
  EXPECT_NEAR(motions[2], 4.4, 1e-9) << "the last motion goes on";
  EXPECT_EQ(counts.unknownMotions, 2u);
}

/// As after a restart of an encoder's node: one packet far off, then readings from a new origin.
TEST(LiveQueue, AJumpOfTheOdometryIsBridged) {
  LiveQueueOptions many;
  many.longest = 100;
  const auto queue = std::make_shared<LiveQueue>(many);
  for (int i = 0; i <= 20; ++i) {
    const double time = 0.1 * i;
    queue->push(odometry(time, i == 10 ? 1e3 : i > 10 ? 0.1 * (i - 11) - 700 : 0.1 * i));
    queue->push(scan(time));
  }
  queue->end();
  std::size_t jumps = 0;
  double way = 0;
  const auto counts = streamPoles(queue, "sensors.ini", options(), [&](const ReadScan& taken) {
    EXPECT_GE(taken.odometryJumps, jumps);
    jumps = taken.odometryJumps;
    way += taken.motion->mean.x;
  });
  EXPECT_EQ(counts.odometryJumps, 2u);
  EXPECT_EQ(jumps, 2u);
  EXPECT_NEAR(way, 2, 1e-9);
}

/// A drive cannot be repeated: what ends it must not take what was before.
TEST(LiveQueue, WhatEndsADriveIsToldWithItsCounts) {
  const auto queue = std::make_shared<LiveQueue>();
  for (int i = 0; i < 5; ++i) {
    queue->push(odometry(i, 0));
    queue->push(scan(i));
  }
  queue->end();
  const auto counts = streamPoles(queue, "sensors.ini", options(), [&](const ReadScan& taken) {
    if (taken.index == 3) throw Error("enough");
  });
  EXPECT_EQ(counts.failure, "enough");
  EXPECT_EQ(counts.scans, 3u);
}

TEST(LiveQueue, AFailureAtTheFirstScanIsThrown) {
  const auto queue = std::make_shared<LiveQueue>();
  queue->push(odometry(1, 0));
  queue->push(scan(1));
  queue->end();
  EXPECT_REFUSED(streamPoles(queue, "sensors.ini", options(),
                             [](const ReadScan&) { throw Error("no start"); }),
                 "no start");
}

TEST(LiveQueue, AFailureEndsTheWaitForTheNextScan) {
  LiveQueueOptions options;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  std::atomic<bool> isLate{false};
  options.goesOn = [&] {
    isLate = std::chrono::steady_clock::now() > deadline;
    return !isLate;
  };
  const auto queue = std::make_shared<LiveQueue>(options);
  for (int i = 0; i < 3; ++i) {
    queue->push(odometry(i, 0));
    queue->push(scan(i));
  }
  const auto counts =
      streamPoles(queue, "sensors.ini", tests::sequence::options(), [](const ReadScan& taken) {
        if (taken.index < 1) return;
        std::this_thread::sleep_for(std::chrono::milliseconds(300));  // the next read waits by then
        throw Error("enough");
      });
  EXPECT_EQ(counts.failure, "enough");
  EXPECT_FALSE(isLate);
}

TEST(LiveQueue, OdometryThatNobodyTakesIsBounded) {
  LiveQueue queue;
  const auto reading = odometry(1, 0);
  for (std::size_t i = 0; i < LiveQueue::kMostReadings; ++i) queue.push(reading);
  queue.push(odometry(2, 0));
  queue.push(odometry(3, 0));
  queue.end();
  RawlogEntry entry;
  std::size_t taken = 0;
  while (queue.next(entry)) ++taken;
  EXPECT_EQ(taken, LiveQueue::kMostReadings);
}

TEST(LiveQueue, SaysThatThereIsNoOdometry) {
  const auto queue = std::make_shared<LiveQueue>([] {
    LiveQueueOptions many;
    many.longest = 100;
    return many;
  }());
  for (int i = 0; i < 60; ++i) queue->push(scan(i));
  queue->end();
  EXPECT_REFUSED(streamPoles(queue, "sensors.ini", options(), [](const ReadScan&) {}),
                 "sensors.ini: no odometry came with the first 50 scans", "CUdpOdometry");
}

}  // namespace
}  // namespace polemcl::test_live_queue
