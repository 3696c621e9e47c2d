#include <gtest/gtest.h>

#include "report/scene/Playback.h"

namespace polemcl::report::test_playback {
namespace {
constexpr HealthState ok = HealthState::ok, degraded = HealthState::degraded,
                      lost = HealthState::lost;

/// Scans 0.5 s apart.
void give(Playback& playback, const std::vector<HealthState>& states) {
  for (const HealthState state : states)
    playback.add(playback.isEmpty() ? 0 : playback.elapsed(playback.newest()) + 0.5, state);
}

/// A run that has played its scans as they came, and is paused at this one.
class AtScan {
 public:
  AtScan(std::size_t scan, const std::vector<HealthState>& states) {
    give(playback, states);
    playback.step(static_cast<std::ptrdiff_t>(scan));
  }
  Playback playback{Playback::Source::rawlog};
};

TEST(Playback, ARunGoesOnWhenItsNewestScanHasBeenShown) {
  Playback playback(Playback::Source::rawlog);
  EXPECT_TRUE(playback.wantsMore());
  playback.add(0, ok);
  EXPECT_EQ(playback.position(), 0u);
  EXPECT_TRUE(playback.wantsMore());
  playback.add(0.5, ok);
  EXPECT_EQ(playback.position(), 0u);  // until it is due
  EXPECT_FALSE(playback.wantsMore());
  EXPECT_TRUE(playback.canAdvance());
  EXPECT_TRUE(playback.follows());
  playback.advance();
  EXPECT_EQ(playback.position(), 1u);
  EXPECT_TRUE(playback.wantsMore());
  playback.advance();
  EXPECT_EQ(playback.position(), 1u);  // the run comes first
}

TEST(Playback, APauseHoldsTheRunOfARawlog) {
  Playback playback(Playback::Source::rawlog);
  playback.togglePause();  // before the first scan nothing is shown
  EXPECT_FALSE(playback.isPaused());
  playback.add(0, ok);
  playback.togglePause();
  EXPECT_TRUE(playback.isPaused());
  EXPECT_FALSE(playback.wantsMore());
  EXPECT_FALSE(playback.follows());
  playback.add(0.5, ok);  // it was on its way
  EXPECT_FALSE(playback.canAdvance());
  playback.togglePause();
  EXPECT_TRUE(playback.canAdvance());
}

TEST(Playback, SensorsAreNeverHeld) {
  Playback playback(Playback::Source::sensors);
  give(playback, {ok, ok});
  EXPECT_EQ(playback.position(), 1u);  // at once: it is the present
  playback.togglePause();
  give(playback, {ok, ok});
  EXPECT_EQ(playback.position(), 1u);
  EXPECT_TRUE(playback.wantsMore());
  playback.togglePause();
  playback.advance();
  EXPECT_EQ(playback.position(), 2u);  // played again from here
  playback.toNewest();
  give(playback, {ok});
  EXPECT_EQ(playback.position(), 4u);
}

TEST(Playback, StepsPauseAndStopAtTheFirstScan) {
  Playback playback(Playback::Source::rawlog);
  give(playback, {ok, ok, ok});
  playback.step(1);
  EXPECT_EQ(playback.position(), 1u);
  EXPECT_TRUE(playback.isPaused());
  playback.step(-1);
  playback.step(-1);
  EXPECT_EQ(playback.position(), 0u);
  playback.toNewest();
  EXPECT_EQ(playback.position(), 2u);
  EXPECT_TRUE(playback.isPaused());
  playback.toFirst();
  EXPECT_EQ(playback.position(), 0u);
}

TEST(Playback, AStepBeyondTheNewestLetsTheRunMakeOneScan) {
  Playback playback(Playback::Source::rawlog);
  give(playback, {ok, ok});
  playback.toNewest();
  playback.step(1);
  EXPECT_TRUE(playback.isSeeking());
  EXPECT_TRUE(playback.wantsMore());
  EXPECT_EQ(playback.position(), 1u);
  give(playback, {ok});
  EXPECT_EQ(playback.position(), 2u);
  EXPECT_FALSE(playback.isSeeking());
  EXPECT_FALSE(playback.wantsMore());
}

TEST(Playback, ATimeIsFoundOrWaitedFor) {
  AtScan at(3, {ok, ok, ok, ok});
  at.playback.goTo(0.6);
  EXPECT_EQ(at.playback.position(), 2u);  // at 1 s
  at.playback.skip(-0.5);
  EXPECT_EQ(at.playback.position(), 1u);
  at.playback.skip(-100);
  EXPECT_EQ(at.playback.position(), 0u);
  at.playback.goTo(2.4);
  give(at.playback, {ok});  // 2 s
  EXPECT_TRUE(at.playback.isSeeking());
  EXPECT_EQ(at.playback.position(), 0u);  // nothing is drawn on the way
  give(at.playback, {ok});
  EXPECT_EQ(at.playback.position(), 5u);
  EXPECT_TRUE(at.playback.isPaused());
}

TEST(Playback, WhatPlaysGoesOnPlayingFromTheTimeSought) {
  Playback playback(Playback::Source::rawlog);
  give(playback, {ok});
  playback.goTo(0.9);
  give(playback, {ok, ok});
  EXPECT_EQ(playback.position(), 2u);
  EXPECT_FALSE(playback.isPaused());
  EXPECT_TRUE(playback.wantsMore());
}

TEST(Playback, GoesFromTroubleToTrouble) {
  AtScan at(0, {degraded, ok, lost, lost, degraded, ok, ok});
  std::vector<std::size_t> visited;
  for (int i = 0; i < 2; ++i) {
    at.playback.toNextTrouble();
    visited.push_back(at.playback.position());
  }
  EXPECT_EQ(visited, (std::vector<std::size_t>{2, 4}));
  at.playback.toNextTrouble();
  EXPECT_TRUE(at.playback.isSeeking());
  give(at.playback, {ok, lost});
  EXPECT_EQ(at.playback.position(), 8u);
  EXPECT_TRUE(at.playback.isPaused());
  visited.clear();
  for (int i = 0; i < 4; ++i) {
    at.playback.toPreviousTrouble();
    visited.push_back(at.playback.position());
  }
  EXPECT_EQ(visited, (std::vector<std::size_t>{4, 2, 0, 0}));
}

TEST(Playback, WithoutTroubleBeforeThePictureStaysAndPlaysOn) {
  Playback playback(Playback::Source::rawlog);
  give(playback, {ok, ok});
  playback.advance();
  playback.toPreviousTrouble();
  EXPECT_EQ(playback.position(), 1u);
  EXPECT_FALSE(playback.isPaused());
}

TEST(Playback, APauseEndsASearch) {
  AtScan at(0, {ok, ok, ok});
  at.playback.toNextTrouble();
  at.playback.togglePause();
  EXPECT_FALSE(at.playback.isSeeking());
  EXPECT_TRUE(at.playback.isPaused());
  EXPECT_EQ(at.playback.position(), 2u);
}

TEST(Playback, WhatIsNotFoundByTheEndLeavesTheLastScanPaused) {
  AtScan at(0, {ok, ok});
  at.playback.toNextTrouble();
  give(at.playback, {ok});
  at.playback.end();
  EXPECT_EQ(at.playback.position(), 2u);
  EXPECT_TRUE(at.playback.isPaused());
  EXPECT_FALSE(at.playback.isOver());
  at.playback.goTo(1000);  // after the end too
  EXPECT_FALSE(at.playback.isSeeking());
  EXPECT_EQ(at.playback.position(), 2u);
  at.playback.togglePause();
  EXPECT_TRUE(at.playback.isOver());
}

TEST(Playback, IsOverWhenTheLastScanHasBeenPlayed) {
  Playback playback(Playback::Source::rawlog);
  playback.end();
  EXPECT_FALSE(playback.isOver());  // nothing was shown
  give(playback, {ok, ok});
  EXPECT_FALSE(playback.isOver());
  playback.advance();
  EXPECT_TRUE(playback.isOver());
}

TEST(Playback, ForgottenScansAreNotShown) {
  AtScan at(0, {degraded, ok, ok, lost, ok});
  at.playback.forget(2);
  EXPECT_EQ(at.playback.position(), 2u);
  at.playback.step(-1);
  EXPECT_EQ(at.playback.position(), 2u);
  at.playback.goTo(0);
  EXPECT_EQ(at.playback.position(), 2u);
  at.playback.toNewest();
  at.playback.toPreviousTrouble();
  at.playback.toPreviousTrouble();
  EXPECT_EQ(at.playback.position(), 3u);
  at.playback.toFirst();
  EXPECT_EQ(at.playback.position(), 2u);
}

}  // namespace
}  // namespace polemcl::report::test_playback
