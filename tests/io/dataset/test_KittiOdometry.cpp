#include <cmath>

#include "io/data/Trajectory.h"
#include "io/dataset/KittiOdometry.h"
#include "support/IoFiles.h"

namespace polemcl::test_kitti_odometry {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;

const Eigen::Isometry3d kIdentity = Eigen::Isometry3d::Identity();

/// Camera: x right, y down, z forward. LiDAR: x forward, y left, z up. The camera is 0.3 m in front
/// of the LiDAR and 0.1 m below it: x_cam = -y, y_cam = -z - 0.1, z_cam = x - 0.3.
const char* const kCalibration =
    "P0: 7 0 6 0 0 7 2 0 0 0 1 0\nTr: 0 -1 0 0 0 0 -1 -0.1 1 0 0 -0.3\n";

/// Camera poses: 2 m forward (along its z), then a quarter turn to the left (about -y).
const char* const kCameraPoses =
    "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 2\n0 0 -1 0 0 1 0 0 1 0 0 2\n";

class KittiOdometryTest : public FolderTest {
 protected:
  void SetUp() override {
    for (const char* name : {"000000", "000001", "000002"}) {
      write("sequences/07/velodyne/" + std::string(name) + ".bin", floats({1, 2, 3, 0.5f}));
    }
    write("sequences/07/times.txt", "0.000000e+00\n1.036224e-01\n2.072448e-01\n");
    write("sequences/07/calib.txt", kCalibration);
    write("poses/07.txt", kCameraPoses);
  }
  fs::path sequence() const { return path("sequences/07"); }
};

TEST_F(KittiOdometryTest, CamerasPosesBecomeLidarPosesByHand) {
  const ScanFolder folder = readKittiOdometry(sequence(), kIdentity);
  ASSERT_EQ(folder.scans.size(), 3u);
  EXPECT_TRUE(folder.notes.empty());
  EXPECT_TRUE(folder.scans[0].T_map_robot->isApprox(kIdentity, 1e-12));
  EXPECT_EQ(folder.scans[1].time, 0.1036224);
  EXPECT_TRUE(folder.scans[1].T_map_robot->translation().isApprox(Eigen::Vector3d(2, 0, 0), 1e-12));
  // The camera is at x = 2.3 and turns left in place. The LiDAR, 0.3 m behind it, moves to the
  // right, to (2.3, -0.3), and looks along +y.
  const Eigen::Isometry3d& turned = *folder.scans[2].T_map_robot;
  EXPECT_TRUE(turned.translation().isApprox(Eigen::Vector3d(2.3, -0.3, 0), 1e-12))
      << turned.translation().transpose();
  EXPECT_NEAR(planar(turned).yaw, M_PI / 2, 1e-12);
  EXPECT_FALSE(folder.scans[1].motion);
}

TEST_F(KittiOdometryTest, TheSensorPoseGivesRobotPoses) {
  Eigen::Isometry3d T_robot_sensor = Eigen::Isometry3d::Identity();
  T_robot_sensor.translation() << 0.5, 0, 1.7;
  const ScanFolder folder = readKittiOdometry(sequence(), T_robot_sensor);
  EXPECT_TRUE(
      folder.scans[1].T_map_robot->translation().isApprox(Eigen::Vector3d(1.5, 0, -1.7), 1e-12));
}

TEST_F(KittiOdometryTest, FindsPosesInTheFolderFirstAndThenBesideIt) {
  write("sequences/07/poses.txt",
        "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 5\n1 0 0 0 0 1 0 0 0 0 1 9\n");
  EXPECT_NEAR(readKittiOdometry(sequence(), kIdentity).scans[1].T_map_robot->translation().x(), 5,
              1e-12);
  fs::remove(path("sequences/07/poses.txt"));
  EXPECT_NEAR(readKittiOdometry(sequence() / "", kIdentity).scans[1].T_map_robot->translation().x(),
              2, 1e-12);
  const fs::path before = fs::current_path();
  fs::current_path(sequence());
  const ScanFolder folder = readKittiOdometry(".", kIdentity);
  fs::current_path(before);
  EXPECT_TRUE(folder.scans[1].T_map_robot);
}

TEST_F(KittiOdometryTest, WithoutPosesThereAreNoneAndANote) {
  fs::remove(path("poses/07.txt"));
  const ScanFolder folder = readKittiOdometry(sequence(), kIdentity);
  EXPECT_FALSE(folder.scans[0].T_map_robot);
  ASSERT_EQ(folder.notes.size(), 1u);
  expectIn(folder.notes[0], "no poses");
}

TEST_F(KittiOdometryTest, RowsBelongToFileNumbers) {
  fs::remove(path("sequences/07/velodyne/000001.bin"));
  const ScanFolder folder = readKittiOdometry(sequence(), kIdentity);
  ASSERT_EQ(folder.scans.size(), 2u);
  EXPECT_EQ(folder.scans[1].time, 0.2072448);
  EXPECT_NEAR(planar(*folder.scans[1].T_map_robot).yaw, M_PI / 2, 1e-12);
  ASSERT_EQ(folder.notes.size(), 1u);
  EXPECT_EQ(folder.notes[0], "2 scans of a sequence of 3");
}

TEST_F(KittiOdometryTest, TakesTheOtherNameOfTheCalibration) {
  write("sequences/07/calib.txt", "Tr_velo_to_cam: 0 -1 0 0 0 0 -1 -0.1 1 0 0 -0.3\r\n");
  EXPECT_NEAR(readKittiOdometry(sequence(), kIdentity).scans[2].T_map_robot->translation().y(),
              -0.3, 1e-12);
}

TEST_F(KittiOdometryTest, RefusesFilesThatAreMissingOrWrong) {
  expectRefused(
      {
          {"poses/07.txt",
           "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 2\n",
           {"07.txt", "2 poses for 3 scans"}},
          {"sequences/07/times.txt", "0\n", {"times.txt", "1 times for 3 scans"}},
          {"sequences/07/times.txt", "0\n1\n0.5\n", {"times.txt:3: ", "not after"}},
          {"sequences/07/velodyne/x.bin", "", {"x.bin", "not a frame number"}},
          {"sequences/07/calib.txt", std::nullopt, {"calib.txt", "No such file or directory"}},
          {"sequences/07/calib.txt", "P0: 7 0 6 0 0 7 2 0 0 0 1 0\n", {"calib.txt", "no line Tr:"}},
          {"sequences/07/calib.txt",
           "P0: 1\nTr: 0 -1 0 0 0 0 -1 -0.1 1 0 0\n",
           {"calib.txt:2: ", "11 numbers", "12 expected"}},
          {"sequences/07/calib.txt",
           "Tr: 0 -1 0 0 0 0 1 -0.1 1 0 0 -0.3\n",
           {"calib.txt:1: ", "not a rotation"}},
          {"sequences/07/velodyne/000001.bin", "abc", {"000001.bin", "cut short"}},
      },
      [&] { readKittiOdometry(sequence(), kIdentity); });
}

TEST_F(KittiOdometryTest, RefusesOtherFolders) {
  EXPECT_REFUSED(readKittiOdometry(path("no"), kIdentity), path("no").string());
  EXPECT_REFUSED(readKittiOdometry(path("sequences"), kIdentity),
                 "sequences: no folder velodyne in it; name the folder of one sequence");
}

TEST_F(KittiOdometryTest, NeedsNoCalibrationWithoutPoses) {
  fs::remove(path("poses/07.txt"));
  fs::remove(path("sequences/07/calib.txt"));
  const ScanFolder folder = readKittiOdometry(sequence(), kIdentity);
  EXPECT_EQ(folder.scans.size(), 3u);
  EXPECT_FALSE(folder.scans[1].T_map_robot);
}

TEST_F(KittiOdometryTest, ReadsRealScansLaidOutAsASequence) {
  POLEMCL_NEEDS_DATA();
  // The scans and LiDAR poses of the sample in KITTI's form: camera poses in the frame of the first
  // camera, T_cam = Tr · T_lidar · Tr⁻¹. Reading must return the LiDAR poses.
  const fs::path real = dataFolder() / "kitti_odom_00";
  fs::create_directories(path("sequences/00"));
  fs::create_directory_symlink(real / "velodyne", path("sequences/00/velodyne"));
  fs::copy(real / "times.txt", path("sequences/00/times.txt"));
  write("sequences/00/calib.txt", kCalibration);
  const auto T_map_lidar = readKittiPoses(real / "poses.txt");
  const Eigen::Isometry3d Tr = poseFromRows({0, -1, 0, 0, 0, 0, -1, -0.1, 1, 0, 0, -0.3}, "");
  std::ostringstream rows;
  rows.precision(17);
  for (const auto& pose : T_map_lidar) {
    const Eigen::Isometry3d camera = Tr * pose * Tr.inverse();
    for (int i = 0; i < 12; ++i) rows << camera(i / 4, i % 4) << (i < 11 ? " " : "\n");
  }
  write("poses/00.txt", rows.str());
  const ScanFolder folder = readKittiOdometry(path("sequences/00"), kIdentity);
  ASSERT_EQ(folder.scans.size(), T_map_lidar.size());
  for (std::size_t i = 0; i < folder.scans.size(); ++i) {
    EXPECT_TRUE(folder.scans[i].T_map_robot->isApprox(T_map_lidar[i], 1e-9)) << i;
  }
}

}  // namespace
}  // namespace polemcl::test_kitti_odometry
