#include <gtest/gtest.h>

#include "mrpt/rawlog/OdometryTrack.h"

namespace polemcl::test_odometry_track {
namespace {
/// Straight on at 3 m/s, ten readings a second.
OdometryTrack driven(double seconds) {
  OdometryTrack track;
  for (int i = 0; i <= 10 * seconds; ++i) track.add(0.1 * i, {0.3 * i, 0, 0});
  return track;
}

TEST(OdometryTrack, StartedAnewItGoesOn) {
  for (const double gap : {1.0, 3.0, 5.0, 60.0}) {
    OdometryTrack track = driven(100);
    for (int i = 0; i < 50; ++i) track.add(100 + gap + 0.1 * i, {0.3 * i, 0, 0});
    EXPECT_EQ(track.jumps(), 1u) << gap;
    EXPECT_NEAR(track.at(100 + gap)->x, 300 + 3 * gap, 1e-6) << gap;
    EXPECT_NEAR(track.at(104 + gap)->x, 312 + 3 * gap, 1e-6) << gap;
    EXPECT_NEAR(track.asRead(*track.at(104 + gap)).x, 12, 1e-6) << gap;
  }
}

TEST(OdometryTrack, AfterAGapAWayThatWasDrivenStays) {
  OdometryTrack track = driven(100);
  track.add(110, {200, 30, 2});  // turned back
  EXPECT_EQ(track.jumps(), 0u);
  OdometryTrack home;
  for (int i = 0; i < 100; ++i) home.add(0.1 * i, {-42 + 0.3 * i, 0, 0});
  home.add(14, {0.2, 0, 0});  // came back to where the odometry began
  EXPECT_EQ(home.jumps(), 0u);
  OdometryTrack near;
  for (int i = 0; i < 20; ++i) near.add(0.1 * i, {6, 0, 0});
  near.add(5, {0.3, 0, 0});  // it stood not far from there
  EXPECT_EQ(near.jumps(), 0u);
}

/// A reading just after another one tells no motion.
TEST(OdometryTrack, TheMotionOverAJumpIsThatOfALongerTime) {
  OdometryTrack track = driven(100);
  track.add(100.0005, {300.3, 0, 0});
  track.add(101, {0, 0, 0});
  EXPECT_EQ(track.jumps(), 1u);
  EXPECT_NEAR(track.at(101)->x, 303, 4);
}

}  // namespace
}  // namespace polemcl::test_odometry_track
