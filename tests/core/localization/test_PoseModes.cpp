#include <gtest/gtest.h>

#include <cmath>

#include "core/localization/PoseModes.h"
#include "sim/common/Random.h"

namespace polemcl::test_pose_modes {
namespace {

struct Cloud {
  std::vector<Pose2D> particles;
  std::vector<double> logWeights;

  void add(const Pose2D& centre, int count, double sigma, double weight, std::uint64_t seed) {
    sim::Random random(seed);
    for (int i = 0; i < count; ++i) {
      particles.push_back({random.normal(centre.x, sigma), random.normal(centre.y, sigma),
                           wrapAngle(centre.yaw + random.normal(0, 0.02))});
      logWeights.push_back(std::log(weight / count));
    }
  }
};

TEST(PoseModes, ATightCloudIsItsWeightedMean) {
  Cloud cloud;
  cloud.add({100, -40, 3.1}, 300, 0.1, 1, 1);
  const PoseMode mode = heaviestMode(cloud.particles, cloud.logWeights);
  const auto mean = weightedMean(cloud.particles, cloud.logWeights);
  EXPECT_EQ(mode.share, 1);
  EXPECT_EQ(mode.estimate.mean.x, mean.mean.x);
  EXPECT_EQ(mode.estimate.covariance, mean.covariance);
}

TEST(PoseModes, TheHeavierOfTwoPlacesWithItsShare) {
  Cloud cloud;
  cloud.add({0, 0, 0}, 500, 0.2, 0.3, 1);
  cloud.add({30, 5, 0.1}, 200, 0.2, 0.7, 2);  // fewer particles, more weight
  const PoseMode mode = heaviestMode(cloud.particles, cloud.logWeights);
  EXPECT_NEAR(mode.share, 0.7, 1e-9);
  EXPECT_NEAR(mode.estimate.mean.x, 30, 0.1);
  EXPECT_NEAR(mode.estimate.mean.y, 5, 0.1);
  // The other place is 30.4 m away with three tenths of the weight.
  EXPECT_NEAR(mode.estimate.covariance(0, 0), 0.3 * 900, 6);
}

TEST(PoseModes, TwoHeadingsAtOnePlaceAreTwo) {
  Cloud cloud;
  cloud.add({0, 0, 0.5}, 300, 0.1, 0.6, 1);
  cloud.add({0, 0, 0.5 - M_PI}, 300, 0.1, 0.4, 2);
  const PoseMode mode = heaviestMode(cloud.particles, cloud.logWeights);
  EXPECT_NEAR(mode.share, 0.6, 1e-9);
  EXPECT_NEAR(mode.estimate.mean.yaw, 0.5, 0.01);
}

TEST(PoseModes, HeadingsRoundTheCutAreOnePlace) {
  Cloud cloud;
  cloud.add({0, 0, M_PI - 0.01}, 300, 0.9, 1, 1);  // wide enough to be looked at
  EXPECT_NEAR(heaviestMode(cloud.particles, cloud.logWeights).share, 1, 0.01);
}

TEST(PoseModes, AWideCloudIsOnePlace) {
  Cloud cloud;
  cloud.add({7, 7, 1}, 4000, 3, 1, 3);
  EXPECT_GT(heaviestMode(cloud.particles, cloud.logWeights).share, 0.95);
}

TEST(PoseModes, LightParticlesBetweenAreNoBridge) {
  Cloud cloud;
  cloud.add({0, 0, 0}, 300, 0.1, 0.5, 1);
  cloud.add({20, 0, 0}, 300, 0.1, 0.5, 2);
  for (int x = 1; x < 20; ++x) cloud.add({double(x), 0, 0}, 1, 0, 1e-9, 4);
  EXPECT_NEAR(heaviestMode(cloud.particles, cloud.logWeights).share, 0.5, 1e-6);
}

TEST(PoseModes, RefusesWhatHasNoMean) {
  EXPECT_THROW(heaviestMode({}, {}), Error);
  EXPECT_THROW(heaviestMode({{0, 0, 0}}, {0, 0}), Error);
  EXPECT_THROW(heaviestMode({{0, 0, 0}}, {-INFINITY}), Error);
}

}  // namespace
}  // namespace polemcl::test_pose_modes
