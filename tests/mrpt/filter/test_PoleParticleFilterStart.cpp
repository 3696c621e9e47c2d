// Start of the filter: discs around a pose, and mixtures of places.
#include <gtest/gtest.h>

#include <cmath>

#include "mrpt/filter/PoleParticleFilter.h"
#include "support/FilterSamples.h"

namespace polemcl::test_pole_particle_filter_start {

using tests::at;
using tests::degree;
using tests::emptyFrame;
using tests::makeStreet;
using tests::PoleStreet;
using tests::smallMap;
using tests::still;

TEST(PoleParticleFilter, StartIsUniformInTheDiscAndInHeading) {
  FilterOptions options = still();
  options.particles = 40000;
  PoleParticleFilter localizer(smallMap(), options, 9);
  const Pose2D centre{100, -50, 3.1};
  localizer.start(at(centre, 2.0, 0.2));
  int inner = 0, left = 0, turned = 0;
  for (const Pose2D& particle : localizer.particles()) {
    const double distance = std::hypot(particle.x - centre.x, particle.y - centre.y);
    const double turn = wrapAngle(particle.yaw - centre.yaw);
    EXPECT_LE(distance, 2.0);
    EXPECT_LE(std::abs(turn), 0.2 + 1e-12);
    EXPECT_LE(std::abs(particle.yaw), M_PI);
    inner += distance < 1.0;
    left += particle.x < centre.x;
    turned += turn < -0.1;
  }
  // Four standard deviations of a binomial number: 4·sqrt(40000·¼·¾) = 346, 4·100 = 400.
  EXPECT_NEAR(inner, 10000, 346) << "half the radius is a quarter of the area";
  EXPECT_NEAR(left, 20000, 400);
  EXPECT_NEAR(turned, 10000, 346);
}

TEST(PoleParticleFilter, StartCanBeUniformInTheDistanceFromTheCentre) {
  FilterOptions options = still();
  options.particles = 40000;
  PoleParticleFilter localizer(smallMap(), options, 9);
  StartOptions start = at({100, -50, 3.1}, 2.0, 0.2);
  start.positions = StartPositions::radius;
  localizer.start(start);
  int inner = 0, left = 0;
  for (const Pose2D& particle : localizer.particles()) {
    const double distance = std::hypot(particle.x - 100, particle.y + 50);
    EXPECT_LE(distance, 2.0);
    inner += distance < 0.5;
    left += particle.x < 100;
  }
  EXPECT_NEAR(inner, 10000, 346) << "a quarter of the radius has a quarter of the particles";
  EXPECT_NEAR(left, 20000, 400);
}

TEST(PoleParticleFilter, TheEstimateIsTakenBeforeOrAfterResampling) {
  const PoleStreet street = makeStreet({});
  FilterOptions options = still();
  options.resampleBelow = 0.5;
  options.estimate = PoseEstimator::bestShare;
  PoleParticleFilter before(street.map, options, 5);
  options.estimateTime = EstimateTime::afterResampling;
  PoleParticleFilter after(street.map, options, 5);
  before.start(at(street.truth[50]));
  after.start(at(street.truth[50]));
  const Pose2D early = before.step(street.frames[50]).mean;
  const Pose2D late = after.step(street.frames[50]).mean;
  ASSERT_TRUE(after.report().resampled);
  // The particles are the same; the late estimate is the mean of the first tenth of them.
  const std::vector<Pose2D> particles = after.particles(), same = before.particles();
  for (std::size_t i = 0; i < same.size(); ++i) ASSERT_EQ(particles[i].x, same[i].x);
  double x = 0, y = 0;
  for (int i = 0; i < 100; ++i) x += particles[i].x / 100, y += particles[i].y / 100;
  EXPECT_NEAR(late.x, x, 1e-9);
  EXPECT_NEAR(late.y, y, 1e-9);
  EXPECT_GT(std::hypot(early.x - late.x, early.y - late.y), 1e-3);
}

TEST(PoleParticleFilter, StartDrawsFromAMixtureOfHypotheses) {
  PoleParticleFilter localizer(smallMap(), {}, 3);
  std::vector<PoseHypothesis> hypotheses(3);
  hypotheses[0].pose.mean = {100, 0, 3.1};
  hypotheses[0].pose.covariance << 0.25, 0.1, 0.02, 0.1, 0.16, 0.01, 0.02, 0.01, 0.01;
  hypotheses[0].weight = 3;
  hypotheses[1].pose.mean = {-100, 50, 0};  // covariance 0: all in one place
  hypotheses[2].weight = 0;
  localizer.start(hypotheses, 40000);
  std::vector<Pose2D> near;
  std::size_t exact = 0;
  for (const Pose2D& pose : localizer.particles()) {
    if (pose.x > 50) near.push_back(pose);
    exact += pose.x == -100 && pose.y == 50 && pose.yaw == 0;
    EXPECT_LE(std::abs(pose.yaw), M_PI);
  }
  EXPECT_EQ(near.size(), 30000u);
  EXPECT_EQ(exact, 10000u);
  const auto drawn = weightedMean(near, std::vector<double>(near.size(), 0));
  // Four standard deviations: 4·0.5/sqrt(30000), 4·0.1/sqrt(30000), of variances
  // 4·0.25·sqrt(2/3e4).
  EXPECT_NEAR(drawn.mean.x, 100, 0.012);
  EXPECT_NEAR(drawn.mean.y, 0, 0.012);
  EXPECT_NEAR(wrapAngle(drawn.mean.yaw - 3.1), 0, 0.0024);
  const Eigen::Matrix3d off = drawn.covariance - hypotheses[0].pose.covariance;
  EXPECT_LT(off.cwiseAbs().maxCoeff(), 0.009);
  EXPECT_LT(off.row(2).cwiseAbs().maxCoeff(), 0.0016);
}

TEST(PoleParticleFilter, StartFromHypothesesKeepsTheUsualNumberAfterwards) {
  const PoleStreet street = makeStreet({});
  PoleParticleFilter localizer(street.map, {}, 3);
  PoseHypothesis right, wrong;
  right.pose.mean = street.truth[0];
  right.pose.covariance = Eigen::Vector3d(0.04, 0.04, 0.001).asDiagonal();
  wrong.pose = right.pose;
  wrong.pose.mean = compose(street.truth[0], {15, 3, 1});
  wrong.weight = 2;
  localizer.start({wrong, right}, 3000);
  EXPECT_EQ(localizer.particles().size(), 3000u);
  PoseWithCovariance estimate;
  for (int i = 0; i < 40; ++i) estimate = localizer.step(street.frames[i]);
  EXPECT_EQ(localizer.particles().size(), 1000u);
  EXPECT_LT(std::hypot(estimate.mean.x - street.truth[39].x, estimate.mean.y - street.truth[39].y),
            0.1);
}

TEST(PoleParticleFilter, RefusesBadHypothesesAndStaysAsItWas) {
  PoleParticleFilter localizer(smallMap(), {}, 1);
  localizer.start(at({7, 0, 0}, 0, 0));
  PoseHypothesis good;
  good.pose.covariance = Eigen::Matrix3d::Identity();
  std::vector<PoseHypothesis> bad(6, good);
  bad[0].weight = -0.5;
  bad[1].weight = NAN;
  bad[2].pose.mean.yaw = INFINITY;
  bad[3].pose.covariance(0, 1) = bad[3].pose.covariance(1, 0) = 2;  // indefinite
  bad[4].pose.covariance(0, 1) = 0.5;                               // not symmetric
  bad[5].pose.covariance(2, 2) = NAN;
  for (const auto& hypothesis : bad) EXPECT_THROW(localizer.start({good, hypothesis}, 100), Error);
  EXPECT_THROW(localizer.start(std::vector<PoseHypothesis>{}, 100), Error);
  EXPECT_THROW(localizer.start({good}, 0), Error);
  EXPECT_THROW(localizer.start({good}, 1000001), Error);
  good.weight = 0;
  EXPECT_THROW(localizer.start({good, good}, 100), Error);
  EXPECT_EQ(localizer.step(emptyFrame(0)).mean.x, 7);
}

}  // namespace polemcl::test_pole_particle_filter_start
