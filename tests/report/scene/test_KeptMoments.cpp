#include <gtest/gtest.h>

#include "report/scene/LiveMoment.h"
#include "support/LiveMoments.h"

namespace polemcl::report::test_kept_moments {
namespace {
/// knownMoment(), moved along x by the scan.
LiveMoment momentAt(std::size_t scan) {
  LiveMoment moment = knownMoment();
  moment.scan = scan;
  moment.elapsed = 0.1 * static_cast<double>(scan);
  moment.estimate->mean.x += static_cast<double>(scan);
  moment.particles.clear();
  moment.weights.clear();
  moment.way.clear();
  for (int i = 0; i < 1000; ++i) {
    moment.particles.push_back({moment.estimate->mean.x + 0.001 * i, -0.5, 0});
    moment.weights.push_back(0.001 * i);
  }
  moment.points_robot = {{1, 2, 3}};
  return moment;
}

KeptMoments keptUpTo(std::size_t scans) {
  KeptMoments kept;
  for (std::size_t scan = 0; scan < scans; ++scan) kept.add(momentAt(scan));
  return kept;
}

TEST(KeptMoments, GoingBackGivesTheSamePoses) {
  const KeptMoments kept = keptUpTo(5);
  for (std::size_t scan = 0; scan < 5; ++scan) {
    const LiveMoment then = momentAt(scan), now = kept.at(scan);
    EXPECT_EQ(now.scan, scan);
    EXPECT_EQ(now.elapsed, then.elapsed);
    EXPECT_EQ(now.estimate->mean.x, then.estimate->mean.x);
    EXPECT_EQ(now.estimate->mean.yaw, then.estimate->mean.yaw);
    EXPECT_EQ(now.estimate->covariance, then.estimate->covariance);
    EXPECT_EQ(now.health.matchedShare, then.health.matchedShare);
    EXPECT_EQ(now.step.particles, then.step.particles);
    ASSERT_EQ(now.poles_robot.size(), 2u);
    EXPECT_NEAR(now.poles_robot[0].x, -5, 1e-6);
    EXPECT_NEAR(now.poles_robot[0].top, 3, 1e-6);
    EXPECT_TRUE(now.matches[0].matched);
    EXPECT_FALSE(now.matches[1].matched);
  }
}

TEST(KeptMoments, TheNewestHasEverythingTheOthersFewParticles) {
  const KeptMoments kept = keptUpTo(3);
  EXPECT_EQ(kept.at(2).particles.size(), 1000u);
  EXPECT_EQ(kept.at(2).points_robot.size(), 1u);
  const LiveMoment before = kept.at(1);
  EXPECT_TRUE(before.points_robot.empty());
  ASSERT_EQ(before.particles.size(), KeptMoments::mostParticles);
  for (std::size_t k = 0; k < before.particles.size(); ++k) {  // each tenth
    EXPECT_NEAR(before.particles[k].x, 11 + 0.01 * static_cast<double>(k), 1e-6);
    EXPECT_NEAR(before.particles[k].y, -0.5, 1e-6);
    EXPECT_NEAR(before.weights[k], 0.01 * static_cast<double>(k), 1e-6);
  }
}

TEST(KeptMoments, TheWayEndsAtTheMomentAndKnowsItsHealth) {
  KeptMoments kept;
  for (std::size_t scan = 0; scan < 10; ++scan) {
    LiveMoment moment = momentAt(0);
    moment.scan = scan;
    moment.estimate->mean.x = 0.3 * static_cast<double>(scan);
    if (scan == 5) moment.health.state = HealthState::lost;  // between two points that stay
    moment.truth = Pose2D{moment.estimate->mean.x, 0.25, 0};
    kept.add(moment);
  }
  const auto then = kept.at(5).way;  // points each metre: scans 0, 4, 8; and the pose
  ASSERT_EQ(then.size(), 3u);
  EXPECT_EQ(then[1].scan, 4u);
  EXPECT_EQ(then[2].x, 1.5);
  EXPECT_TRUE(then[2].joined);
  EXPECT_EQ(then[2].state, HealthState::lost);
  const auto last = kept.at(9).way;
  ASSERT_EQ(last.size(), 4u);
  EXPECT_EQ(last[1].state, HealthState::ok);
  EXPECT_EQ(last[2].state, HealthState::lost);  // the worst since scan 4
  EXPECT_EQ(last[3].state, HealthState::ok);
  EXPECT_EQ(kept.at(5).trueWay.back().x, 1.5);
  EXPECT_EQ(kept.at(5).trueWay.back().y, 0.25);
  ASSERT_EQ(kept.errors().size(), 10u);
  EXPECT_NEAR(kept.errors()[5], 0.25, 1e-6);
}

TEST(KeptMoments, WithoutAPoseThereIsNone) {
  KeptMoments kept;
  kept.add(searchingMoment());
  LiveMoment known = momentAt(1);
  kept.add(known);
  const LiveMoment then = kept.at(0);
  EXPECT_FALSE(then.estimate);
  EXPECT_TRUE(then.way.empty());
  EXPECT_TRUE(then.particles.empty());
  EXPECT_TRUE(then.matches.empty());
  EXPECT_EQ(then.poles_robot.size(), 3u);
  EXPECT_EQ(then.hypotheses.size(), 2u);
  EXPECT_EQ(then.health.reason, HealthReason::searching);
  EXPECT_LT(kept.errors()[1], 0);
}

TEST(KeptMoments, OfALongDriveTheLastOnesAreKept) {
  KeptMoments kept;
  LiveMoment moment = searchingMoment();
  moment.poles_robot.clear();
  moment.hypotheses.clear();
  const auto giveUpTo = [&](std::size_t end) {
    for (; moment.scan < end; ++moment.scan) {
      moment.elapsed = static_cast<double>(moment.scan);
      kept.add(moment);
    }
  };
  giveUpTo(KeptMoments::mostScans);
  EXPECT_EQ(kept.oldest(), 0u);
  giveUpTo(KeptMoments::mostScans + 3);
  EXPECT_EQ(kept.oldest(), 3u);
  EXPECT_EQ(kept.at(3).elapsed, 3);
  EXPECT_EQ(kept.at(100).elapsed, 100);
}

}  // namespace
}  // namespace polemcl::report::test_kept_moments
