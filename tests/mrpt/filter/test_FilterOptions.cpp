#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "config/Config.h"
#include "core/common/Binder.h"
#include "mrpt/filter/FilterOptions.h"

namespace polemcl::test_filter_options {

using namespace polemcl;

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

std::string written(All all) {
  ConfigWriter writer;
  bindAll(writer, all);
  return writer.text();
}

All load(const std::string& text) {
  All all;
  ConfigReader reader(ConfigFile::fromText(text, "t.ini"));
  bindAll(reader, all);
  reader.finish();
  return all;
}

/// The error message of `action`; empty if it throws none.
std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

template <class Options, class Field>
std::string refusalOf(Field Options::*field, Field value) {
  Options options;
  options.*field = value;
  return refusal([&] { checkOptions(options); });
}

}  // namespace

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

TEST(FilterOptions, WhatIsWrittenReadsBackTheSame) {
  All all;
  EXPECT_EQ(written(load(written(all))), written(all));
  EXPECT_FALSE(load(written(all)).start.pose);
  all.start.pose = Pose2D{1.0 / 3, -2e5 / 7, 2.123456789012345};
  all.filter.extraSigmaYaw = 0.00123456789;
  all.filter.resampling = Resampling::multinomial;
  const All back = load(written(all));
  EXPECT_EQ(back.start.pose->x, all.start.pose->x);
  EXPECT_EQ(back.start.pose->y, all.start.pose->y);
  EXPECT_EQ(back.start.pose->yaw, all.start.pose->yaw);
  EXPECT_EQ(back.filter.extraSigmaYaw, all.filter.extraSigmaYaw);
  EXPECT_EQ(back.filter.resampling, Resampling::multinomial);
}

TEST(FilterOptions, YawIsWrapped) {
  EXPECT_NEAR(load("[start]\nposition_m = 0 0\nyaw_deg = 270\n").start.pose->yaw, -M_PI / 2, 1e-12);
}

TEST(FilterOptions, RefusalsNameFileSectionAndWhatIsAllowed) {
  const auto half = refusal([] { load("[start]\nposition_m = 1\n"); });
  EXPECT_NE(half.find("t.ini"), std::string::npos) << half;
  EXPECT_NE(half.find("[start] position_m = 1: allowed is two numbers"), std::string::npos) << half;
  const auto word = refusal([] { load("[filter]\nestimate = median\n"); });
  EXPECT_NE(word.find("best_share"), std::string::npos) << word;
  const auto low = refusal([] { load("[filter]\nresample_below = 0.1\ntempering = 0.2\n"); });
  EXPECT_NE(low.find("[filter] tempering = 0.2: allowed is resample_below or less"),
            std::string::npos)
      << low;
  const auto key = refusal([] { load("[filter]\nparticle = 10\n"); });
  EXPECT_NE(key.find("particle"), std::string::npos) << key;
}

TEST(FilterOptions, ValidateRefusesEachFieldOutOfRange) {
  EXPECT_EQ(refusal([] { checkOptions(FilterOptions()); }), "");
  EXPECT_NE(refusalOf(&FilterOptions::particles, 0), "");
  EXPECT_NE(refusalOf(&FilterOptions::particles, 1000001), "");
  for (double bad : {-0.1, 1.1, double(NAN)}) {
    EXPECT_NE(refusalOf(&FilterOptions::resampleBelow, bad), "");
    EXPECT_NE(refusalOf(&FilterOptions::bestShare, bad), "");
    EXPECT_NE(refusalOf(&FilterOptions::regularization, bad), "");
    EXPECT_NE(refusalOf(&FilterOptions::tempering, bad), "");
  }
  EXPECT_NE(refusalOf(&FilterOptions::bestShare, 0.0), "");
  EXPECT_NE(refusalOf(&FilterOptions::regularization, 0.0), "");  // tempering needs it
  for (double bad : {-0.1, 11.0, double(NAN)}) {
    EXPECT_NE(refusalOf(&FilterOptions::extraSigma, bad), "");
    EXPECT_NE(refusalOf(&FilterOptions::extraSigmaYaw, bad), "");
  }
}

TEST(FilterOptions, ReadsAdaptiveSampling) {
  const All all = load("[filter]\nadaptive = true\nmin_particles = 50\nmax_particles = 3000\n");
  EXPECT_TRUE(all.filter.adaptive);
  EXPECT_EQ(all.filter.kld.minParticles, 50);
  EXPECT_EQ(all.filter.kld.maxParticles, 3000);
  const auto never =
      refusal([] { load("[filter]\nadaptive = true\nresample_below = 0\ntempering = 0\n"); });
  EXPECT_NE(never.find("[filter] adaptive = true: allowed is false where resample_below = 0"),
            std::string::npos)
      << never;
  const auto crossed = refusal([] { load("[filter]\nmin_particles = 20000\n"); });
  EXPECT_NE(crossed.find("[filter] min_particles = 20000: allowed is max_particles or less"),
            std::string::npos)
      << crossed;
}

TEST(FilterOptions, ValidateRefusesBadStartsAndRuns) {
  EXPECT_EQ(refusal([] { checkOptions(StartOptions()); }), "");
  EXPECT_NE(refusalOf(&StartOptions::radius, -1.0), "");
  EXPECT_NE(refusalOf(&StartOptions::radius, double(INFINITY)), "");
  EXPECT_NE(refusalOf(&StartOptions::radius, 10001.0), "");
  EXPECT_NE(refusalOf(&StartOptions::heading, 3.2), "");
  EXPECT_NE(refusalOf(&StartOptions::heading, double(NAN)), "");
  EXPECT_NE(refusalOf(&StartOptions::particles, 0), "");
  EXPECT_NE(refusalOf(&StartOptions::pose, std::optional<Pose2D>(Pose2D{0, NAN, 0})), "");
  EXPECT_EQ(refusal([] { checkOptions(RunOptions()); }), "");
  EXPECT_NE(refusalOf(&RunOptions::runs, 0), "");
  EXPECT_NE(refusalOf(&RunOptions::seed, UINT32_MAX), "");
}

}  // namespace polemcl::test_filter_options
