#include <gtest/gtest.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <cstring>

#include "mrpt/rawlog/MotionOptions.h"
#include "mrpt/rawlog/ScanSource.h"

namespace polemcl::test_motion_options {
namespace {

MotionOptions sample() {
  MotionOptions options;
  options.xyPerMetre = 0.1;
  options.xyPerRadian = 0.2;
  options.yawPerMetre = 0.01;
  options.yawPerRadian = 0.05;
  options.minXy = 0.001;
  options.minYaw = 0.002;
  options.covarianceFactor = 4;
  return options;
}

TEST(MotionOptions, CovarianceByHand) {
  // d = 5, |yaw| = 0.5: σ_xy = 0.001 + 0.5 + 0.1 = 0.601, σ_yaw = 0.002 + 0.05 + 0.025 = 0.077.
  const Eigen::Matrix3d C = motionCovariance({3, -4, -0.5}, sample());
  EXPECT_NEAR(C(0, 0), 4 * 0.601 * 0.601, 1e-12);
  EXPECT_NEAR(C(1, 1), 4 * 0.601 * 0.601, 1e-12);
  EXPECT_NEAR(C(2, 2), 4 * 0.077 * 0.077, 1e-12);
  EXPECT_EQ(C(0, 1), 0);
  EXPECT_EQ(C(0, 2), 0);
  EXPECT_EQ(C(1, 2), 0);
}

TEST(MotionOptions, StandingStillKeepsTheFloor) {
  const Eigen::Matrix3d C = motionCovariance({}, sample());
  EXPECT_NEAR(C(0, 0), 4e-6, 1e-15);
  EXPECT_NEAR(C(2, 2), 16e-6, 1e-15);
}

// A damaged rawlog may name a method that does not exist: the change of the pose counts.
TEST(MotionOptions, MethodsThatNobodyKnows) {
  mrpt::obs::CActionRobotMovement2D move;
  auto change = mrpt::poses::CPosePDFGaussian::Create();
  change->mean = mrpt::poses::CPose2D(1, 2, 0.5);
  move.poseChange = change;
  move.rawOdometryIncrementReading = mrpt::poses::CPose2D(7, 8, 0.9);
  const std::uint32_t method = 0x10000;
  std::memcpy(&move.estimationMethod, &method, sizeof method);
  mrpt::obs::CActionCollection actions;
  actions.insert(move);
  const auto motion = motionOf(actions, sample());
  ASSERT_TRUE(motion);
  EXPECT_EQ(motion->mean.x, 1);
}

}  // namespace
}  // namespace polemcl::test_motion_options
