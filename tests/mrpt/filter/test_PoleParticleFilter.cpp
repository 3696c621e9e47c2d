#include <gtest/gtest.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <algorithm>
#include <cmath>

#include "mrpt/filter/PoleParticleFilter.h"
#include "support/FilterSamples.h"
#include "support/Refusal.h"

namespace polemcl::test_pole_particle_filter {
namespace {

using tests::at;
using tests::degree;
using tests::Dice;
using tests::emptyFrame;
using tests::makeStreet;
using tests::PoleStreet;
using tests::smallMap;
using tests::still;
using tests::StreetOptions;

struct Errors {
  double position = 0, heading = 0;  ///< means, m and degrees
  double worst = 0;                  ///< from the eleventh scan on, m
};

Errors drive(PoleParticleFilter& localizer, const PoleStreet& street,
             StartPositions positions = StartPositions::area) {
  StartOptions start = at(street.truth[0]);
  start.positions = positions;
  if (positions == StartPositions::radius) start.particles = 1000;
  localizer.start(start);
  Errors errors;
  for (std::size_t i = 0; i < street.frames.size(); ++i) {
    const Pose2D estimate = localizer.step(street.frames[i]).mean;
    const Pose2D error = relative(street.truth[i], estimate);
    errors.position += std::hypot(error.x, error.y) / street.frames.size();
    errors.heading += std::abs(error.yaw) / degree / street.frames.size();
    if (i >= 10) errors.worst = std::max(errors.worst, std::hypot(error.x, error.y));
  }
  return errors;
}

TEST(PoleParticleFilter, FollowsAStreet) {
  for (std::uint32_t seed : {1, 2, 3}) {
    StreetOptions options;
    options.seed = seed;
    const PoleStreet street = makeStreet(options);
    PoleParticleFilter localizer(street.map, {}, seed);
    const Errors errors = drive(localizer, street);
    // One scan alone gives 0.04 m here, a Kalman filter with known associations 0.015 m.
    EXPECT_LT(errors.position, 0.03) << "seed " << seed;
    EXPECT_LT(errors.heading, 0.1) << "seed " << seed;
    EXPECT_LT(errors.worst, 0.15) << "seed " << seed;
  }
}

TEST(PoleParticleFilter, FollowsAStreetAsThePaperDoes) {
  FilterOptions paper;
  paper.estimate = PoseEstimator::bestShare;
  paper.tempering = paper.regularization = paper.extraSigma = paper.extraSigmaYaw = 0;
  for (const auto model : {LikelihoodModel::paper, LikelihoodModel::floored}) {
    double sum = 0;
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
      StreetOptions options;
      options.seed = seed;
      const PoleStreet street = makeStreet(options);
      LikelihoodOptions likelihood;
      likelihood.model = model;
      likelihood.weighted = false;
      likelihood.sigma = likelihood.gate = 1;
      street.map->likelihoodOptions = likelihood;
      street.map->setPoles(street.map->poles());
      paper.estimateTime = model == LikelihoodModel::paper ? EstimateTime::beforeResampling
                                                           : EstimateTime::afterResampling;
      PoleParticleFilter localizer(street.map, paper, seed);
      sum += drive(localizer, street, StartPositions::radius).position;
    }
    // Measured: 0.038 m with Eq. 3, 0.043 m as the authors' program.
    EXPECT_LT(sum / 10, model == LikelihoodModel::paper ? 0.042 : 0.047);
  }
}

TEST(PoleParticleFilter, BatchEqualsTheMapsLikelihood) {
  const PoleStreet street = makeStreet({});
  Dice dice(3);
  auto observation = CObservationPoles::Create();
  observation->poles = street.frames[50].poles_robot;
  for (auto& pole : observation->poles)
    pole.covariance = Eigen::Vector2d(dice.uniform(0.001, 0.02), 0.01).asDiagonal();
  ASSERT_GE(observation->poles.size(), 3u);
  for (const bool paper : {true, false})
    for (const bool weighted : {true, false}) {
      LikelihoodOptions likelihood;
      likelihood.model = paper ? LikelihoodModel::paper : LikelihoodModel::mixture;
      likelihood.sigma = 0.15;
      likelihood.weighted = weighted;
      street.map->likelihoodOptions = likelihood;
      PoleParticleFilter localizer(street.map, still(), 1);
      localizer.start(at(street.truth[50], 1.5, M_PI));
      PoleScan frame;
      frame.poles_robot = observation->poles;
      localizer.step(frame);
      const auto particles = localizer.particles();
      const auto weights = localizer.logWeights();
      const auto likelihoodAt = [&](const Pose2D& pose) {
        return street.map->computeObservationLikelihood(
            *observation, mrpt::poses::CPose3D(pose.x, pose.y, 0, pose.yaw, 0, 0));
      };
      const double offset = weights[0] - likelihoodAt(particles[0]);
      double span = 0;
      for (std::size_t i = 0; i < particles.size(); ++i) {
        EXPECT_NEAR(weights[i] - offset, likelihoodAt(particles[i]), 1e-9);
        span = std::max(span, std::abs(weights[i] - weights[0]));
      }
      EXPECT_GT(span, 1);  // otherwise the comparison proves nothing
    }
}

TEST(PoleParticleFilter, WorksAsAFilterOfMrpt) {
  const PoleStreet street = makeStreet({});
  FilterOptions options = still();
  PoleParticleFilter own(street.map, options, 5), mrpts(street.map, options, 5);
  own.start(at(street.truth[50]));
  mrpts.start(at(street.truth[50]));
  own.step(street.frames[50]);
  // The same poles, seen by a sensor with another mounting.
  const Pose2D mounting{0.7, -0.2, 0.5};
  auto observation = CObservationPoles::Create();
  observation->poles = street.frames[50].poles_robot;
  for (auto& pole : observation->poles) {
    const Pose2D seen = relative(mounting, {pole.x, pole.y, 0});
    pole.x = seen.x, pole.y = seen.y;
  }
  observation->setSensorPose(mrpt::poses::CPose3D(0.7, -0.2, 1.7, 0.5, 0, 0));
  mrpt::obs::CSensoryFrame frame;
  frame.insert(observation);
  mrpt::bayes::CParticleFilter filter;
  filter.m_options.BETA = 0;
  filter.executeOn(mrpts, nullptr, &frame);
  const auto expected = own.logWeights(), got = mrpts.logWeights();
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(got[i], expected[i], 1e-9);
  // MRPT's exponent of the likelihood.
  mrpts.start(at(street.truth[50]));
  const auto particles = mrpts.particles();
  filter.m_options.powFactor = 0.25;
  filter.executeOn(mrpts, nullptr, &frame);
  std::vector<double> values;
  street.map->logLikelihoods(*observation, particles, values);
  const double greatest = *std::max_element(values.begin(), values.end());
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_NEAR(mrpts.logWeights()[i], 0.25 * (values[i] - greatest), 1e-12);
}

TEST(PoleParticleFilter, AsksTheMapNotTheCore) {
  const PoleStreet street = makeStreet({});
  const auto silent = std::make_shared<CPoleMap>(*street.map);
  silent->genericMapParams.enableObservationLikelihood = false;  // as in any MRPT map
  for (const double tempering : {0.0, 0.2}) {
    FilterOptions options = still();
    options.resampleBelow = options.regularization = options.tempering = tempering;
    PoleParticleFilter localizer(silent, options, 1);
    localizer.start(at(street.truth[50]));
    localizer.step(street.frames[50]);
    EXPECT_EQ(localizer.report().effectiveShare, 1);
    EXPECT_GT(localizer.report().poles, 3u);
  }
}

TEST(PoleParticleFilter, MotionHasTheGivenCovarianceAndTheExtraNoise) {
  FilterOptions options = still();
  options.particles = 100000;
  options.extraSigma = 0.05;
  options.extraSigmaYaw = 0.02;
  PoleParticleFilter localizer(smallMap(), options, 2);
  const Pose2D start{10, 20, M_PI / 2};
  localizer.start(at(start, 0, 0));
  localizer.step(emptyFrame(0));
  PoseWithCovariance motion;
  motion.mean = {1, 0.5, 0.25};
  motion.covariance << 0.04, -0.01, 0.004, -0.01, 0.02, 0.001, 0.004, 0.001, 0.0009;
  const PoseWithCovariance estimate = localizer.step(emptyFrame(1, motion));
  EXPECT_NEAR(estimate.mean.x, 9.5, 0.003);
  EXPECT_NEAR(estimate.mean.y, 21, 0.003);
  EXPECT_NEAR(estimate.mean.yaw, M_PI / 2 + 0.25, 0.0005);
  // Turned by 90°: x of the map is -y of the robot.
  Eigen::Matrix3d expected;
  expected << 0.0225, 0.01, -0.001, 0.01, 0.0425, 0.004, -0.001, 0.004, 0.0013;
  EXPECT_LT((estimate.covariance - expected).cwiseAbs().maxCoeff(), 6e-4);
  EXPECT_LT((estimate.covariance - expected).row(2).cwiseAbs().maxCoeff(), 1.2e-4);
}

TEST(PoleParticleFilter, FirstFrameIsWhereTheStartPoseIs) {
  PoleParticleFilter localizer(smallMap(), still(), 1);
  localizer.start(at({1, 2, 3}, 0, 0));
  PoseWithCovariance motion;
  motion.mean = {5, 5, 1};
  EXPECT_NEAR(localizer.step(emptyFrame(0, motion)).mean.x, 1, 1e-12);
  EXPECT_GT(std::abs(localizer.step(emptyFrame(1, motion)).mean.x - 1), 1);
  localizer.start(at({1, 2, 3}, 0, 0));  // restart: time may start again too
  EXPECT_NEAR(localizer.step(emptyFrame(0, motion)).mean.x, 1, 1e-12);
}

TEST(PoleParticleFilter, FramesWithoutPolesOnlyPredict) {
  PoleParticleFilter localizer(smallMap(), {}, 1);
  localizer.start(at({0, 0, 0}, 0, 0));
  PoseWithCovariance motion;
  motion.mean = {1, 0, 0};
  localizer.step(emptyFrame(0));
  double before = 0;
  for (int i = 1; i <= 50; ++i) {
    const auto estimate = localizer.step(emptyFrame(i, motion));
    EXPECT_NEAR(estimate.mean.x, i, 0.05);
    EXPECT_GT(estimate.covariance(1, 1), before);
    before = estimate.covariance(1, 1);
    EXPECT_DOUBLE_EQ(localizer.report().effectiveShare, 1);
    EXPECT_FALSE(localizer.report().resampled);
    EXPECT_EQ(localizer.report().poles, 0u);
  }
}

/// Particles far apart are tempered; without poles there is nothing to temper.
TEST(PoleParticleFilter, FramesWithoutPolesDoNotSpreadParticles) {
  FilterOptions options;
  options.extraSigma = options.extraSigmaYaw = 0;
  for (const double radius : {0.2, 0.4, 0.8, 1.6}) {
    PoleParticleFilter localizer(smallMap(), options, 1);
    StartOptions start = at({0, 0, 0}, radius, 0.1 * radius);
    start.particles = options.particles;
    localizer.start(start);
    const double before = localizer.step(emptyFrame(0)).covariance(0, 0);
    for (int i = 1; i <= 30; ++i) {
      const auto estimate = localizer.step(emptyFrame(i, PoseWithCovariance()));
      ASSERT_NEAR(estimate.covariance(0, 0), before, 0.01 * before) << radius;
      ASSERT_EQ(localizer.report().temperingStages, 0u) << radius;
    }
  }
}

TEST(PoleParticleFilter, BestShareIsTheMeanOfTheBest) {
  FilterOptions options = still();
  options.particles = 10;
  options.estimate = PoseEstimator::bestShare;
  options.bestShare = 0.2;
  PoleParticleFilter localizer(smallMap(), options, 1);
  localizer.start(at({0, 0, 0}, 0, 0));
  for (int i = 0; i < 10; ++i) {
    localizer.m_particles[i].d = {double(i), 0, 0};
    localizer.m_particles[i].log_w = i == 3 ? std::log(3.0) : i == 7 ? 0.0 : -1.0 - i;
  }
  EXPECT_NEAR(localizer.step(emptyFrame(0)).mean.x, 0.75 * 3 + 0.25 * 7, 1e-12);
}

TEST(PoleParticleFilter, TellsWhatAStepDid) {
  const PoleStreet street = makeStreet({});
  PoleParticleFilter localizer(street.map, {}, 1);
  localizer.start(at(street.truth[50], 2.5));
  localizer.step(street.frames[50]);
  EXPECT_EQ(localizer.report().poles, street.frames[50].poles_robot.size());
  EXPECT_GT(localizer.report().temperingStages, 0);
  EXPECT_GT(localizer.report().effectiveShare, 0);
  EXPECT_EQ(localizer.report().resampled, localizer.report().effectiveShare < 0.5);
}

TEST(PoleParticleFilter, PolesCountByWhatIsNew) {
  const PoleStreet street = makeStreet({});
  const auto weights = [&](double farOutlier, const NewShares& shares) {
    auto map = std::make_shared<CPoleMap>(*street.map);
    map->likelihoodOptions.farOutlier = farOutlier;
    FilterOptions options = still();
    options.tempering = 0;
    PoleParticleFilter localizer(map, options, 1);
    localizer.start(at(street.truth[50], 2.5));
    localizer.step(street.frames[50], shares);
    return localizer.logWeights();
  };
  EXPECT_EQ(weights(0.25, {0, 1}), weights(1, {1, 1}));
  EXPECT_EQ(weights(0.25, {0.5, 1}), weights(0.5, {1, 1}));
  EXPECT_NE(weights(0.25, {1, 1}), weights(0.5, {1, 1}));
  const std::vector<double> all = weights(1, {1, 1}), half = weights(1, {1, 0.5});
  for (std::size_t i = 1; i < all.size(); ++i)
    EXPECT_NEAR(half[i] - half[0], (all[i] - all[0]) / 2, 1e-9);
}

// 10000 particles at the start, of which 1000 remain: a fifth of these is enough.
TEST(PoleParticleFilter, TemperingIsMeasuredByTheParticlesThatAreKept) {
  const PoleStreet street = makeStreet({});
  PoleParticleFilter localizer(street.map, {}, 1);
  StartOptions start = at(street.truth[50], 0.3, 0.02);
  start.particles = 10000;
  localizer.start(start);
  localizer.step(street.frames[50]);
  ASSERT_EQ(localizer.report().particles, 10000u);
  EXPECT_EQ(localizer.report().temperingStages, 0);
  EXPECT_GT(localizer.report().effectiveShare, 0.02);
  EXPECT_LT(localizer.report().effectiveShare, 0.2) << "or it is no test";
}

TEST(PoleParticleFilter, AdaptsTheNumberOfParticles) {
  for (const auto resampling : {Resampling::systematic, Resampling::multinomial}) {
    const PoleStreet street = makeStreet({});
    FilterOptions options;
    options.adaptive = true;
    options.resampling = resampling;
    PoleParticleFilter localizer(street.map, options, 4);
    localizer.start(at(street.truth[0]));
    std::vector<std::size_t> counts;
    double error = 0;
    for (std::size_t i = 0; i < street.frames.size(); ++i) {
      const Pose2D estimate = localizer.step(street.frames[i]).mean;
      counts.push_back(localizer.particles().size());
      EXPECT_GE(counts.back(), 200u);
      EXPECT_LE(counts.back(), 10000u);
      if (i >= 20)
        error += std::hypot(estimate.x - street.truth[i].x, estimate.y - street.truth[i].y) /
                 (street.frames.size() - 20);
    }
    EXPECT_GT(counts[0], 1000u);  // the start disc
    EXPECT_LT(*std::max_element(counts.begin() + 50, counts.end()), 700u);
    EXPECT_LT(error, 0.03);
    // Several hypotheses need more than one.
    std::vector<PoseHypothesis> hypotheses(4);
    for (int i = 0; i < 4; ++i) {
      hypotheses[i].pose.mean = compose(street.truth[50], {5.0 * i, 0, 0});
      hypotheses[i].pose.covariance = Eigen::Vector3d(0.04, 0.04, 1e-4).asDiagonal();
    }
    const auto resampledFrom = [&](const std::vector<PoseHypothesis>& from) {
      localizer.start(from, 4000);
      localizer.performResampling(mrpt::bayes::CParticleFilter::TParticleFilterOptions());
      return localizer.particles().size();
    };
    const std::size_t one = resampledFrom({hypotheses[0]}), four = resampledFrom(hypotheses);
    EXPECT_GT(four, 2 * one);
  }
}

TEST(PoleParticleFilter, RefusesAMapWithoutPoles) {
  EXPECT_THROW(PoleParticleFilter(nullptr, {}, 1), Error);
  EXPECT_THROW(PoleParticleFilter(std::make_shared<CPoleMap>(), {}, 1), Error);
}

TEST(PoleParticleFilter, RefusesOptionsOutOfRange) {
  FilterOptions options;
  options.particles = 0;
  EXPECT_THROW(PoleParticleFilter(smallMap(), options, 1), Error);
}

TEST(PoleParticleFilter, APoleWithAFaultIsRefused) {
  const PoleStreet street = makeStreet({});
  const auto map = std::make_shared<CPoleMap>(*street.map);
  map->likelihoodOptions.weighted = true;
  PoleParticleFilter localizer(map, {}, 1);
  StartOptions start;
  start.pose = street.truth[0];
  localizer.start(start);
  PoleScan frame = street.frames[0];
  frame.poles_robot[0].confidence = 2;
  EXPECT_REFUSED(localizer.step(frame),
                 "scan at 100.000000 s: pole 0 has a confidence outside [0, 1]");
}

/// MRPT would pass on its own exception, with a call stack of several lines.
TEST(PoleParticleFilter, ErrorsOfTheUpdateComeThroughMrpt) {
  const PoleStreet street = makeStreet({});
  const auto map = std::make_shared<CPoleMap>(*street.map);
  PoleParticleFilter localizer(map, {}, 1);
  localizer.start(at(street.truth[0]));
  map->likelihoodOptions.gate = -1;  // refused by the likelihood
  EXPECT_REFUSED(localizer.step(street.frames[0]), "gate_m");
}

TEST(PoleParticleFilter, RefusesToStepBeforeTheStart) {
  PoleParticleFilter localizer(smallMap(), {}, 1);
  EXPECT_THROW(localizer.step(emptyFrame(0)), Error);
}

TEST(PoleParticleFilter, RefusesAStartWithoutAPose) {
  PoleParticleFilter localizer(smallMap(), {}, 1);
  EXPECT_THROW(localizer.start(StartOptions()), Error);
  EXPECT_THROW(localizer.start(at({NAN, 0, 0})), Error);
  EXPECT_THROW(localizer.start(at({0, 0, 0}, -1)), Error);
}

TEST(PoleParticleFilter, RefusesBadFramesAndStaysAsItWas) {
  PoleParticleFilter localizer(smallMap(), {}, 1);
  localizer.start(at({0, 0, 0}));
  localizer.step(emptyFrame(5));
  const auto before = localizer.particles();
  std::vector<PoleScan> bad(5, emptyFrame(6));
  bad[0].time = 5;    // repeated
  bad[1].time = 4.5;  // backwards
  bad[2].time = NAN;
  bad[3].motion.reset();
  bad[4].motion->mean.x = NAN;
  for (const auto& frame : bad) EXPECT_THROW(localizer.step(frame), Error);
  const auto after = localizer.particles();
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(before[i].x, after[i].x);
  EXPECT_NO_THROW(localizer.step(emptyFrame(6)));
}

}  // namespace
}  // namespace polemcl::test_pole_particle_filter
