#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "support/HealthFeed.h"

namespace polemcl::test_localization_health {
namespace {

using tests::Feed;
using State = HealthState;
using Reason = HealthReason;

TEST(LocalizationHealth, SearchingUntilAPoseIsAssumed) {
  HealthMonitor monitor;
  EXPECT_EQ(monitor.health().state, State::lost);
  EXPECT_EQ(monitor.health().reason, Reason::searching);
  HealthInput input;
  EXPECT_EQ(monitor.update(input).reason, Reason::searching);
}

TEST(LocalizationHealth, OkOnceMatchesOverSomeMetresBearThePoseOut) {
  Feed feed;
  feed.scans(5, 0.9).expect(State::degraded, Reason::converging);
  feed.scans(6, 0.9).expect(State::ok, Reason::none);  // 5.5 m
  EXPECT_NEAR(feed.last.matchedShare, 0.9, 1e-12);
  EXPECT_NEAR(feed.last.innovation, 1, 1e-12);  // m² of 2 over 2 degrees of freedom
}

// The spread of a few says nothing: that of one particle is 0.
TEST(LocalizationHealth, FewEffectiveParticlesAreDegraded) {
  Feed feed(20, 0.9);
  feed.expect(State::ok, Reason::none);
  for (const double few : {29.9, 1.0, 0.0}) {
    feed.particles = few;
    feed.scan(0.9).expect(State::degraded, Reason::spread);
  }
  feed.particles = 30;
  feed.scan(0.9).expect(State::ok, Reason::none);
}

TEST(LocalizationHealth, APoseThatASearchFoundIsBorneOutSooner) {
  Feed feed;
  feed.monitor.begin(PoseSource::found);
  feed.scans(3, 0.9).expect(State::degraded, Reason::converging);
  feed.scan(0.9).expect(State::ok, Reason::none);  // 2 m
}

TEST(LocalizationHealth, APoseFoundNearABelievedOneTakesLonger) {
  const auto scansUntilOk = [](Feed& feed, double share) {
    feed.monitor.begin(PoseSource::foundNear);
    int scans = 1;
    while (feed.scan(share).last.state != State::ok && scans < 40) ++scans;
    return scans;
  };
  Feed feed;
  EXPECT_EQ(scansUntilOk(feed, 0.8), 4);   // 2 m: the start was not believed yet
  EXPECT_EQ(scansUntilOk(feed, 0.8), 16);  // 8 m
  EXPECT_EQ(scansUntilOk(feed, 0.9), 4);   // nearly all match
  feed.monitor.begin(PoseSource::foundNear);
  feed.scan(0.8);
  EXPECT_EQ(scansUntilOk(feed, 0.8), 16);  // near a pose that was near a believed one
}

// 50 m with ten poles a scan, then 10 m with four: (50 · 10 + 10 · 4) / 60 = 9 are usual.
TEST(LocalizationHealth, WhatIsSeenIsComparedWithTheMeanOfALongWay) {
  Feed feed;
  feed.scans(100, 1, 10);
  EXPECT_NEAR(feed.last.seenShare, 1, 1e-9);
  EXPECT_NEAR(feed.scans(20, 1, 4).last.seenShare, 4.0 / 9, 0.02);

  Feed doubtful;  // six of ten match
  doubtful.scans(100, 0.6, 10);
  EXPECT_NEAR(doubtful.scans(20, 0.6, 5).last.seenShare, 5.0 / 9, 0.04);

  Feed sparse;  // less than a pole a scan
  sparse.confidence = 0.8;
  sparse.scans(100, 1, 1);
  sparse.confidence = 0.2;
  EXPECT_NEAR(sparse.scans(20, 1, 1).last.seenShare, 0.2 / 0.7, 0.03);
}

TEST(LocalizationHealth, TooFewMatchesDegradeThenLose) {
  Feed feed;
  feed.scans(40, 0.9).expect(State::ok, Reason::none);
  feed.scans(40, 0.3).expect(State::degraded, Reason::mismatch);
  feed.scans(40, 0.1).expect(State::degraded, Reason::mismatch);
  EXPECT_NEAR(feed.last.matchedShare, 0.1, 1e-12);
  feed.scans(40, 0).expect(State::lost, Reason::mismatch);
  feed.scans(40, 0.9).expect(State::ok, Reason::none);
}

// Key frames 3.6 m apart, as on the real kilometre. Three poles are too few for a window.
TEST(LocalizationHealth, FewPolesRaiseDoubtWhereNoneMatches) {
  Feed feed;
  feed.metres = 3.6;
  feed.scans(10, 0.9);
  feed.scan(0, 3).expect(State::ok, Reason::none);
  feed.scan(0, 3).expect(State::degraded, Reason::mismatch);
  feed.scans(4, 1, 3).expect(State::ok, Reason::none);
  feed.metres = 0.002;  // scans from one place show the same poles again
  feed.scans(20, 0, 3).expect(State::ok, Reason::none);
}

TEST(LocalizationHealth, DoubtIsForgottenAlikeHoweverLongItLasted) {
  for (const int scansOfDoubt : {250, 600}) {
    Feed feed(20, 1);
    feed.confidence = 0.2;  // too little for the shares of windows
    feed.scans(scansOfDoubt, 0, 1).expect(State::degraded, Reason::mismatch);
    feed.scans(45, 1, 1).expect(State::degraded, Reason::mismatch);
    feed.scans(35, 1, 1).expect(State::ok, Reason::none);
  }
}

TEST(LocalizationHealth, LostWithinTheWindowOfMetresAfterAJump) {
  Feed feed(60, 0.9);
  double driven = 0;
  while (feed.scan(0).last.state != State::lost && driven < 100) driven += feed.metres;
  EXPECT_LE(driven, 18);
}

TEST(LocalizationHealth, ChanceMatchesDoNotEndLost) {
  Feed feed(60, 0.8);
  feed.scans(60, 0).expect(State::lost, Reason::mismatch);
  feed.scans(60, 0.1).expect(State::lost, Reason::mismatch);
  feed.scans(60, 0.2).expect(State::degraded, Reason::mismatch);
  Feed poor;  // never lost before
  poor.scans(60, 0.8);
  poor.scans(60, 0.1).expect(State::degraded, Reason::mismatch);
}

TEST(LocalizationHealth, ALostPoseIsConfirmedAnew) {
  Feed feed;
  feed.metres = 8;  // scans far apart: one with four chance matches is no reason for `ok`
  feed.scans(10, 0.9).expect(State::ok, Reason::none);
  feed.sigma = 6;
  feed.scan(0, 0).expect(State::lost, Reason::spread);
  feed.sigma = 0.1;
  feed.scan(1).expect(State::degraded, Reason::converging);
  feed.scan(1).expect(State::ok, Reason::none);
}

/// A filter that spreads over three poles of the map fits them somewhere.
TEST(LocalizationHealth, ALostPoseNeedsFourPolesWithin18Metres) {
  Feed feed(20, 0.9);
  feed.expect(State::ok, Reason::none);
  feed.sigma = 6;
  feed.scan(0, 0).expect(State::lost, Reason::spread);
  feed.sigma = 0.1;
  feed.scans(40, 1, 3).expect(State::degraded, Reason::converging);
  feed.metres = 19;
  feed.firstPole = 3;
  feed.scan(1, 3).expect(State::degraded, Reason::converging);
  feed.metres = 2;
  feed.firstPole = 5;
  feed.scan(1, 2).expect(State::ok, Reason::none);
}

/// Three of them are judged together, though the window of 8 m has room for one.
TEST(LocalizationHealth, ScansFarApartWithFewPolesAreJudged) {
  Feed feed;
  feed.metres = 10;
  feed.scans(2, 1, 3).expect(State::degraded, Reason::converging);
  feed.scans(2, 1, 3).expect(State::ok, Reason::none);
  feed.scans(2, 0, 3);
  EXPECT_NE(feed.last.state, State::ok);
  Feed far;  // too far apart
  far.metres = 20;
  far.scans(10, 1, 3).expect(State::degraded, Reason::converging);
}

TEST(LocalizationHealth, AShortStretchWithoutMappedPolesDegradesOnly) {
  Feed feed(60, 0.9);
  for (int i = 0; i < 20; ++i) {  // 10 m, longer than the window of 8 m
    feed.scan(0);
    EXPECT_NE(feed.last.state, State::lost) << i;
  }
  feed.expect(State::degraded, Reason::mismatch);
}

TEST(LocalizationHealth, AFewNewPolesWhereTheMappedAreGoneDegradeOnly) {
  Feed few, more;
  few.scans(60, 0.9);
  more.scans(60, 0.9);
  few.scans(80, 0, 1).expect(State::degraded, Reason::mismatch);  // 37 scans in 18 m
  more.scans(80, 0, 2).expect(State::lost, Reason::mismatch);
}

TEST(LocalizationHealth, ANewPoseThatIsNeverBorneOutIsLost) {
  Feed feed;
  // Above lost_share, so only the lack of a confirmation tells.
  for (int i = 1; i < 30; ++i) feed.scan(0.3);
  feed.expect(State::degraded, Reason::converging);
  feed.scan(0.3).expect(State::lost, Reason::mismatch);  // 15 m
}

TEST(LocalizationHealth, ANewPoseIsHeldToAGreaterShareThanOneThatHasBeenOk) {
  Feed feed;
  feed.scans(29, 0.45, 20).expect(State::degraded, Reason::converging);
  feed.scan(0.45, 20).expect(State::lost, Reason::mismatch);  // 15 m
  feed.scans(60, 0.9).expect(State::ok, Reason::none);
  feed.scans(60, 0.45, 20).expect(State::ok, Reason::none);
}

TEST(LocalizationHealth, ANewPoseThatHardlyAnythingSpeaksForIsLostAtOnce) {
  Feed feed;
  feed.scans(3, 0.1).expect(State::degraded, Reason::converging);
  feed.scan(0.1).expect(State::lost, Reason::mismatch);  // 2 m
}

/// A LiDAR that sees 3 poles a scan, 10, or 28.
TEST(LocalizationHealth, ManyAndFewPolesAScanAreJudgedAlike) {
  const auto story = [](int poles) {
    Feed feed;
    std::vector<std::string> states;
    const auto tell = [&](int scans, double share, double confidence) {
      feed.confidence = confidence;
      for (int i = 0; i < scans; ++i) feed.scan(share, poles);
      states.push_back(std::string(name(feed.last.state)) + " " + name(feed.last.reason));
    };
    tell(60, 1, 1);
    tell(60, 0, 0.1);  // a tenth of the usual poles, all of them new
    EXPECT_NE(feed.last.state, State::lost) << poles;
    states.clear();
    tell(60, 1, 1);
    tell(60, 0, 0.2);
    feed.monitor.begin();
    tell(3, 0, 1);  // a wrong pose, 1.5 m on
    tell(1, 0, 1);
    return states;
  };
  const std::vector<std::string> expected{"ok none", "lost mismatch", "degraded converging",
                                          "lost mismatch"};
  for (const int poles : {3, 10, 28}) EXPECT_EQ(story(poles), expected) << poles;
}

TEST(LocalizationHealth, OneUnknownPoleDoesNotLoseANewPose) {
  Feed feed;
  feed.confidence = 0.8;
  feed.scans(9, 0, 1).expect(State::degraded, Reason::converging);  // 4.5 m, 7.2 sightings
}

TEST(LocalizationHealth, ManyPolesOfWhichNoneMatchesAreNeverOk) {
  Feed feed;
  feed.scans(60, 1, 28);
  feed.confidence = 0.07;  // two poles a scan
  feed.scans(100, 0, 28).expect(State::degraded, Reason::mismatch);
}

TEST(LocalizationHealth, WhatIsUsualOutlivesBlindStretchesAndSearches) {
  Feed feed(60, 1);
  feed.scans(800, 0, 0);  // 400 m
  feed.confidence = 0.1;
  feed.scans(60, 0).expect(State::degraded, Reason::mismatch);
  feed.monitor.begin();
  feed.scans(29, 0).expect(State::degraded, Reason::converging);
}

TEST(LocalizationHealth, FewPolesSayNothingAgainstThePose) {
  Feed feed(40, 0.9);
  feed.scans(17, 0, 0);  // the window of 8 m is empty
  feed.scan(0, 1).expect(State::ok, Reason::none);
}

TEST(LocalizationHealth, ScansFromOneViewpointCountAsOne) {
  Feed feed(40, 0.9);
  feed.metres = 0;
  feed.scan(0.0);
  EXPECT_NEAR(feed.last.innovation, 1, 1e-12);  // means of m² and of matches alike
  feed.scans(2999, 0.0).expect(State::degraded,
                               Reason::mismatch);  // five minutes beside something odd: not lost
  EXPECT_NEAR(feed.last.matchedShare, 0.9 * (16 + 1.0 / 3001) / 17, 1e-9);  // 17 viewpoints in 8 m
  feed.metres = 0.5;
  feed.scans(37, 0.0).expect(State::lost, Reason::mismatch);  // driving on, it is
}

TEST(LocalizationHealth, SpreadDegradesThenLoses) {
  Feed feed(40, 0.9);
  feed.sigma = 0.8;
  feed.scan(0.9).expect(State::degraded, Reason::spread);
  EXPECT_NEAR(feed.last.spread, 0.8, 1e-12);
  feed.sigma = 6;
  feed.scan(0.9).expect(State::lost, Reason::spread);
  feed.sigma = 0.02;
  feed.yaw = 0.1;
  feed.scan(0.9).expect(State::degraded, Reason::spread);
}

TEST(LocalizationHealth, SeveralPlacesAreAmbiguousNotLost) {
  Feed feed(40, 0.9);
  feed.modeShare = 0.6;
  feed.sigma = 60;
  feed.scan(0.9).expect(State::degraded, Reason::ambiguous);
}

TEST(LocalizationHealth, BlindByTimeOrByMetres) {
  Feed standing(40, 0.9);
  standing.metres = 0;
  standing.scans(19, 0, 0).expect(State::ok, Reason::none);
  standing.scans(3, 0, 0).expect(State::degraded, Reason::noPoles);  // 2.2 s
  Feed fast(40, 0.9);
  fast.metres = 3;
  fast.scans(7, 0, 0).expect(State::degraded, Reason::noPoles);  // 0.7 s, 21 m
  fast.metres = 0.5;
  fast.scans(10, 0.9).expect(State::ok, Reason::none);
}

TEST(LocalizationHealth, PolesWithoutConfidenceAreNotSeen) {
  Feed feed(40, 0.9);
  feed.confidence = 0;
  feed.scans(25, 1).expect(State::degraded, Reason::noPoles);
}

TEST(LocalizationHealth, FewMatchesBearNoPoseOut) {
  Feed feed;
  feed.confidence = 0.04;  // in 8 m 17 viewpoints of 10 poles: 6.8 sightings
  feed.scans(100, 0.9).expect(State::degraded, Reason::converging);
}

TEST(LocalizationHealth, ATimeGapIsNamedUntilMatchesOverMetres) {
  Feed feed(40, 0.9);
  feed.time += 120;
  feed.scan(0.9).expect(State::degraded, Reason::timeGap);
  feed.scans(11, 0.9).expect(State::ok, Reason::none);
  feed.time += 120;
  feed.scans(13, 0, 1).expect(State::degraded, Reason::timeGap);  // 6 m, and nothing matches
  feed.scans(11, 0.9).expect(State::ok, Reason::none);
}

TEST(LocalizationHealth, OdometryAndInnovationDegrade) {
  Feed feed(40, 0.9);
  feed.contradicted = true;
  feed.scan(0.9).expect(State::degraded, Reason::odometry);
  feed.contradicted = false;
  feed.squared = 10;
  feed.scans(40, 0.9).expect(State::degraded, Reason::innovation);
  EXPECT_NEAR(feed.last.innovation, 5, 1e-12);
}

TEST(LocalizationHealth, PolesThatFitAnotherPoseTogetherDegrade) {
  Feed feed;
  feed.scans(20, 0.6).expect(State::ok, Reason::none);
  feed.rival = {{0.4, 0, 0}, {1, 2, 3, 4, 5}};  // (5 - 2) 0.5 m / 3 m
  feed.scans(2, 0.6).expect(State::ok, Reason::none);
  feed.scan(0.6).expect(State::degraded, Reason::innovation);
  feed.rival = {};
  feed.scans(20, 1, 2).expect(State::degraded, Reason::innovation);  // 10 m with a few poles
}

TEST(LocalizationHealth, PolesThatFitAnotherPoseAreForgottenOverMetres) {
  Feed feed(20, 0.6);
  feed.rival = {{0.4, 0, 0}, {1, 2, 3, 4, 5}};
  feed.scans(20, 0.6);  // up to 2, which is the most
  feed.rival = {};
  feed.scans(23, 0.6).expect(State::degraded, Reason::innovation);  // above 1 for 12 m
  feed.scans(2, 0.6).expect(State::ok, Reason::none);
  feed.rival = {{0.4, 0, 0}, {1, 2, 3, 4, 5}};
  feed.scans(20, 0.6);
  feed.rival = {};
  feed.metres = 8;  // the same for scans far apart
  feed.scans(2, 0.6).expect(State::ok, Reason::none);
}

TEST(LocalizationHealth, TwoPolesThatFitAnotherPoseSayNothingHoweverOftenTheyAreSeen) {
  Feed feed(20, 0.6);
  feed.rival = {{0.4, 0, 0}, {1, 2}};
  for (int i = 0; i < 60; ++i) {
    feed.scan(0.6);
    EXPECT_EQ(feed.last.state, State::ok) << i;
  }
}

TEST(LocalizationHealth, PolesThatFitTheSameOtherPoseAddUp) {
  for (const auto& [x, yaw, state] :
       {std::tuple{0.5, 0.01, State::degraded}, {0.7, 0.0, State::ok}, {0.4, 0.03, State::ok}}) {
    Feed feed(20, 0.6);
    feed.rival = {{0.4, 0, 0}, {1, 2}};
    feed.scans(2, 0.6);
    for (std::size_t i = 0; i < 4; ++i) {  // 1, 2, 3, 4 beyond two: 10 * 0.5 m / 3 m
      feed.rival = {{i % 2 == 0 ? x : 0.4, 0, i % 2 == 0 ? yaw : 0}, {i, i + 3}};
      feed.scan(0.6);
    }
    EXPECT_EQ(feed.last.state, state) << x << ' ' << yaw;
  }
}

TEST(LocalizationHealth, PolesThatFittedAnotherPoseLongAgoDoNotAddUp) {
  Feed feed(20, 0.6);
  for (std::size_t i = 0; i < 20; ++i) {
    feed.rival = {{0.4, 0, 0}, {2 * i, 2 * i + 1}};
    feed.scan(0.6);
    feed.rival = {};
    feed.scans(25, 0.6);  // 12.5 m
    EXPECT_EQ(feed.last.state, State::ok) << i;
  }
}

TEST(LocalizationHealth, ANewPoseIsNotHeldByWhatWasBeforeItWasKnown) {
  Feed feed;
  feed.rival = {{0.4, 0, 0}, {1, 2, 3, 4, 5}};
  feed.scans(9, 0.9).expect(State::degraded, Reason::converging);
  feed.rival = {};
  feed.scans(3, 0.9).expect(State::ok, Reason::none);
}

TEST(LocalizationHealth, ElsewhereIsLostAndANewPoseMustProveItself) {
  Feed feed(40, 0.9);
  feed.monitor.reportElsewhere();
  EXPECT_EQ(feed.monitor.health().state, State::lost);
  EXPECT_EQ(feed.monitor.health().reason, Reason::elsewhere);
  feed.monitor.begin();
  feed.scan(0.9).expect(State::degraded, Reason::converging);
}

TEST(HealthMonitor, AVehicleThatIsMovedAtRestIsNoticed) {
  Feed feed(40, 0.9);
  feed.metres = 0;
  for (int i = 0; i < 600; ++i) ASSERT_EQ(feed.scan(0.5).last.state, State::ok) << i;
  feed.scans(50, 0.1).expect(State::degraded, Reason::mismatch);
}

}  // namespace
}  // namespace polemcl::test_localization_health
