#include <gtest/gtest.h>

#include "cli/RunRecords.h"
#include "support/Refusal.h"
#include "support/TempFolder.h"

namespace polemcl::test_run_records {

using namespace polemcl::apps;
using namespace testing_apps;

TEST(RunRecords, ReadsWhatItWrites) {
  const TempFolder folder;
  PoseWithCovariance estimate{{1, 2, 0.5}, Eigen::Matrix3d::Identity()};
  estimate.covariance(1, 2) = estimate.covariance(2, 1) = 0.25;
  writeText(folder / "cov.csv", kEstimateColumns + estimateRow(7, 100.5, estimate));
  const auto rows = readEstimates(folder / "cov.csv");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].scan, 7);
  EXPECT_EQ(rows[0].time, 100.5);
  EXPECT_EQ(rows[0].estimate.mean.yaw, 0.5);
  EXPECT_EQ(rows[0].estimate.covariance, estimate.covariance);
}

// Eigen ends a debug build if an exception leaves a matrix half filled.
TEST(RunRecords, RefusesACovarianceThatIsNoNumber) {
  const TempFolder folder;
  writeText(folder / "cov.csv", std::string(kEstimateColumns) + "0,1,2,3,0,1,0,no,1,0,1\n");
  EXPECT_REFUSED(readEstimates(folder / "cov.csv"), "cov.csv:2", "is not a finite number");
}

}  // namespace polemcl::test_run_records
