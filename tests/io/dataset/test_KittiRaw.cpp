#include <cmath>
#include <cstdio>

#include "io/data/Trajectory.h"
#include "io/dataset/KittiRaw.h"
#include "support/IoFiles.h"

namespace polemcl::test_kitti_raw {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;

const Eigen::Isometry3d kIdentity = Eigen::Isometry3d::Identity();

/// The LiDAR is 0.8 m behind, 0.3 m left of and 0.8 m above the IMU, with parallel axes.
const char* const kCalibration =
    "calib_time: 25-May-2012 16:47:16\nR: 1 0 0 0 1 0 0 0 1\nT: 0.8 -0.3 -0.8\n";

std::string frameName(int number, const char* ending) {
  char name[32];
  std::snprintf(name, sizeof(name), "%010d%s", number, ending);
  return name;
}

std::string oxtsRow(double lat, double lon, double alt, double roll, double pitch, double yaw) {
  char text[256];
  std::snprintf(text, sizeof(text), "%.13f %.13f %.9f %.15f %.15f %.15f", lat, lon, alt, roll,
                pitch, yaw);
  std::string row = text;
  for (int i = 6; i < 30; ++i) row += " " + std::to_string(i);
  return row + "\n";
}

std::string stamp(double seconds) {
  char text[64];
  std::snprintf(text, sizeof(text), "2011-09-26 13:02:%012.9f\n", seconds);
  return text;
}

/// Five frames 0.1 s apart; the vehicle looks east and moves 1e-5 degrees of longitude per frame.
class KittiRawTest : public FolderTest {
 protected:
  void SetUp() override {
    std::string times;
    for (int i = 0; i < 5; ++i) {
      addScan(i);
      addOxts(i, oxtsRow(49, 8.4 + 1e-5 * i, 112 + 0.5 * i, 0, 0, 0));
      times += stamp(25 + 0.1 * i);
    }
    write("drive/velodyne_points/timestamps.txt", times);
    write("drive/oxts/timestamps.txt", times);
    write("date/calib_imu_to_velo.txt", kCalibration);
  }
  void addScan(int number) const {
    write("drive/velodyne_points/data/" + frameName(number, ".bin"), floats({1, 2, 3, 0.5f}));
  }
  void removeScan(int number) const {
    fs::remove(path("drive/velodyne_points/data/" + frameName(number, ".bin")));
  }
  void addOxts(int number, const std::string& row) const {
    write("drive/oxts/data/" + frameName(number, ".txt"), row);
  }
  ScanFolder readDrive(const Eigen::Isometry3d& T_robot_sensor = kIdentity) const {
    return readKittiRaw(path("drive"), path("date"), T_robot_sensor);
  }
};

TEST_F(KittiRawTest, ParseKittiTimeByHand) {
  EXPECT_EQ(parseKittiTime("1970-01-01 00:00:00", ""), 0);
  EXPECT_EQ(parseKittiTime("1969-12-31 23:59:59", ""), -1);
  EXPECT_EQ(parseKittiTime("2000-02-29 23:59:59", ""), 951868799);
  EXPECT_EQ(parseKittiTime("2100-03-01 00:00:00", ""), 4107542400);
  EXPECT_EQ(parseKittiTime("2024-12-31 12:00:00.5", ""), 1735646400.5);
  EXPECT_NEAR(parseKittiTime(" 2011-09-26 13:02:25.964389445\r", ""), 1317042145.964389445, 3e-7);
}

TEST_F(KittiRawTest, RefusesWhatIsNoTime) {
  for (const char* text :
       {"", "2011-09-26", "2011-09-26T13:02:25", "2011-13-26 13:02:25", "2011-02-29 13:02:25",
        "1900-02-29 00:00:00", "2011-09-26 24:02:25", "2011-09-26 13:60:25", "2011-09-26 13:02:61",
        "2011-09-26 13:02:25.", "2011-09-26 13:02:25.5x", "2011-09-26 13:02:25,5",
        "2011-09-26 13:02:2x", "2011-09-26 13:02:-5", "1317042145.9643"}) {
    EXPECT_REFUSED(parseKittiTime(text, "f:3: "), "f:3: ", "YYYY-MM-DD");
  }
}

TEST_F(KittiRawTest, MercatorPoseByTheFormulaOfTheDevkit) {
  // Computed separately with my = s·R·log(tan((90 + lat)·pi/360)), lat 49.015003823272.
  const double scale = 0.6558613736316692;
  const auto a = mercatorPose({49.015003823272, 8.4342971002335, 112.8, 0, 0, 0}, scale);
  EXPECT_NEAR(a.translation().x(), 615789.3313814249, 1e-6);
  EXPECT_NEAR(a.translation().y(), 4117109.179554305, 1e-5);
  EXPECT_EQ(a.translation().z(), 112.8);
  const auto b = mercatorPose({49.015103823272, 8.4343971002335, 112.8, 0, 0, 0}, scale);
  EXPECT_NEAR(b.translation().x() - a.translation().x(), 7.301015, 1e-5);
  EXPECT_NEAR(b.translation().y() - a.translation().y(), 11.131960, 1e-5);
  // The length of 1e-4 degrees on the sphere near this latitude.
  EXPECT_NEAR(b.translation().y() - a.translation().y(), 6378137 * 1e-4 * M_PI / 180, 1e-4);
}

TEST_F(KittiRawTest, AttitudeIsYawThenPitchThenRoll) {
  // Nose up is a negative pitch about the left axis.
  const auto pose = mercatorPose({0, 0, 0, 0.1, -0.2, 0.3}, 1);
  const Eigen::Vector3d ahead = pose.linear().col(0);
  EXPECT_NEAR(std::atan2(ahead.y(), ahead.x()), 0.3, 1e-15);
  EXPECT_NEAR(std::asin(ahead.z()), 0.2, 1e-15);
  EXPECT_NEAR(std::atan2(pose.linear()(2, 1), pose.linear()(2, 2)), 0.1, 1e-15);
}

TEST_F(KittiRawTest, PosesByHand) {
  const ScanFolder folder = readDrive();
  ASSERT_EQ(folder.scans.size(), 5u);
  EXPECT_TRUE(folder.notes.empty());
  EXPECT_NEAR(folder.scans[3].time, 1317042145.3, 1e-6);
  // 1e-5 degrees of longitude at 49 degrees north are 0.730322 m. T_lidar_imu is a translation; the
  // LiDAR is at the negative of it from the IMU.
  const double step = 6378137 * std::cos(49 * M_PI / 180) * 1e-5 * M_PI / 180;
  EXPECT_NEAR(step, 0.730322, 1e-6);
  for (int i = 0; i < 5; ++i) {
    const Eigen::Isometry3d& pose = *folder.scans[i].T_map_robot;
    EXPECT_TRUE(
        pose.translation().isApprox(Eigen::Vector3d(step * i - 0.8, 0.3, 0.8 + 0.5 * i), 1e-6))
        << pose.translation().transpose();
    EXPECT_TRUE(pose.linear().isIdentity(1e-12));
    EXPECT_FALSE(folder.scans[i].motion);
  }
}

TEST_F(KittiRawTest, TheMapLooksAlongTheFirstFrameAndStaysLevel) {
  // Heading north, nose up: x of the map is north, and the map is not tilted.
  for (int i = 0; i < 5; ++i) addOxts(i, oxtsRow(49 + 1e-5 * i, 8.4, 112, 0.05, -0.1, M_PI / 2));
  write("date/calib_imu_to_velo.txt", "R: 1 0 0 0 1 0 0 0 1\nT: 0 0 0\n");
  const ScanFolder folder = readDrive();
  EXPECT_TRUE(folder.scans[0].T_map_robot->translation().isZero(1e-6));
  const Eigen::Isometry3d& last = *folder.scans[4].T_map_robot;
  EXPECT_NEAR(last.translation().x(), 6378137 * 4e-5 * M_PI / 180, 1e-4);
  EXPECT_NEAR(last.translation().y(), 0, 1e-6);
  EXPECT_NEAR(last.translation().z(), 0, 1e-9);
  EXPECT_NEAR(planar(last).yaw, 0, 1e-12);
  EXPECT_NEAR(std::asin(last.linear()(2, 0)), 0.1, 1e-12);
}

TEST_F(KittiRawTest, TheSensorPoseGivesRobotPoses) {
  // With the IMU at the robot's origin, the robot frame is that of the IMU.
  Eigen::Isometry3d T_robot_sensor = Eigen::Isometry3d::Identity();
  T_robot_sensor.translation() << -0.8, 0.3, 0.8;
  EXPECT_TRUE(readDrive(T_robot_sensor).scans[0].T_map_robot->translation().isZero(1e-6));
}

TEST_F(KittiRawTest, OxtsFramesAreFixesOfTheImu) {
  const ScanFolder drive = readDrive();
  ASSERT_EQ(drive.fixes.size(), 5u);
  const GnssFix& fix = drive.fixes[3];
  EXPECT_EQ(fix.time, drive.scans[3].time);
  EXPECT_NEAR(fix.latitude, 49, 1e-12);
  EXPECT_NEAR(fix.longitude, 8.40003, 1e-12);
  EXPECT_EQ(fix.sigma, 23);  // number 24 of the row
  EXPECT_NEAR(fix.antenna_robot.x(), 0.8, 1e-12);
  EXPECT_NEAR(fix.antenna_robot.y(), -0.3, 1e-12);
}

TEST_F(KittiRawTest, MissingScansArePairedByNumberAndNoted) {
  removeScan(1);
  removeScan(2);
  // Lines of missing frames are blank, as in drive 0009 …
  write("drive/velodyne_points/timestamps.txt", stamp(25) + "\n\n" + stamp(25.3) + stamp(25.4));
  const ScanFolder byNumber = readDrive();
  ASSERT_EQ(byNumber.scans.size(), 3u);
  EXPECT_NEAR(byNumber.scans[1].time, 1317042145.3, 1e-6);
  EXPECT_NEAR(byNumber.scans[1].T_map_robot->translation().z(), 0.8 + 1.5, 1e-6);
  EXPECT_EQ(byNumber.notes, std::vector<std::string>{"no scan for the oxts frames 1-2"});
  // … or present …
  write("drive/velodyne_points/timestamps.txt",
        stamp(25) + stamp(25.1) + stamp(25.2) + stamp(25.3) + stamp(25.4));
  EXPECT_EQ(readDrive().scans[1].time, byNumber.scans[1].time);
  // … or missing.
  write("drive/velodyne_points/timestamps.txt", stamp(25) + stamp(25.3) + stamp(25.4));
  EXPECT_EQ(readDrive().scans[1].time, byNumber.scans[1].time);
}

TEST_F(KittiRawTest, ScansWithoutOxtsAreLeftOutAndNoted) {
  addScan(7);
  write("drive/velodyne_points/timestamps.txt",
        stamp(25) + stamp(25.1) + stamp(25.2) + stamp(25.3) + stamp(25.4) + stamp(25.7));
  const ScanFolder folder = readDrive();
  EXPECT_EQ(folder.scans.size(), 5u);
  ASSERT_EQ(folder.notes.size(), 1u);
  expectIn(folder.notes[0], "left out", "scans 7");
}

TEST_F(KittiRawTest, ADriveMayStartLate) {
  removeScan(0);
  fs::remove(path("drive/oxts/data/" + frameName(0, ".txt")));
  const ScanFolder folder = readDrive();
  ASSERT_EQ(folder.scans.size(), 4u);
  EXPECT_NEAR(folder.scans[0].time, 1317042145.1, 1e-6);
  EXPECT_NEAR(folder.scans[0].T_map_robot->translation().x(), -0.8, 1e-6);
}

TEST_F(KittiRawTest, NotesPairsFarApartInTime) {
  write("drive/oxts/timestamps.txt",
        stamp(25) + stamp(25.1) + stamp(25.26) + stamp(25.3) + stamp(25.4));
  const ScanFolder folder = readDrive();
  ASSERT_EQ(folder.notes.size(), 1u);
  expectIn(folder.notes[0], "0.060 s", "frame 2");
  fs::remove(path("drive/oxts/timestamps.txt"));
  EXPECT_TRUE(readDrive().notes.empty());
}

TEST_F(KittiRawTest, RefusesFilesThatAreMissingOrWrong) {
  expectRefused(
      {
          {"drive/velodyne_points/timestamps.txt",
           stamp(25) + stamp(25.1),
           {"timestamps.txt", "2 times for 5 frames"}},
          {"drive/velodyne_points/timestamps.txt",
           stamp(25) + "\n" + stamp(25.2) + stamp(25.3) + stamp(25.4),
           {"timestamps.txt:2: ", "not a time"}},
          {"drive/velodyne_points/timestamps.txt",
           stamp(25) + stamp(25.2) + stamp(25.1) + stamp(25.3) + stamp(25.4),
           {"timestamps.txt", "frame 2 is not after that of frame 1"}},
          {"drive/velodyne_points/timestamps.txt",
           std::nullopt,
           {"timestamps.txt", "No such file or directory"}},
          {"date/calib_imu_to_velo.txt",
           std::nullopt,
           {"date: no calib_imu_to_velo.txt in it", "--calib"}},
          {"date/calib_imu_to_velo.txt",
           "R: 1 0 0 0 1 0 0 0 1\nT 0 0 0\n",
           {"calib_imu_to_velo.txt", "9 and 0 found"}},
          {"date/calib_imu_to_velo.txt",
           "R: 1 0 0 0 1 0 0 0 2\nT: 0 0 0\n",
           {"calib_imu_to_velo.txt", "not a rotation"}},
          {"date/calib_imu_to_velo.txt",
           "R: 1 0 0 0 1 0 0 0 x\nT: 0 0 0\n",
           {"calib_imu_to_velo.txt:1: ", "'x'"}},
      },
      [&] { readDrive(); });
}

TEST_F(KittiRawTest, BlankLinesAtTheEndOfTheTimesCountForNothing) {
  const std::string times = read(path("drive/velodyne_points/timestamps.txt"));
  write("drive/velodyne_points/timestamps.txt", times + "\n \n");
  EXPECT_EQ(readDrive().scans.size(), 5u);
}

TEST_F(KittiRawTest, RefusesMalformedOxts) {
  addOxts(3, "49 8.4 112 0 0 0\n");
  EXPECT_REFUSED(readDrive(), frameName(3, ".txt") + ":1: ", "6 numbers, 30 expected");
  addOxts(3, oxtsRow(49, 8.4, 112, 0, 0, 0) + oxtsRow(49, 8.4, 112, 0, 0, 0));
  EXPECT_REFUSED(readDrive(), frameName(3, ".txt"), "2 lines");
  addOxts(3, oxtsRow(90, 8.4, 112, 0, 0, 0));
  EXPECT_REFUSED(readDrive(), frameName(3, ".txt") + ":1: ", "latitude 90");
  addOxts(3, oxtsRow(49, 180.1, 112, 0, 0, 0));
  EXPECT_REFUSED(readDrive(), frameName(3, ".txt") + ":1: ", "longitude 180.1");
}

TEST_F(KittiRawTest, RefusesADriveWithoutCommonFrames) {
  fs::remove_all(path("drive/oxts/data"));
  fs::remove(path("drive/oxts/timestamps.txt"));
  addOxts(9, oxtsRow(49, 8.4, 112, 0, 0, 0));
  EXPECT_REFUSED(readDrive(), path("drive").string(), "scans 0-4", "oxts 9");
}

TEST_F(KittiRawTest, RefusesADriveWithoutScansOrOxts) {
  EXPECT_REFUSED(readKittiRaw(path("no"), path("date"), kIdentity), path("no").string(),
                 "no folder velodyne_points/data");
  fs::remove_all(path("drive/oxts/data"));
  EXPECT_REFUSED(readDrive(), path("drive/oxts/data").string(), "No such file or directory");
}

TEST_F(KittiRawTest, RefusesAScanCutShort) {
  write("drive/velodyne_points/data/" + frameName(2, ".bin"), "abc");
  EXPECT_REFUSED(readDrive(), frameName(2, ".bin"), "cut short");
}

}  // namespace
}  // namespace polemcl::test_kitti_raw
