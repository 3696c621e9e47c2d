// Defects and random effects of MRPT's filter, compared with PoleParticleFilter. If the test of a
// defect (…OfMrpt) fails, MRPT has fixed it.
#include <gtest/gtest.h>
#include <mrpt/slam/CMonteCarloLocalization2D.h>

#include <cmath>
#include <thread>

#include "mrpt/filter/PoleParticleFilter.h"
#include "support/PoleStreet.h"

namespace polemcl::test_pole_particle_filter_mrpt {
namespace {

using mrpt::random::getRandomGenerator;
using tests::makeStreet;
using tests::PoleStreet;

FilterOptions withoutJitter() {
  FilterOptions options;
  options.particles = 100;
  options.tempering = options.regularization = 0;
  return options;
}

StartOptions atOrigin() {
  StartOptions start;
  start.pose = Pose2D{};
  return start;
}

/// Positions 0, 1, 2, … with weights of which only a few are significant.
template <class Filter>
void spread(Filter& filter) {
  for (std::size_t i = 0; i < filter.m_particles.size(); ++i) {
    filter.m_particles[i].d = {double(i), 0, 0};
    filter.m_particles[i].log_w = -0.1 * i;
  }
}

template <class Filter>
double largestWeightDifference(const Filter& filter) {
  double difference = 0;
  for (const auto& particle : filter.m_particles)
    difference = std::max(difference, std::abs(particle.log_w - filter.m_particles[0].log_w));
  return difference;
}

mrpt::bayes::CParticleFilter::TParticleFilterOptions systematic() {
  mrpt::bayes::CParticleFilter::TParticleFilterOptions options;
  options.resamplingMethod = mrpt::bayes::CParticleFilter::prSystematic;
  return options;
}

/// x decreases as the heading increases: correlation -1.
template <class Filter>
void leanLeft(Filter& filter) {
  for (std::size_t i = 0; i < filter.m_particles.size(); ++i) {
    const double t = (i + 0.5) / filter.m_particles.size() - 0.5;
    filter.m_particles[i].d = {t, 2 * t, -0.1 * t};
    filter.m_particles[i].log_w = 0;
  }
}

/// Bytes of all estimates of a drive.
std::vector<double> driveOnce(const PoleStreet& street, std::uint32_t seed, int particles = 333) {
  FilterOptions options;
  options.particles = particles;
  PoleParticleFilter localizer(street.map, options, seed);
  StartOptions start;
  start.pose = street.truth[0];
  localizer.start(start);
  std::vector<double> result;
  for (const auto& frame : street.frames) {
    const auto estimate = localizer.step(frame);
    result.insert(result.end(),
                  {estimate.mean.x, estimate.mean.y, estimate.mean.yaw, estimate.covariance(0, 2)});
  }
  return result;
}

TEST(PoleLocalizerMrpt, WeightsSurviveResamplingOfMrpt) {
  mrpt::slam::CMonteCarloLocalization2D stock(100);
  spread(stock);
  stock.performResampling(systematic());
  EXPECT_GT(largestWeightDifference(stock), 1);
}

TEST(PoleLocalizerMrpt, WeightsAreResetAfterResampling) {
  PoleParticleFilter localizer(makeStreet({}).map, withoutJitter(), 1);
  localizer.start(atOrigin());
  spread(localizer);
  localizer.performResampling(systematic());
  EXPECT_EQ(largestWeightDifference(localizer), 0);
  // Particle 0 had a share of 1 - exp(-0.1): 9.5 of 100 copies.
  const auto particles = localizer.particles();
  const auto copies = std::count_if(particles.begin(), particles.end(),
                                    [](const Pose2D& pose) { return pose.x == 0; });
  EXPECT_TRUE(copies == 9 || copies == 10) << copies;
  EXPECT_TRUE(localizer.report().resampled);
}

TEST(PoleLocalizerMrpt, FewerIndicesThanParticlesComeFromTheFrontInMrpt) {
  mrpt::slam::CMonteCarloLocalization2D stock(100);
  for (const auto method :
       {mrpt::bayes::CParticleFilter::prMultinomial, mrpt::bayes::CParticleFilter::prStratified,
        mrpt::bayes::CParticleFilter::prSystematic}) {
    std::vector<size_t> indices;
    stock.computeResampling(method, std::vector<double>(100, 0), indices, 20);
    EXPECT_LT(*std::max_element(indices.begin(), indices.end()), 60u);  // of 100 with equal weights
  }
}

TEST(PoleLocalizerMrpt, FewerParticlesAreDrawnFromAll) {
  for (const auto method :
       {Resampling::systematic, Resampling::stratified, Resampling::multinomial}) {
    FilterOptions options = withoutJitter();
    options.adaptive = true;
    options.resampling = method;
    PoleParticleFilter localizer(makeStreet({}).map, options, 1);
    localizer.start({PoseHypothesis{}}, 4000);
    for (std::size_t i = 0; i < 4000; ++i) localizer.m_particles[i].d = {1e-5 * i, 0, 0};
    localizer.performResampling(systematic());
    const auto kept = localizer.particles();
    ASSERT_LE(kept.size(), 400u);
    const auto estimate = weightedMean(kept, localizer.logWeights());
    const double sigma = 0.04 / std::sqrt(12);
    EXPECT_NEAR(estimate.mean.x, 0.02, 4 * sigma / std::sqrt(kept.size()));
    EXPECT_NEAR(std::sqrt(estimate.covariance(0, 0)) / sigma, 1, 0.2);
  }
}

TEST(PoleLocalizerMrpt, NormalizesAndCountsLikeMrpt) {
  mrpt::slam::CMonteCarloLocalization2D stock(100);
  PoleParticleFilter localizer(makeStreet({}).map, withoutJitter(), 1);
  localizer.start(atOrigin());
  localizer.m_particles.resize(100);
  spread(stock);
  spread(localizer);
  for (auto* filter : {&stock, static_cast<decltype(&stock)>(&localizer)})
    for (auto& particle : filter->m_particles) particle.log_w += 3;
  double expected = 0, got = 0;
  EXPECT_NEAR(localizer.normalizeWeights(&got) / stock.normalizeWeights(&expected), 1, 1e-12);
  EXPECT_EQ(got, expected);
  EXPECT_NEAR(localizer.ESS(), stock.ESS(), 1e-12);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(localizer.getW(i), stock.getW(i));
}

TEST(PoleLocalizerMrpt, ResamplesNowAndThenNotAlways) {
  const PoleStreet street = makeStreet({});
  PoleParticleFilter localizer(street.map, {}, 1);
  StartOptions start;
  start.pose = street.truth[0];
  localizer.start(start);
  int resampled = 0;
  for (const auto& frame : street.frames) {
    localizer.step(frame);
    resampled += localizer.report().resampled;
  }
  EXPECT_GT(resampled, 10);
  EXPECT_LT(resampled, static_cast<int>(street.frames.size()) * 6 / 10);
}

TEST(PoleLocalizerMrpt, CovarianceLosesTheSignOfHeadingErrorsInMrpt) {
  mrpt::slam::CMonteCarloLocalization2D stock(100);
  leanLeft(stock);
  const auto [covariance, mean] = stock.getCovarianceAndMean();
  EXPECT_NEAR(covariance(0, 1), 2.0 / 12, 1e-3);
  EXPECT_GT(covariance(0, 2), -1e-9);  // correct: -0.1/12
}

TEST(PoleLocalizerMrpt, CovarianceKeepsTheSignOfHeadingErrors) {
  PoleParticleFilter localizer(makeStreet({}).map, withoutJitter(), 1);
  localizer.start(atOrigin());
  leanLeft(localizer);
  PoleScan frame;
  const Eigen::Matrix3d covariance = localizer.step(frame).covariance;
  Eigen::Matrix3d expected;  // variance of a uniform number: 1/12
  expected << 1, 2, -0.1, 2, 4, -0.2, -0.1, -0.2, 0.01;
  EXPECT_LT((covariance - expected / 12).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(PoleLocalizerMrpt, SeedingLeavesASpareDeviateInMrpt) {
  auto& generator = getRandomGenerator();
  generator = mrpt::random::CRandomGenerator(7);
  generator.drawGaussian1D_normalized();
  generator.randomize(7);
  const double second = generator.drawGaussian1D_normalized();
  generator = mrpt::random::CRandomGenerator(7);
  EXPECT_NE(second, generator.drawGaussian1D_normalized());
}

TEST(PoleLocalizerMrpt, SameSeedSameBytesWhateverTheThreadDidBefore) {
  const PoleStreet street = makeStreet({});
  const auto first = driveOnce(street, 11);
  getRandomGenerator().drawGaussian1D_normalized();  // odd number of normal deviates in between
  EXPECT_EQ(driveOnce(street, 11), first);
  std::vector<double> elsewhere;
  std::thread([&] { elsewhere = driveOnce(street, 11); }).join();
  EXPECT_EQ(elsewhere, first);
  EXPECT_NE(driveOnce(street, 12), first);
}

TEST(PoleLocalizerMrpt, LeavesTheGeneratorOfTheThreadAlone) {
  const PoleStreet street = makeStreet({});
  getRandomGenerator() = mrpt::random::CRandomGenerator(5);
  const auto expected = getRandomGenerator().drawUniform32bit();
  getRandomGenerator() = mrpt::random::CRandomGenerator(5);
  driveOnce(street, 1);
  EXPECT_EQ(getRandomGenerator().drawUniform32bit(), expected);
}

TEST(PoleLocalizerMrpt, FiltersSideBySideDoNotDisturbEachOther) {
  const PoleStreet street = makeStreet({});
  FilterOptions options;
  options.particles = 51;
  StartOptions start;
  start.pose = street.truth[0];
  const auto run = [&](bool interleaved) {
    PoleParticleFilter one(street.map, options, 3), other(street.map, options, 4);
    one.start(start);
    if (interleaved) other.start(start);
    std::vector<double> result;
    for (const auto& frame : street.frames) {
      result.push_back(one.step(frame).mean.x);
      if (interleaved) other.step(frame);
    }
    return result;
  };
  EXPECT_EQ(run(true), run(false));
}

TEST(PoleLocalizerMrpt, JitterFollowsTheSpread) {
  FilterOptions options;
  options.particles = 20000;
  options.tempering = 0;
  options.regularization = 0.5;
  PoleParticleFilter localizer(makeStreet({}).map, options, 1);
  localizer.start(atOrigin());
  for (std::size_t i = 0; i < localizer.m_particles.size(); ++i) {
    const double t = (i % 1000 + 0.5) / 1000 - 0.5;
    localizer.m_particles[i].d = {t, 0, 0.02 * t};
    localizer.m_particles[i].log_w = 0;
  }
  localizer.performResampling(systematic());
  const auto covariance = weightedMean(localizer.particles(), localizer.logWeights()).covariance;
  // Variances grow by the square of the share; x and heading stay on one line, y stays 0.
  EXPECT_NEAR(covariance(0, 0), 1.25 / 12, 0.002);
  EXPECT_NEAR(covariance(0, 2), 1.25 / 12 * 0.02, 0.00005);
  EXPECT_NEAR(covariance(1, 1), 0, 1e-12);
}

TEST(PoleLocalizerMrpt, JitterKeepsPlacesApart) {
  FilterOptions options;
  options.particles = 2000;
  options.tempering = 0;
  options.regularization = 0.5;
  PoleParticleFilter localizer(makeStreet({}).map, options, 1);
  localizer.start(atOrigin());
  for (std::size_t i = 0; i < localizer.m_particles.size(); ++i)
    localizer.m_particles[i].d = {i % 2 ? 30.0 : -30.0, 0, i % 2 ? 1.5 : -1.5};
  localizer.performResampling(systematic());
  double farthest = 0, turned = 0;
  for (const auto& pose : localizer.particles()) {
    farthest = std::max(farthest, std::abs(std::abs(pose.x) - 30));
    turned = std::max(turned, std::abs(std::abs(pose.yaw) - 1.5));
  }
  EXPECT_GT(farthest, 0);
  EXPECT_LT(farthest, 5 * PoleParticleFilter::maxJitterMetres);
  EXPECT_LT(turned, 5 * PoleParticleFilter::maxJitterRadians);
}

TEST(PoleLocalizerMrpt, TemperingSettlesSooner) {
  const PoleStreet street = makeStreet({});
  const auto meanError = [&](double tempering) {
    double sum = 0;
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
      const std::size_t first = 20 + 5 * seed;
      FilterOptions options;
      options.tempering = tempering;
      PoleParticleFilter localizer(street.map, options, seed);
      StartOptions start;
      start.pose = compose(street.truth[first], {0.8, -0.5, 0.03});
      start.particles = 1;  // as many as the filter has
      localizer.start(start);
      for (std::size_t i = first; i < first + 4; ++i) {
        const Pose2D error = relative(street.truth[i], localizer.step(street.frames[i]).mean);
        if (i >= first + 2) sum += std::hypot(error.x, error.y);
      }
    }
    return sum / 40;
  };
  const double tempered = meanError(0.2), atOnce = meanError(0);
  EXPECT_LT(tempered, 0.06);
  EXPECT_GT(atOnce, 1.4 * tempered);
}

TEST(PoleLocalizerMrpt, TemperingKeepsThePosterior) {
  const PoleStreet street = makeStreet({});
  const auto posterior = [&](double tempering) {
    FilterOptions options;
    options.particles = 60000;
    options.tempering = tempering;
    PoleParticleFilter localizer(street.map, options, 1);
    StartOptions start;
    start.pose = compose(street.truth[50], {0.1, -0.1, 0.002});
    start.radius = 0.4;
    start.heading = 0.02;
    localizer.start(start);
    const PoseWithCovariance result = localizer.step(street.frames[50]);
    EXPECT_EQ(localizer.report().temperingStages > 0, tempering > 0);
    return result;
  };
  const PoseWithCovariance atOnce = posterior(0), tempered = posterior(0.2);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(tempered.covariance(i, i) / atOnce.covariance(i, i), 1, 0.08) << i;
  const double sigma = std::sqrt(atOnce.covariance(0, 0));
  EXPECT_NEAR(tempered.mean.x, atOnce.mean.x, 0.1 * sigma);
  EXPECT_NEAR(tempered.mean.y, atOnce.mean.y, 0.1 * sigma);
}

}  // namespace
}  // namespace polemcl::test_pole_particle_filter_mrpt
