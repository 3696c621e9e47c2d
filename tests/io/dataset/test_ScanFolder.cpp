#include <cmath>

#include "io/data/Trajectory.h"
#include "io/dataset/ScanFolder.h"
#include "support/IoFiles.h"

namespace polemcl::test_scan_folder {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;

const Eigen::Isometry3d kIdentity = Eigen::Isometry3d::Identity();

/// A pose row: x, y, z, with a quarter turn to the left.
std::string leftAt(const std::string& x, const std::string& y, const std::string& z) {
  return "0 -1 0 " + x + " 1 0 0 " + y + " 0 0 1 " + z + "\n";
}

/// Three scans in the plain layout.
class ScanFolderTest : public FolderTest {
 protected:
  void SetUp() override {
    for (const char* name : {"000000", "000001", "000002"}) addScan(name);
    write("times.txt", "# s\n0.0\n0.1\n0.25\n");
  }
  void addScan(const std::string& name) const {
    write("velodyne/" + name + ".bin", floats({1, 2, 3, 0.5f}));
  }
  void renameScans(const char* a, const char* b, const char* c) const {
    fs::remove_all(path("velodyne"));
    for (const char* name : {a, b, c}) addScan(name);
  }
};

TEST_F(ScanFolderTest, ScansAndTimesAlone) {
  const ScanFolder folder = readScanFolder(m_folder, kIdentity);
  ASSERT_EQ(folder.scans.size(), 3u);
  EXPECT_TRUE(folder.notes.empty());
  EXPECT_EQ(folder.scans[2].cloud, path("velodyne/000002.bin"));
  EXPECT_EQ(folder.scans[2].time, 0.25);
  for (const ScanEntry& entry : folder.scans) {
    EXPECT_FALSE(entry.T_map_robot);
    EXPECT_FALSE(entry.motion);
  }
}

TEST_F(ScanFolderTest, SensorPosesBecomeRobotPosesByHand) {
  write("poses.txt", leftAt("10", "20", "3") + leftAt("11", "20", "3") + leftAt("12", "20", "3"));
  EXPECT_TRUE(readScanFolder(m_folder, kIdentity)
                  .scans[0]
                  .T_map_robot->translation()
                  .isApprox(Eigen::Vector3d(10, 20, 3)));
  // The sensor is 1 m in front of and 2 m above the robot's origin, and looks backwards.
  Eigen::Isometry3d T_robot_sensor = Eigen::Isometry3d::Identity();
  T_robot_sensor.translation() << 1, 0, 2;
  T_robot_sensor.linear() = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const ScanFolder folder = readScanFolder(m_folder, T_robot_sensor);
  // The sensor looks to +y, so the robot looks to -y; its origin is 1 m behind the sensor, at +y.
  const Eigen::Isometry3d& T_map_robot = *folder.scans[1].T_map_robot;
  EXPECT_TRUE(T_map_robot.translation().isApprox(Eigen::Vector3d(11, 21, 1), 1e-12));
  EXPECT_NEAR(planar(T_map_robot).yaw, -M_PI / 2, 1e-12);
}

TEST_F(ScanFolderTest, MotionsAndTheirVariances) {
  write("odometry.txt",
        "# dx dy dyaw sx sy syaw\n0.5 -0.01 0.02 0.1 0.2 0.3\n0.6 0 -3.14159 0 0 0\n");
  const ScanFolder folder = readScanFolder(m_folder, kIdentity);
  EXPECT_FALSE(folder.scans[0].motion);
  const PoseWithCovariance& motion = *folder.scans[1].motion;
  EXPECT_EQ(motion.mean.x, 0.5);
  EXPECT_EQ(motion.mean.y, -0.01);
  EXPECT_EQ(motion.mean.yaw, 0.02);
  const Eigen::Matrix3d expected = Eigen::Vector3d(0.01, 0.04, 0.09).asDiagonal();
  EXPECT_TRUE(motion.covariance.isApprox(expected, 1e-15));
  EXPECT_EQ(folder.scans[2].motion->mean.x, 0.6);
}

TEST_F(ScanFolderTest, MotionsAreNotMovedToTheRobotTwice) {
  // Motions are already in the robot frame, for any sensor pose.
  write("odometry.txt", "1 0 0 0.1 0.1 0.1\n1 0 0 0.1 0.1 0.1\n");
  Eigen::Isometry3d T_robot_sensor = Eigen::Isometry3d::Identity();
  T_robot_sensor.linear() =
      Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_EQ(readScanFolder(m_folder, T_robot_sensor).scans[1].motion->mean.x, 1);
}

TEST_F(ScanFolderTest, RowsBeyondTheLastScanAreNoted) {
  write("times.txt", "0\n1\n2\n3\n4\n");
  write("poses.txt", leftAt("0", "0", "0") + leftAt("1", "0", "0") + leftAt("2", "0", "0") +
                         leftAt("3", "0", "0"));
  write("odometry.txt", "1 0 0 1 1 1\n2 0 0 1 1 1\n3 0 0 1 1 1\n4 0 0 1 1 1\n");
  const ScanFolder folder = readScanFolder(m_folder, kIdentity);
  ASSERT_EQ(folder.notes.size(), 3u);
  EXPECT_EQ(folder.notes[0],
            "times.txt: 5 times for 3 scans in velodyne/; the last 2 are not used");
  EXPECT_EQ(folder.notes[1],
            "poses.txt: 4 poses for 3 scans in velodyne/; the last 1 are not used");
  EXPECT_EQ(folder.notes[2],
            "odometry.txt: 4 motions for 3 scans in velodyne/; the last 2 are not used");
  EXPECT_EQ(folder.scans[2].motion->mean.x, 2);
}

TEST_F(ScanFolderTest, EmptyScansAreKeptAndNoted) {
  write("velodyne/000001.bin", "");
  const ScanFolder folder = readScanFolder(m_folder, kIdentity);
  EXPECT_EQ(folder.scans.size(), 3u);
  ASSERT_EQ(folder.notes.size(), 1u);
  expectIn(folder.notes[0], "1 of 3 scans are empty", "000001.bin");
}

TEST_F(ScanFolderTest, OneScanNeedsNoMotion) {
  fs::remove(path("velodyne/000001.bin"));
  fs::remove(path("velodyne/000002.bin"));
  write("times.txt", "7\n");
  write("odometry.txt", "# none\n");
  const ScanFolder folder = readScanFolder(m_folder, kIdentity);
  ASSERT_EQ(folder.scans.size(), 1u);
  EXPECT_EQ(folder.scans[0].time, 7);
  EXPECT_FALSE(folder.scans[0].motion);
}

TEST_F(ScanFolderTest, RefusesAFolderWithoutScans) {
  fs::remove_all(path("velodyne"));
  EXPECT_REFUSED(readScanFolder(m_folder, kIdentity), m_folder.string(), "no folder velodyne");
  fs::create_directory(path("velodyne"));
  EXPECT_REFUSED(readScanFolder(m_folder, kIdentity), path("velodyne").string(), "no *.bin");
}

TEST_F(ScanFolderTest, RefusesFilesThatAreMissingOrWrong) {
  expectRefused(
      {
          {"times.txt", "0\n1\n", {"times.txt", "2 times for 3 scans"}},
          {"times.txt", std::nullopt, {"times.txt", "No such file or directory"}},
          {"times.txt", "0\n1\n# again\n1\n", {"times.txt:4: ", "1 is not after 1"}},
          {"poses.txt",
           leftAt("0", "0", "0") + leftAt("1", "0", "0"),
           {"poses.txt", "2 poses for 3 scans"}},
          {"odometry.txt",
           "1 0 0 1 1 1\n",
           {"odometry.txt", "1 motions for 3 scans", "2 expected"}},
          {"odometry.txt",
           "0 0 0 1 1 1\n1 0 0 1 1 1\n1 0 0 1 1 1\n",
           {"odometry.txt", "3 motions for 3 scans", "2 expected", "second scan"}},
          {"odometry.txt",
           "1 0 0 1 1 1\n1 0 0 1 -0.5 1\n",
           {"odometry.txt:2: ", "-0.5 is negative"}},
          {"odometry.txt", "1 0 0 1 1 1\n1 0 12 1 1 1\n", {"odometry.txt:2: ", "12 rad"}},
          {"odometry.txt", "1 0 0\n1 0 0\n", {"odometry.txt:1: ", "3 numbers, 6 expected"}},
          {"velodyne/000001.bin",
           floats({1, 2, 3}),
           {"velodyne/000001.bin", "cut short", "12 bytes"}},
      },
      [&] { readScanFolder(m_folder, kIdentity); });
}

TEST_F(ScanFolderTest, RefusesPosesThatAreALinkToNothing) {
  fs::create_symlink(path("gone.txt"), path("poses.txt"));
  EXPECT_REFUSED(readScanFolder(m_folder, kIdentity), path("poses.txt").string(),
                 "No such file or directory");
}

TEST_F(ScanFolderTest, RefusesMorePosesWhenScansAreNotNumberedFromZero) {
  write("times.txt", "0\n1\n2\n");
  write("poses.txt", leftAt("0", "0", "0") + leftAt("1", "0", "0") + leftAt("2", "0", "0") +
                         leftAt("3", "0", "0"));
  renameScans("000000", "000001", "000003");  // one is missing
  EXPECT_REFUSED(readScanFolder(m_folder, kIdentity), path("poses.txt").string(),
                 "4 poses for 3 scans", "not clear");
  renameScans("a", "b", "c");
  EXPECT_REFUSED(readScanFolder(m_folder, kIdentity), "not clear");
  renameScans("000001", "000002", "000003");
  EXPECT_REFUSED(readScanFolder(m_folder, kIdentity), "not clear");
}

TEST_F(ScanFolderTest, RefusesAScanThatIsALinkToNothing) {
  fs::remove(path("velodyne/000001.bin"));
  fs::create_symlink(path("gone.bin"), path("velodyne/000001.bin"));
  EXPECT_REFUSED(readScanFolder(m_folder, kIdentity), path("velodyne/000001.bin").string(),
                 "No such file or directory");
}

TEST_F(ScanFolderTest, NumbersNeedNoZeros) {
  renameScans("9", "10", "11");
  const auto scans = readScanFolder(m_folder, kIdentity).scans;
  EXPECT_EQ(scans.front().cloud.filename(), "9.bin");
  EXPECT_EQ(scans.back().cloud.filename(), "11.bin");
}

TEST_F(ScanFolderTest, ReadsTheRealDrive) {
  POLEMCL_NEEDS_DATA();
  const ScanFolder folder = readScanFolder(dataFolder() / "kitti_raw_0005", kIdentity);
  ASSERT_EQ(folder.scans.size(), 80u);
  EXPECT_TRUE(folder.notes.empty());
  EXPECT_FALSE(folder.scans[0].motion);
  EXPECT_NEAR(folder.scans[79].time, 7.9, 1e-9);
  // Odometry is independent of the poses: a few per cent longer, with similar rotations.
  double driven = 0, odometry = 0, turned = 0, turnedOdometry = 0;
  for (std::size_t i = 1; i < folder.scans.size(); ++i) {
    const Pose2D step =
        relative(planar(*folder.scans[i - 1].T_map_robot), planar(*folder.scans[i].T_map_robot));
    const Pose2D& motion = folder.scans[i].motion->mean;
    driven += std::hypot(step.x, step.y);
    odometry += std::hypot(motion.x, motion.y);
    turned += step.yaw;
    turnedOdometry += motion.yaw;
    EXPECT_GT(folder.scans[i].motion->covariance.determinant(), 0);
  }
  EXPECT_NEAR(driven, 30, 2);
  EXPECT_NEAR(odometry / driven, 1.04, 0.02);
  EXPECT_NEAR(turnedOdometry, turned, 0.03);
}

TEST_F(ScanFolderTest, ReadsTheRealScansWithoutOdometry) {
  POLEMCL_NEEDS_DATA();
  const ScanFolder folder = readScanFolder(dataFolder() / "kitti_odom_00", kIdentity);
  ASSERT_EQ(folder.scans.size(), 16u);
  EXPECT_TRUE(folder.scans[15].T_map_robot);
  EXPECT_FALSE(folder.scans[15].motion);
}

TEST_F(ScanFolderTest, FoldersOfPcdFiles) {
  fs::remove_all(path("velodyne"));
  fs::remove(path("times.txt"));
  for (const char* name : {"0.pcd", "1.pcd", "2.pcd"}) write(name, "#");
  const ScanFolder bare = readPcdFolder(m_folder, kIdentity);
  ASSERT_EQ(bare.scans.size(), 3u);
  EXPECT_EQ(bare.scans[2].cloud, path("2.pcd"));
  EXPECT_DOUBLE_EQ(bare.scans[2].time, 0.2);
  EXPECT_FALSE(bare.scans[0].T_map_robot);
  ASSERT_EQ(bare.notes.size(), 1u);
  EXPECT_HAS(bare.notes[0], "0.1 s");
  EXPECT_EQ(bare.notes[0].find("missing"), std::string::npos);
  write("7.pcd", "#");
  EXPECT_HAS(readPcdFolder(m_folder, kIdentity).notes[0], "first between 2.pcd and 7.pcd");
  fs::remove(path("7.pcd"));
  fs::create_directory(path("stamped"));
  const auto timesOf = [&](const std::string& first, const std::string& second) {
    for (const auto& entry : fs::directory_iterator(path("stamped"))) fs::remove(entry.path());
    write("stamped/" + first + ".pcd", "#");
    write("stamped/" + second + ".pcd", "#");
    const ScanFolder named = readPcdFolder(path("stamped"), kIdentity);
    return std::pair(named.scans[0].time, named.scans[1].time);
  };
  const std::pair right(1700000000.0, 1700000001.5);
  EXPECT_EQ(timesOf("1700000000.000000000", "1700000001.500000000"), right);
  EXPECT_EQ(timesOf("1700000000000", "1700000001500"), right);
  EXPECT_EQ(timesOf("1700000000000000", "1700000001500000"), right);
  EXPECT_EQ(timesOf("1700000000000000000", "1700000001500000000"), right);
  EXPECT_EQ(timesOf("0000000012", "0000000013"), std::pair(0.0, 0.1)) << "numbers";
  EXPECT_EQ(timesOf("1700000000", "a"), std::pair(0.0, 0.1));
  write("times.txt", "5\n6\n7.5\n");
  write("poses.txt", leftAt("10", "20", "3") + leftAt("11", "20", "3") + leftAt("12", "20", "3"));
  write("odometry.txt", "1 0 0 1 1 1\n1 0 0 1 1 1\n");
  const ScanFolder full = readPcdFolder(m_folder, kIdentity);
  EXPECT_TRUE(full.notes.empty());
  EXPECT_EQ(full.scans[2].time, 7.5);
  EXPECT_EQ(full.scans[1].T_map_robot->translation().x(), 11);
  EXPECT_TRUE(full.scans[1].motion);
  write("times.txt", "5\n6\n");
  EXPECT_REFUSED(readPcdFolder(m_folder, kIdentity), "2 times for 3 scans");
  write("times.txt", "5\n6\n7.5\n");
  write("1.pcd", "");
  const ScanFolder holed = readPcdFolder(m_folder, kIdentity);
  ASSERT_EQ(holed.notes.size(), 1u);
  EXPECT_EQ(holed.notes[0], "1 of 3 scans are empty, the first is 1.pcd");
  EXPECT_EQ(holed.read(holed.scans[1]).size(), 0u);
}

}  // namespace
}  // namespace polemcl::test_scan_folder
