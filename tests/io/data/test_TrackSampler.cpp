#include <gtest/gtest.h>

#include "io/data/TrackSampler.h"

namespace polemcl::test_track_sampler {
namespace {

using namespace polemcl::io;

Eigen::Isometry3d pose(double x, double yaw) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.translation().x() = x;
  result.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return result;
}

double yaw(const Eigen::Isometry3d& p) {
  return std::atan2(p.linear()(1, 0), p.linear()(0, 0));
}

TEST(TrackSampler, InterpolatesBetweenSamplesAndTakesSamplesAsTheyAre) {
  TrackSampler track({10.25, 11, 11.5}, 2);
  track.add(10, pose(0, 3));
  track.add(11, pose(4, -3));  // across ±180°: 0.283 rad
  track.add(12, pose(6, -3));
  ASSERT_EQ(track.found(), 3u);
  EXPECT_NEAR(track.poses()[0]->translation().x(), 1, 1e-12);
  EXPECT_NEAR(yaw(*track.poses()[0]), 3 + (2 * M_PI - 6) / 4, 1e-12);
  EXPECT_EQ(track.poses()[1]->matrix(), pose(4, -3).matrix());
  EXPECT_NEAR(track.poses()[2]->translation().x(), 5, 1e-12);
  EXPECT_EQ(track.span(), "10.000 ... 12.000 s");
}

TEST(TrackSampler, KnowsNothingOutsideTheTrackAndInGaps) {
  TrackSampler track({9.9, 10, 10.5, 11.5, 14, 14.1}, 1);
  EXPECT_EQ(track.span(), "none");
  for (const double time : {10.0, 11.0, 14.0}) EXPECT_TRUE(track.add(time, pose(time, 0)));
  std::vector<bool> found;
  for (const auto& p : track.poses()) found.push_back(p.has_value());
  EXPECT_EQ(found, std::vector<bool>({false, true, true, false, true, false}));
}

TEST(TrackSampler, ForgivesRoundedTimes) {
  TrackSampler track({1.0000015, 1.9999985}, 0.1);
  track.add(1, pose(1, 0));
  track.add(2, pose(2, 0));
  ASSERT_EQ(track.found(), 2u);
  EXPECT_EQ(track.poses()[0]->translation().x(), 1);
  EXPECT_EQ(track.poses()[1]->translation().x(), 2);
}

TEST(TrackSampler, DoesNotUseSamplesOutOfOrder) {
  TrackSampler track({1.5}, 1);
  EXPECT_TRUE(track.add(1, pose(1, 0)));
  EXPECT_FALSE(track.add(1, pose(7, 0)));
  EXPECT_FALSE(track.add(0.5, pose(7, 0)));
  EXPECT_TRUE(track.add(2, pose(2, 0)));
  EXPECT_NEAR(track.poses()[0]->translation().x(), 1.5, 1e-12);
}

}  // namespace
}  // namespace polemcl::test_track_sampler
