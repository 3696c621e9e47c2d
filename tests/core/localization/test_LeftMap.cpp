#include <gtest/gtest.h>

#include "support/HealthFeed.h"

namespace polemcl::test_left_map {
namespace {

using tests::Feed;
using State = HealthState;
using Reason = HealthReason;

/// The map ends: of ten poles near the vehicle it has fewer and fewer, and all of these are found.
TEST(LeftMap, BeyondTheMapPolesWithoutAMatchSayNothing) {
  Feed feed;
  feed.near = {10, 10, 10};
  feed.scans(60, 1);
  feed.near = {10, 3, 3.5};
  feed.scans(40, 0.3).expect(State::degraded, Reason::noPoles);
  EXPECT_TRUE(feed.monitor.hasLeftMap());
  feed.near = {10, 0, 0};
  feed.scans(100, 0).expect(State::degraded, Reason::noPoles);
  feed.sigma = 6;  // the odometry alone leads
  feed.scans(2, 0).expect(State::lost, Reason::spread);
  EXPECT_TRUE(feed.monitor.hasLeftMap()) << "it is still known which poles to expect";
  feed.sigma = 0.05;
  feed.near = {10, 8, 9};
  feed.scans(60, 0.8).expect(State::ok, Reason::none);
  EXPECT_FALSE(feed.monitor.hasLeftMap());
}

TEST(LeftMap, WhereTheMapHasPolesThatAreNotSeenThePoseIsWrong) {
  for (const NearPoles& near : {NearPoles{10, 0, 4}, NearPoles{10, 1, 4}, NearPoles{10, 3, 6}}) {
    Feed feed;
    feed.near = {10, 10, 10};
    feed.scans(60, 1);
    feed.near = near;
    feed.scans(60, 0.1).expect(State::degraded, Reason::mismatch);
    EXPECT_FALSE(feed.monitor.hasLeftMap());
    feed.near = {10, 0, 4};
    feed.scans(60, 0).expect(State::lost, Reason::mismatch);
    feed.near = {10, 0, 0};  // a wrong pose drives on, off the map
    feed.scans(60, 0).expect(State::lost, Reason::mismatch);
    EXPECT_FALSE(feed.monitor.hasLeftMap());
  }
}

TEST(LeftMap, APoseThatIsNotConfirmedYetHasNotLeftTheMap) {
  Feed feed;
  feed.near = {10, 0, 0};
  feed.scans(60, 0).expect(State::lost, Reason::mismatch);
  EXPECT_FALSE(feed.monitor.hasLeftMap());
}

}  // namespace
}  // namespace polemcl::test_left_map
