#include "io/dataset/ScanPoses.h"
#include "support/IoFiles.h"

namespace polemcl::test_scan_poses {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;

/// Scans at 10, 11, 12, … s, each one metre ahead of the previous one.
ScanFolder line(std::size_t scans) {
  ScanFolder folder;
  for (std::size_t i = 0; i < scans; ++i) {
    ScanEntry entry;
    entry.time = 10 + static_cast<double>(i);
    if (i > 0) entry.motion = PoseWithCovariance{{1, 0, 0}, Eigen::Matrix3d::Identity()};
    folder.scans.push_back(entry);
  }
  return folder;
}

Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();

class ScanPosesTest : public FolderTest {};

TEST_F(ScanPosesTest, MotionsOfScansThatAreLeftOutGoIntoTheNext) {
  ScanFolder folder = line(6);
  keepScans(folder, {false, true, false, false, true, false}, "as asked");
  ASSERT_EQ(folder.scans.size(), 2u);
  EXPECT_EQ(folder.scans[0].time, 11);
  EXPECT_FALSE(folder.scans[0].motion);
  EXPECT_EQ(folder.scans[1].time, 14);
  EXPECT_NEAR(folder.scans[1].motion->mean.x, 3, 1e-12);
  // Computed by hand: x errors add up; a heading error of 1 rad at the first metre moves the end by
  // 2 m.
  EXPECT_NEAR(folder.scans[1].motion->covariance(0, 0), 3, 1e-12);
  EXPECT_NEAR(folder.scans[1].motion->covariance(1, 1), 3 + 4 + 1, 1e-12);
  ASSERT_EQ(folder.notes.size(), 1u);
  EXPECT_EQ(folder.notes[0], "4 of 6 scans left out, as asked");
}

TEST_F(ScanPosesTest, AllScansStayWithoutANote) {
  ScanFolder folder = line(3);
  keepScans(folder, {true, true, true}, "");
  EXPECT_EQ(folder.scans.size(), 3u);
  EXPECT_NEAR(folder.scans[2].motion->mean.x, 1, 1e-12);
  EXPECT_TRUE(folder.notes.empty());
}

TEST_F(ScanPosesTest, TakesPosesOfTheRobotAtTheTimesOfTheScans) {
  ScanFolder folder = line(4);
  takeTumPoses(folder,
               write("p.tum",
                     "10.5 5 0 0 0 0 0 1\n11.25 6.5 2 0 0 0 0 1\n"
                     "12 8 4 1 0 0 0 1\n"),
               identity);
  ASSERT_EQ(folder.scans.size(), 2u);  // 10 and 13 are outside
  EXPECT_TRUE(
      folder.scans[0].T_map_robot->translation().isApprox(Eigen::Vector3d(6, 4.0 / 3, 0), 1e-9));
  EXPECT_TRUE(folder.scans[1].T_map_robot->translation().isApprox(Eigen::Vector3d(8, 4, 1), 1e-9));
  expectIn(folder.notes.at(0), "2 of 4 scans left out", "p.tum");
}

TEST_F(ScanPosesTest, TakesPosesOfTheSensor) {
  ScanFolder folder = line(1);
  Eigen::Isometry3d T_robot_sensor = identity;  // 2 m in front, looking left
  T_robot_sensor.translate(Eigen::Vector3d(2, 0, 0))
      .rotate(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  // The sensor at (5, 7), looking along y of the map: the robot looks along x.
  takeTumPoses(folder, write("p.tum", "10 5 7 0 0 0 0.7071067811865476 0.7071067811865476\n"),
               T_robot_sensor.inverse());
  EXPECT_TRUE(folder.scans[0].T_map_robot->translation().isApprox(Eigen::Vector3d(3, 7, 0), 1e-9));
  EXPECT_TRUE(folder.scans[0].T_map_robot->linear().isIdentity(1e-9));
}

TEST_F(ScanPosesTest, ScansWithoutTimesTakeThoseOfTheRows) {
  ScanFolder folder = line(2);
  folder.nominalTimes = true;
  const fs::path file = write("p.tum", "1e9 1 0 0 0 0 0 1\n1000000001.5 2 0 0 0 0 0 1\n");
  takeTumPoses(folder, file, identity);
  ASSERT_EQ(folder.scans.size(), 2u);
  EXPECT_EQ(folder.scans[1].time, 1000000001.5);
  EXPECT_EQ(folder.scans[1].T_map_robot->translation().x(), 2);
  folder = line(3);
  folder.nominalTimes = true;
  EXPECT_REFUSED(takeTumPoses(folder, file, identity), "p.tum", "2 poses for 3 scans", "times.txt");
}

TEST_F(ScanPosesTest, TakesMotionsFromAnOdometryOfTheSensor) {
  ScanFolder folder = line(5);
  Eigen::Isometry3d T_robot_sensor = identity;  // 2 m in front, looking left
  T_robot_sensor.translate(Eigen::Vector3d(2, 0, 0))
      .rotate(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  // The sensor looks along y at first, so the robot along x; none at 10 and 12 s, for a gap.
  const fs::path file = write("o.tum",
                              "10.5 5 7 0 0 0 0.7071067811865476 0.7071067811865476\n"
                              "11 5.5 7 0 0 0 0.7071067811865476 0.7071067811865476\n"
                              "12.9 8 7 0 0 0 0.7071067811865476 0.7071067811865476\n"
                              "13.1 8 7 0 0 0 0.7071067811865476 0.7071067811865476\n"
                              "14 9 9 0 0 0 1 0\n");
  takeTumMotions(folder, file, T_robot_sensor.inverse());
  ASSERT_EQ(folder.scans.size(), 3u);
  EXPECT_EQ(folder.scans[0].time, 11);
  EXPECT_FALSE(folder.scans[0].motion);
  const PoseWithCovariance& ahead = *folder.scans[1].motion;
  EXPECT_NEAR(ahead.mean.x, 2.5, 1e-9);
  EXPECT_NEAR(ahead.mean.y, 0, 1e-9);
  EXPECT_NEAR(ahead.mean.yaw, 0, 1e-9);
  EXPECT_NEAR(ahead.covariance(0, 0), 0.05 * 0.05 + 1e-6, 1e-9);
  // The robot turns by 90 degrees round the sensor's new place: it ends 2 m below (9, 9).
  const PoseWithCovariance& turn = *folder.scans[2].motion;
  EXPECT_NEAR(turn.mean.x, 9 - 6, 1e-9);
  EXPECT_NEAR(turn.mean.y, 9 - 2 - 7, 1e-9);
  EXPECT_NEAR(turn.mean.yaw, M_PI / 2, 1e-9);
  expectIn(folder.notes.at(0), "2 of 5 scans left out, at times without odometry in o.tum");

  ScanFolder paired = line(5);
  paired.nominalTimes = true;
  takeTumMotions(paired, file, identity);
  EXPECT_EQ(paired.scans[1].time, 11);
  EXPECT_NEAR(paired.scans[1].motion->mean.y, -0.5, 1e-9);
  ScanFolder late = line(2);
  EXPECT_REFUSED(takeTumMotions(late, write("l.tum", "20 1 0 0 0 0 0 1\n"), identity), "l.tum",
                 "no odometry at the time of any scan");
}

TEST_F(ScanPosesTest, RefusesAnOdometryInAnotherFrameThanAVehicles) {
  ScanFolder folder = line(4);
  EXPECT_REFUSED(takeTumMotions(folder,
                                write("camera.tum",
                                      "10 0 0 0 0 0 0 1\n11 0 0 1 0 0 0 1\n"
                                      "12 0 0 2 0 0 0 1\n13 0.1 0 3 0 0 0 1\n"),
                                identity),
                 "camera.tum: it moves 3.0 m along z and 0.1 m in x and y", "z up is expected");
}

// The odometry of a LiDAR on its head may begin with the LiDAR's own axes.
TEST_F(ScanPosesTest, TheFrameOfAnOdometryMayStandOnItsHead) {
  ScanFolder folder = line(3);
  takeTumMotions(folder, write("o.tum", "10 0 0 0 1 0 0 0\n11 1 0 0 1 0 0 0\n12 2 0 0 1 0 0 0\n"),
                 identity);
  EXPECT_NEAR(folder.scans[2].motion->mean.x, 1, 1e-9);
}

TEST_F(ScanPosesTest, RefusesTimesThatDoNotOverlap) {
  ScanFolder folder = line(3);
  const fs::path file = write("p.tum", "20 1 0 0 0 0 0 1\n21.5 2 0 0 0 0 0 1\n");
  EXPECT_REFUSED(takeTumPoses(folder, file, identity), "p.tum", "20.000 ... 21.500 s",
                 "10.000 ... 12.000 s");
}

}  // namespace
}  // namespace polemcl::test_scan_poses
