#include <gtest/gtest.h>

#include <cmath>

#include "core/slam/DriveFixes.h"

namespace polemcl::test_drive_fixes {

// Two drives of a minute, ten fixes a second.
TEST(DriveFixes, TheLastingErrorIsAnotherUnknownEveryTenSeconds) {
  std::vector<DriveFix> fixes;
  for (std::size_t scan = 0; scan < 2; ++scan)
    for (int i = 0; i < 600; ++i) {
      DriveFix fix;
      fix.time = 1.7e9 + 1000 * static_cast<double>(scan) + i / 10.0;
      fix.scan = scan;
      fix.sigma = 1.5;
      fixes.push_back(fix);
    }
  const FixFactors factors = fixFactors(fixes, {0, 1});
  ASSERT_EQ(factors.errors.size(), 12u);
  for (std::size_t k = 0; k < 12; ++k) {
    EXPECT_DOUBLE_EQ(factors.errors[k].sigma, 3) << "twice what the receiver states";
    // It falls by e in 200 s; a drive begins anew.
    EXPECT_NEAR(factors.errors[k].correlation, k % 6 == 0 ? 0 : std::exp(-0.05), 1e-6) << k;
  }
  ASSERT_EQ(factors.fixes.size(), fixes.size());
  for (std::size_t i = 0; i < fixes.size(); ++i) EXPECT_EQ(factors.fixes[i].error, i / 100) << i;
}

/// Two drives along x at 1 m/s, a scan each second; the antenna is 1 m ahead.
TEST(DriveFixes, HowTheyFitIsMeasuredDriveByDrive) {
  AdjustedState state;
  std::vector<std::size_t> drives;
  for (int i = 0; i < 20; ++i) {
    state.poses.push_back({i % 10 * 1.0, 0, 0});
    drives.push_back(i / 10);
  }
  state.antennas = {{1, 0}, {1, 0}};
  state.fixErrors = {{0, 0}, {0, 2}};
  FixFactors gnss;
  const auto add = [&](std::size_t scan, double x, double y, std::size_t error) {
    gnss.fixes.push_back({scan, 0.5, {x, y}, 0.5, error});
  };
  for (std::size_t i = 0; i < 5; ++i) add(i, static_cast<double>(i) + 1.5, 0.3, 0);
  add(5, 6.5, 1.49, 0);
  add(6, 7.5, 1.51, 0);  // beyond three sigmas
  add(7, 108.5, 0, 0);
  for (std::size_t i = 10; i < 13; ++i) add(i, static_cast<double>(i) - 8.5, 2, 1);
  const std::vector<FixFit> fits = fixFits(gnss, state, drives);
  ASSERT_EQ(fits.size(), 2u);
  EXPECT_EQ(fits[0].given, 8u);
  EXPECT_EQ(fits[0].fitting, 6u);
  EXPECT_NEAR(fits[0].distance, 0.3, 1e-9);
  EXPECT_EQ(fits[1].fitting, 3u) << "with their lasting error they fit";
  EXPECT_NEAR(fits[1].distance, 2, 1e-9);
  EXPECT_EQ(fixFits({}, state, drives)[0].given, 0u);
}

TEST(DriveFixes, WhereManyDoNotFitTheirSigmasGrowToTheirDistance) {
  FixFactors gnss;
  for (std::size_t scan = 0; scan < 3; ++scan) {
    gnss.fixes.push_back({scan, 0.5, {0, 0}, 0.02, scan});
    gnss.errors.push_back({0.04, 0});
  }
  gnss.fixes.push_back({1, 0.5, {0, 0}, 5, 1});
  const FixFit fitting{10, 7, 1}, doubtful{10, 6, 1};
  EXPECT_FALSE(FixFit().isDoubtful());
  EXPECT_FALSE(fitting.isDoubtful());
  EXPECT_TRUE(doubtful.isDoubtful());
  const FixFactors wide = widened(gnss, {fitting, doubtful, fitting}, {0, 1, 2});
  for (const std::size_t i : {0, 2}) {
    EXPECT_EQ(wide.fixes[i].sigma, 0.02);
    EXPECT_EQ(wide.errors[i].sigma, 0.04);
  }
  EXPECT_EQ(wide.fixes[1].sigma, 1);
  EXPECT_EQ(wide.errors[1].sigma, 2) << "twice, as usual";
  EXPECT_EQ(wide.fixes[3].sigma, 5) << "the receiver said so";
}

}  // namespace polemcl::test_drive_fixes
