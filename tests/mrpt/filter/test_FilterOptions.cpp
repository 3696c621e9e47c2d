#include <gtest/gtest.h>

#include <cmath>

#include "config/Config.h"
#include "core/common/Binder.h"
#include "mrpt/filter/FilterOptions.h"

namespace polemcl::test_filter_options {
namespace {

struct All {
  FilterOptions filter;
  StartOptions start;
  RunOptions runs;
};

void bindAll(Binder& binder, All& all) {
  bind(binder, all.filter);
  bind(binder, all.start);
  bind(binder, all.runs);
}

All load(const std::string& text) {
  All all;
  ConfigReader reader(ConfigFile::fromText(text, "t.ini"));
  bindAll(reader, all);
  reader.finish();
  return all;
}

TEST(FilterOptions, EveryFieldIsReadFromItsKey) {
  const All all = load(
      "[filter]\nparticles = 300\nresample_below = 0.4\nresampling = stratified\n"
      "estimate = best_share\nbest_share = 0.2\nregularization = 0.3\ntempering = 0.1\n"
      "extra_sigma_m = 0.03\nextra_sigma_deg = 0.5\n"
      "[start]\nposition_m = 10.5 -3\nyaw_deg = 90\nradius_m = 4\nheading_deg = 10\n"
      "particles = 5000\n[runs]\nruns = 10\nseed = 4000000000\n");
  EXPECT_EQ(all.filter.particles, 300);
  EXPECT_EQ(all.filter.resampleBelow, 0.4);
  EXPECT_EQ(all.filter.resampling, Resampling::stratified);
  EXPECT_EQ(all.filter.estimate, PoseEstimator::bestShare);
  EXPECT_EQ(all.filter.bestShare, 0.2);
  EXPECT_EQ(all.filter.regularization, 0.3);
  EXPECT_EQ(all.filter.tempering, 0.1);
  EXPECT_EQ(all.filter.extraSigma, 0.03);
  EXPECT_NEAR(all.filter.extraSigmaYaw, 0.5 * M_PI / 180, 1e-15);
  ASSERT_TRUE(all.start.pose);
  EXPECT_EQ(all.start.pose->x, 10.5);
  EXPECT_EQ(all.start.pose->y, -3);
  EXPECT_NEAR(all.start.pose->yaw, M_PI / 2, 1e-15);
  EXPECT_EQ(all.start.radius, 4);
  EXPECT_NEAR(all.start.heading, 10 * M_PI / 180, 1e-15);
  EXPECT_EQ(all.start.particles, 5000);
  EXPECT_EQ(all.runs.runs, 10);
  EXPECT_EQ(all.runs.seed, 4000000000u);
}

TEST(FilterOptions, YawIsWrapped) {
  EXPECT_NEAR(load("[start]\nposition_m = 0 0\nyaw_deg = 270\n").start.pose->yaw, -M_PI / 2, 1e-12);
}

TEST(FilterOptions, ReadsAdaptiveSampling) {
  const All all = load("[filter]\nadaptive = true\nmin_particles = 50\nmax_particles = 3000\n");
  EXPECT_TRUE(all.filter.adaptive);
  EXPECT_EQ(all.filter.kld.minParticles, 50);
  EXPECT_EQ(all.filter.kld.maxParticles, 3000);
}

}  // namespace
}  // namespace polemcl::test_filter_options
