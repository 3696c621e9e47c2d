#include <gtest/gtest.h>

#include <cmath>

#include "mrpt/observation/ScanFusion.h"
#include "support/Samples.h"

namespace polemcl::test_scan_fusion {
namespace {

CObservationPoles::Ptr part(double time, const mrpt::poses::CPose3D& pose,
                            const std::vector<PoleDetection>& poles) {
  auto scan = std::make_shared<CObservationPoles>();
  scan->timestamp = mrpt::Clock::fromDouble(time);
  scan->sensorPose = pose;
  scan->poles = poles;
  scan->points = 100;
  return scan;
}

/// Two LiDARs, one in front and turned, one at the back: the same pole at (8, 3) of the robot.
TEST(ScanFusion, PolesOfTwoLidarsAreInTheRobotFrameOnce) {
  const auto front = part(100, {2, 0, 1, M_PI / 2, 0, 0}, {samples::pole(3, -6)});
  const auto rear = part(99.95, {-1, 0, 2, 0, 0, 0}, {samples::pole(9, 3), samples::pole(-6, 1)});
  const auto fused = fuseScans({front, rear}, 100, {});
  const CObservationPoles& scan = *fused.observation;
  EXPECT_EQ(scan.sensorLabel, "fused");
  EXPECT_EQ(mrpt::Clock::toDouble(scan.timestamp), 100);
  EXPECT_EQ(scan.sensorPose, mrpt::poses::CPose3D());
  EXPECT_EQ(scan.points, 200u);
  ASSERT_EQ(scan.poles.size(), 2u);
  EXPECT_NEAR(scan.poles[0].x, 8, 1e-6);
  EXPECT_NEAR(scan.poles[0].y, 3, 1e-6);
  EXPECT_NEAR(scan.poles[1].x, -7, 1e-6);
  EXPECT_NEAR(scan.poles[1].timeOffset, -0.05, 1e-6) << "from the stamp of the fused scan";
  ASSERT_EQ(fused.agreements.size(), 2u);
  EXPECT_EQ(fused.agreements[1].poles, 1u);
}

/// One LiDAR sees 20 m to its left only, the other 10 m to its right only.
TEST(ScanFusion, ADirectionIsSeenAsFarAsOneOfTheLidarsSees) {
  const auto left = part(1, {}, {}), right = part(1, {0, -2, 0, 0, 0, 0}, {});
  left->visibilityRange.assign(256, 0);
  right->visibilityRange.assign(256, 0);
  for (std::size_t i = 0; i < 128; ++i) {
    right->visibilityRange[i] = 10;  // azimuths below 0
    left->visibilityRange[128 + i] = 20;
  }
  const auto fused = fusedVisibility({left, right});
  ASSERT_EQ(fused.size(), 256u);
  EXPECT_EQ(fused[192], 20) << "to the left";
  EXPECT_EQ(fused[64], 0) << "to the right: the first 2 m are not seen by the right one";
  EXPECT_TRUE(fusedVisibility({part(1, {}, {})}).empty());
  left->visibilityRange.assign(256, 5);
  EXPECT_EQ(fusedVisibility({left, right})[64], 5);
}

// Such ranges can only come from a damaged rawlog; the search along a ray never ended.
TEST(ScanFusion, EndsOnRangesWithoutEnd) {
  const auto damaged = part(1, {}, {});
  damaged->visibilityRange.assign(4, INFINITY);
  EXPECT_EQ(fusedVisibility({damaged})[0], 1000);
}

TEST(ScanFusion, VisibilityIsAroundTheRobot) {
  const auto ahead = part(1, {4, 0, 0, M_PI, 0, 0}, {});
  ahead->visibilityRange.assign(256, 10);
  const auto fused = fusedVisibility({ahead});
  EXPECT_NEAR(fused[128], 14, 0.5) << "forwards";
  EXPECT_NEAR(fused[0], 6, 0.5) << "backwards";
}

}  // namespace
}  // namespace polemcl::test_scan_fusion
