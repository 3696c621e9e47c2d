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

}  // namespace polemcl::test_drive_fixes
