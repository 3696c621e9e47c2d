#include <gtest/gtest.h>

#include <cmath>

#include <polemcl/mrpt/map/CPoleMap.h>
#include "core/common/PoleIndex.h"
#include "support/Samples.h"

namespace polemcl::test_cpole_map_insertion {
namespace {
using mrpt::poses::CPose3D;

/// Two poles, at (2, 1) and (6, 0) of the robot.
CObservationPoles scanOfTwo() {
  CObservationPoles scan;
  scan.poles = {samples::pole(2, 1), samples::pole(6, 0)};
  return scan;
}

// Robot at (100, 50) looking left, sensor at (1, 2) rotated left. A point 5 m in front of the
// sensor is 7 m to the left of the robot and 1 m in front of it, at (100 - 7, 50 + 1).
TEST(CPoleMapInsertion, InsertsAtTheRobotPose) {
  CPoleMap map;
  CObservationPoles scan = samples::observation();
  scan.poles.resize(1);
  ASSERT_TRUE(map.insertObservation(scan, CPose3D(100, 50, 3, M_PI / 2, 0, 0)));
  ASSERT_EQ(map.poles().size(), 1u);
  const MapPole& p = map.poles()[0];
  EXPECT_NEAR(p.x, 93, 1e-12);
  EXPECT_NEAR(p.y, 51, 1e-12);
  EXPECT_NEAR(p.covariance(0, 0), 0.04, 1e-12);  // half a turn: unchanged
  EXPECT_NEAR(p.covariance(0, 1), 0.01, 1e-12);
  EXPECT_EQ(p.count, 1u);
  EXPECT_EQ(p.top, 4.5);
  EXPECT_TRUE(map.index().nearest(93, 51, 0.1));

  scan.poles[0].x += 0.4;  // merges: the map pole moves by half of it
  ASSERT_TRUE(map.insertObservation(scan, CPose3D(100, 50, 3, M_PI / 2, 0, 0)));
  ASSERT_EQ(map.poles().size(), 1u);
  EXPECT_NEAR(map.poles()[0].x, 92.8, 1e-12);
  EXPECT_EQ(map.poles()[0].count, 2u);

  map.insertionOptions.mergeDistance = 0.1;  // now a separate pole
  ASSERT_TRUE(map.insertObservation(scan, CPose3D(100, 50, 3, M_PI / 2, 0, 0)));
  EXPECT_EQ(map.poles().size(), 2u);
}

// A copy shares what is needed for inserting; neither changes the other.
TEST(CPoleMapInsertion, CopiesInsertIndependently) {
  const CObservationPoles scan = scanOfTwo();
  CPoleMap map;
  map.insertObservation(scan, CPose3D());
  CPoleMap copy = map;
  copy.insertObservation(scan, CPose3D(20, 0, 0));
  map.insertObservation(scan, CPose3D(0, 0.1, 0));
  ASSERT_EQ(map.poles().size(), 2u);
  EXPECT_NEAR(map.poles()[0].y, 1.05, 1e-12);
  ASSERT_EQ(copy.poles().size(), 4u);
  EXPECT_EQ(copy.poles()[0].y, 1);
  EXPECT_TRUE(copy.index().nearest(22, 1, 0.1));
  EXPECT_FALSE(map.index().nearest(22, 1, 0.1));
}

TEST(CPoleMapInsertion, RefusesToInsertWhatIsNoPlace) {
  CPoleMap map;
  CObservationPoles scan = scanOfTwo();
  map.insertObservation(scan, CPose3D());
  scan.poles[1].x = std::nan("");
  EXPECT_THROW(map.insertObservation(scan, CPose3D()), std::exception);
  EXPECT_EQ(map.poles()[0].count, 1u);
}

TEST(CPoleMapInsertion, InsertsOnlyWhatIsSureEnough) {
  CPoleMap map;
  map.insertionOptions.minConfidence = 0.8;
  EXPECT_FALSE(map.insertObservation(samples::observation()));
  EXPECT_TRUE(map.isEmpty());
  map.insertionOptions.minConfidence = 0.75;
  EXPECT_TRUE(map.insertObservation(samples::observation()));
  EXPECT_EQ(map.poles().size(), 2u);
}

}  // namespace
}  // namespace polemcl::test_cpole_map_insertion
