#include <cmath>
#include <optional>

#include "io/data/PlanarMotion.h"
#include "io/data/Trajectory.h"
#include "io/dataset/Rosbag2.h"
#include "io/dataset/RosbagMotions.h"
#include "support/IoFiles.h"
#include "support/RosBags.h"

namespace polemcl::test_rosbag2 {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;
using namespace polemcl::tests;

constexpr double kStart = 1700000000;  ///< s; a double holds it to 0.2 us

std::string cloudAt(double time, const std::string& frame = "lidar") {
  TestCloud cloud;
  cloud.time = kStart + time;
  cloud.frame = frame;
  cloud.point(static_cast<float>(time), 2, 3, 4);
  return cloud.message();
}

std::string odometryAt(TestOdometry odometry) {
  odometry.time += kStart;
  return odometryMessage(odometry);
}

class Rosbag2Test : public FolderTest {
 protected:
  void SetUp() override {
    bag.emplace(path("a.db3"));
    clouds = bag->topic("/points", pointCloud2);
    odometry = bag->topic("/odom", odometry2);
    transforms = bag->topic("/tf_static", transforms2);
    bag->topic("/never", pointCloud2);
  }
  /// Scans at 0.05, 0.15, ... s; the robot drives an arc with 10 m/s and 0.5 rad/s, measured at
  /// 0, 0.1, 0.2, ... s.
  void writeDrive(int scans, std::array<double, 3> variances) {
    for (int i = 0; i < scans; ++i) bag->add(clouds, 100 * i, cloudAt(0.05 + 0.1 * i));
    for (int i = 0; i <= scans; ++i) {
      const double yaw = 0.05 * i;
      bag->add(odometry, 100 * i,
               odometryAt({0.1 * i, 20 * std::sin(yaw), 20 - 20 * std::cos(yaw), yaw, variances}));
    }
  }
  ScanFolder load() { return readRosbag2(path("a.db3"), options); }

  std::optional<TestBag> bag;
  int clouds = 0, odometry = 0, transforms = 0;
  Rosbag2Options options;
};

void expectNote(const ScanFolder& folder, const std::string& text) {
  std::string all;
  for (const auto& note : folder.notes) all += note + " | ";
  EXPECT_HAS(all, text);
}

TEST_F(Rosbag2Test, ReadsCloudsOneByOne) {
  for (const double time : {0.5, 0.6, 0.6, 0.7})
    bag->add(clouds, static_cast<std::int64_t>(10 * time), cloudAt(time));
  const ScanFolder folder = load();
  ASSERT_EQ(folder.scans.size(), 3u);
  expectNote(folder, "1 of 4 scans left out, stamped not later");
  expectNote(folder, "no static transform from base_link to lidar");
  expectNote(folder, "no times of their own");
  EXPECT_EQ(folder.scans[0].time, kStart + 0.5);
  EXPECT_FALSE(folder.scans[1].motion);
  EXPECT_FALSE(folder.scans[1].T_map_robot);
  EXPECT_FALSE(folder.T_robot_sensor);
  EXPECT_EQ(folder.read(folder.scans[2]).x, std::vector<float>{0.7f});
  EXPECT_EQ(folder.read(folder.scans[0]).x, std::vector<float>{0.5f});
}

TEST_F(Rosbag2Test, InterpolatesOdometryAtTheScans) {
  writeDrive(5, {});
  const ScanFolder folder = load();
  ASSERT_EQ(folder.scans.size(), 5u);
  EXPECT_FALSE(folder.scans[0].motion);
  // Half-way points of two chords of 20·2·sin(0.025) m that make an angle of 0.05 rad.
  const double half = 20 * std::sin(0.025);
  for (std::size_t i = 1; i < 5; ++i) {
    const Pose2D& motion = folder.scans[i].motion->mean;
    EXPECT_NEAR(motion.yaw, 0.05, 1e-6);
    // The robot's heading is that of the chord at its middle.
    EXPECT_NEAR(motion.x, half * (1 + std::cos(0.05)), 1e-5);
    EXPECT_NEAR(motion.y, half * std::sin(0.05), 1e-5);
  }
}

TEST_F(Rosbag2Test, SaysWhereTheLidarStandsOrThatNobodySays) {
  writeDrive(3, {});
  expectNote(load(), "so poles are put wrong in curves if the odometry is that of another place");
  options.readsSensorPose = false;
  for (const std::string& note : load().notes) EXPECT_EQ(note.find("LiDAR"), std::string::npos);
}

TEST_F(Rosbag2Test, OneWrongStampCostsOneScan) {
  for (const double time : {0.5, 0.6, 3600.0, 0.7, 0.8, -9.0, 0.9})
    bag->add(clouds, static_cast<std::int64_t>(10 * time), cloudAt(time));
  bag->run("UPDATE messages SET timestamp = id");
  const ScanFolder folder = load();
  ASSERT_EQ(folder.scans.size(), 5u);
  EXPECT_EQ(folder.scans[1].time, kStart + 0.6);
  EXPECT_EQ(folder.scans[2].time, kStart + 0.7);
  EXPECT_EQ(folder.scans[4].time, kStart + 0.9);
  expectNote(folder, "2 of 7 scans left out, stamped not later");
}

TEST_F(Rosbag2Test, MessagesWithoutAPoseAreLeftOut) {
  writeDrive(3, {});
  bag->add(odometry, 50, odometryAt({0.05, NAN}));
  CdrWriter link;
  link.put(std::uint32_t{1}).header(0, "base_link").text("camera").zeros(7);
  bag->add(transforms, 0, link.message());
  const ScanFolder folder = load();
  EXPECT_EQ(folder.scans.size(), 3u);
  expectNote(folder, "/odom: 5 messages, 1 ignored: numbers that are not finite, or no rotation");
  expectNote(folder, "static transforms that are no rotation are left out: base_link to camera");
}

TEST_F(Rosbag2Test, RefusesARobotWhoseZPointsDown) {
  bag->add(clouds, 0, cloudAt(0.1));
  for (const double time : {0.0, 0.2}) {
    TestOdometry motion;
    motion.time = time;
    motion.down = true;
    bag->add(odometry, 0, odometryAt(motion));
  }
  EXPECT_REFUSED(load(),
                 "/odom: its z axis points down; a frame with x ahead and z up is expected");
}

TEST_F(Rosbag2Test, OdometryThatIsNotReadMayBeAnything) {
  writeDrive(3, {});
  bag->add(transforms, 0, transformsMessage({{"base_link", "lidar", 1, 0, 2, 0}}));
  bag->add(odometry, 1000, odometryAt({0.15, 0, 0, 0, {}, "trailer"}));
  bag->add(clouds, 1000, cloudAt(9));
  options.readsOdometry = false;
  const ScanFolder folder = load();
  EXPECT_EQ(folder.scans.size(), 4u);
  EXPECT_FALSE(folder.scans[1].motion);
  EXPECT_EQ(folder.T_robot_sensor.value().translation().x(), 1);
  bag->add(bag->topic("/wheels", odometry2), 0, odometryAt({0}));
  EXPECT_EQ(load().scans.size(), 4u);
}

TEST_F(Rosbag2Test, ScansThatBeginAtAMovingAzimuth) {
  for (int i = 0; i < 40; ++i)
    bag->add(clouds, i, turningCloud(kStart + 0.1 * i, -1, 3 - 0.05 * i, -0.1, 0.1).message());
  EXPECT_TRUE(load().timing.movingCut);
}

TEST_F(Rosbag2Test, RefusesCloudsInTheFrameOfTheOdometry) {
  bag->add(clouds, 0, cloudAt(0.1, "odom"));
  bag->add(odometry, 0, odometryAt({}));
  EXPECT_REFUSED(load(), "/points: these clouds are in odom, the frame of the odometry",
                 "--cloud-topic");
}

TEST_F(Rosbag2Test, CloudsWithoutAFrameOrInThatOfTheRobotAreTaken) {
  for (const char* frame : {"", "base_link"}) {
    SetUp();
    bag->add(clouds, 0, cloudAt(0.1, frame));
    for (const double time : {0.0, 0.2}) {
      TestOdometry motion;
      motion.time = time;
      motion.frame = frame;
      bag->add(odometry, 0, odometryAt(motion));
    }
    EXPECT_EQ(load().scans.size(), 1u) << frame;
  }
}

TEST_F(Rosbag2Test, NotesTransformsThatMayBeTheOdometry) {
  bag->add(clouds, 0, cloudAt(0.1));
  const int moving = bag->topic("/tf", transforms2);
  expectNote(load(), "no static transform");
  for (const std::string& note : load().notes)
    EXPECT_EQ(note.find("messages of /tf"), std::string::npos);
  bag->add(moving, 0, transformsMessage({}));
  expectNote(load(), "the 1 messages of /tf are not read");
}

TEST_F(Rosbag2Test, CovariancesAreThoseOfTheTwist) {
  writeDrive(5, {0.04, 0.01, 0.0025});
  const Eigen::Matrix3d covariance = load().scans[2].motion->covariance;
  // Two halves of a message with dt = 0.1 s each: variances times 0.01 s².
  EXPECT_NEAR(covariance(0, 0), 0.04 * 0.01 + 1e-6, 2e-6);
  EXPECT_NEAR(covariance(2, 2), 0.0025 * 0.01 + 1e-8, 1e-9);
  // The first half's yaw error, 0.5·0.0025·0.01, moves the second half of 0.5 m aside.
  EXPECT_NEAR(covariance(1, 1), 0.01 * 0.01 + 0.5 * 0.000025 * 0.25 + 1e-6, 2e-6);
}

TEST_F(Rosbag2Test, WithoutCovariancesTwoPercent) {
  for (const double variance : {0.0, -1.0, std::nan("")}) {
    SetUp();
    writeDrive(3, {variance, 0, 0});
    const ScanFolder folder = load();
    expectNote(folder, "/odom: 4 messages, 4 without a covariance");
    const PoseWithCovariance& motion = *folder.scans[2].motion;
    EXPECT_TRUE(
        motion.covariance.isApprox(assumedCovariance(motion.mean, 0.02) + floorCovariance()));
  }
}

TEST_F(Rosbag2Test, ScansOutsideTheOdometryAreLeftOut) {
  writeDrive(3, {});
  bag->add(clouds, 1000, cloudAt(9));
  bag->add(odometry, 1000, odometryAt({0.05}));
  const ScanFolder folder = load();
  EXPECT_EQ(folder.scans.size(), 3u);
  expectNote(folder, "1 of 4 scans left out, at times without odometry");
  expectNote(folder, "/odom: 5 messages, 1 ignored: not later");
}

TEST_F(Rosbag2Test, TheGyroscopeGivesTheYaw) {
  writeDrive(4, {});
  const int imu = bag->topic("/imu", imu2);
  // The IMU lies on its side: its y axis points up. 1 rad/s, twice what the odometry says.
  CdrWriter tilt;
  tilt.put(std::uint32_t{1}).header(0, "base_link").text("imu").zeros(3);
  tilt.put(std::sqrt(0.5)).put(0.0).put(0.0).put(std::sqrt(0.5));
  bag->add(transforms, 0, tilt.message());
  for (int i = 0; i < 50; ++i)
    bag->add(imu, i, imuMessage(kStart + 0.01 * i, "imu", {7, 1, 7}, 0.09));
  options.topics.imu = "/imu";
  const ScanFolder folder = load();
  ASSERT_EQ(folder.scans.size(), 4u);
  const PoseWithCovariance& motion = *folder.scans[2].motion;
  EXPECT_NEAR(motion.mean.yaw, 0.1, 1e-6);
  const double half = 20 * std::sin(0.025), chord = std::hypot(motion.mean.x, motion.mean.y);
  EXPECT_NEAR(chord, 2 * half * std::cos(0.025), 1e-5);
  EXPECT_NEAR(std::atan2(motion.mean.y, motion.mean.x), 0.05, 1e-6) << "half of the turn";
  EXPECT_NEAR(motion.covariance(2, 2), 10 * 0.09 * 1e-4 + 1e-8, 1e-9);
}

TEST_F(Rosbag2Test, WhereTheImuWasSilentTheOdometryGivesTheYaw) {
  writeDrive(7, {});
  const int imu = bag->topic("/imu", imu2);
  for (int i = 0; i < 80; ++i)  // silent from 0.16 to 0.44 s, and then turning the other way
    if (i <= 16 || i >= 44)
      bag->add(imu, i, imuMessage(kStart + 0.01 * i, "base_link", {0, 0, i < 44 ? 1.0 : -3.0}, 0));
  options.topics.imu = "/imu";
  const ScanFolder folder = load();
  ASSERT_EQ(folder.scans.size(), 5u);
  expectNote(folder, "2 of 7 scans left out");
  EXPECT_NEAR(folder.scans[1].motion->mean.yaw, 0.1, 1e-6);
  EXPECT_NEAR(folder.scans[2].motion->mean.yaw, 0.15, 1e-6) << "0.3 s at 0.5 rad/s";
  EXPECT_NEAR(folder.scans[3].motion->mean.yaw, -0.3, 1e-6);
}

TEST_F(Rosbag2Test, VelocitiesOfTheOdometryAreNotNeeded) {
  bag->add(clouds, 0, cloudAt(0.5));
  TestOdometry pose;
  pose.speed = NAN;
  for (const double time : {0.4, 0.6}) {
    pose.time = time;
    bag->add(odometry, 0, odometryAt(pose));
  }
  EXPECT_EQ(load().scans.size(), 1u);
}

TEST_F(Rosbag2Test, AnImuOfUnknownPoseIsTakenAsUpright) {
  writeDrive(3, {});
  const int imu = bag->topic("/imu", imu2);
  for (int i = 0; i < 50; ++i) bag->add(imu, i, imuMessage(kStart + 0.01 * i, "imu", {7, 7, 2}, 0));
  options.topics.imu = "/imu";
  const ScanFolder folder = load();
  expectNote(folder, "no static transform from base_link to imu");
  const PoseWithCovariance& motion = *folder.scans[1].motion;
  EXPECT_NEAR(motion.mean.yaw, 0.2, 1e-6);
  EXPECT_NEAR(motion.covariance(2, 2), 0.004 * 0.004 + 1e-8, 1e-9) << "2 % of the yaw";
}

TEST_F(Rosbag2Test, TheSensorPoseIsTheChainOfStaticTransforms) {
  writeDrive(2, {});
  bag->add(transforms, 0, transformsMessage({{"mast", "lidar", 0.5, 0, 0.25, 0}}));
  bag->add(transforms, 1, transformsMessage({{"base_link", "mast", 1, 2, 3, M_PI / 2}}));
  const Eigen::Isometry3d pose = load().T_robot_sensor.value();
  EXPECT_TRUE(pose.translation().isApprox(Eigen::Vector3d(1, 2.5, 3.25))) << pose.translation();
  EXPECT_NEAR(planar(pose).yaw, M_PI / 2, 1e-12);
  options.readsSensorPose = false;
  EXPECT_FALSE(load().T_robot_sensor);
}

TEST_F(Rosbag2Test, TheTimingComesFromThePoints) {
  for (int i = 0; i < 3; ++i)
    bag->add(clouds, i, turningCloud(kStart + 0.1 * i, -1, M_PI, -0.1, 0.1).message());
  const ScanFolder folder = load();
  EXPECT_EQ(folder.timing.turn, Turn::clockwise);
  EXPECT_EQ(folder.timing.stamp, 1);
  expectNote(folder, "turns of 0.1 s, clockwise");
  for (const std::string& note : folder.notes) EXPECT_EQ(note.find("--turn"), std::string::npos);
  options.readsTiming = false;
  EXPECT_EQ(load().timing.turn, Turn::automatic);
}

TEST_F(Rosbag2Test, WithoutTimesTheTimingCanBeStated) {
  writeDrive(3, {});
  expectNote(load(), "no times of their own, or one for all; --turn states it");
}

TEST_F(Rosbag2Test, SeveralTopicsMustBeChosen) {
  writeDrive(2, {});
  bag->add(bag->topic("/rear", pointCloud2), 0, cloudAt(0.05));
  EXPECT_REFUSED(load(), "several topics of sensor_msgs/msg/PointCloud2: ",
                 "/points (2 messages), /rear (1 messages)", "--cloud-topic");
  options.topics.cloud = "/rear";
  EXPECT_EQ(load().scans.size(), 1u);
  bag->add(bag->topic("/wheels", odometry2), 0, odometryAt({0}));
  EXPECT_REFUSED(load(), "/odom (3 messages), /wheels (1 messages)", "--odometry-topic");
  options.topics.odometry = "/odom";
  EXPECT_EQ(load().scans.size(), 1u);
  options.topics.cloud = "/odom";
  EXPECT_REFUSED(load(), "--cloud-topic /odom: no such topic of sensor_msgs/msg/PointCloud2",
                 "there are: /points (2 messages), /rear (1 messages)");
  options.topics = {"/rear", "/odom", "/imu"};
  EXPECT_REFUSED(load(), "--imu-topic /imu: no such topic", "there are: none");
}

TEST_F(Rosbag2Test, RefusesBagsWithoutClouds) {
  bag->add(bag->topic("/packets", "velodyne_msgs/msg/VelodyneScan"), 0, "x");
  EXPECT_REFUSED(load(), "no clouds", "/packets (velodyne_msgs/msg/VelodyneScan, 1 messages)",
                 "driver");
}

// SQLite lists messages by the index of their times.
TEST_F(Rosbag2Test, RefusesAnIndexThatLacksMessages) {
  writeDrive(3, {});
  bag->run(
      "CREATE TABLE none(time INTEGER); CREATE INDEX none_idx ON none (time);"
      "PRAGMA writable_schema = ON; UPDATE sqlite_master SET rootpage = (SELECT rootpage FROM "
      "sqlite_master WHERE name = 'none_idx') WHERE name = 'timestamp_idx'");
  EXPECT_REFUSED(load(), "/points: damaged: it has 3 messages, but lists 0");
}

TEST_F(Rosbag2Test, RefusesAnImuWithoutOdometry) {
  bag->add(clouds, 0, cloudAt(1));
  bag->add(bag->topic("/imu", imu2), 0, imuMessage(1, "imu", {}, 0));
  options.topics.imu = "/imu";
  EXPECT_REFUSED(load(), "--imu-topic gives the yaw only", "nav_msgs/msg/Odometry");
}

TEST_F(Rosbag2Test, RefusesAnImuAtOtherScansThanTheOdometry) {
  for (const double time : {1.0, 2.0}) bag->add(clouds, 0, cloudAt(time));
  bag->add(odometry, 0, odometryAt({1}));
  bag->add(bag->topic("/imu", imu2), 0, imuMessage(kStart + 2, "imu", {}, 0));
  options.topics.imu = "/imu";
  EXPECT_REFUSED(load(), "no scan has both odometry and IMU", "1700000001.000", "1700000002.000");
}

TEST_F(Rosbag2Test, RefusesMessagesThatContradictEachOther) {
  bag->add(clouds, 0, cloudAt(1));
  bag->add(clouds, 1, cloudAt(2, "rear"));
  EXPECT_REFUSED(load(), "/points, message 2: frame rear, that of the clouds before is lidar");
  SetUp();
  for (int i = 0; i < 3; ++i) bag->add(clouds, i, cloudAt(0));
  EXPECT_REFUSED(load(), "/points: the stamps of 2 of 3 clouds are not later");
  SetUp();
  bag->add(clouds, 0, cloudAt(1));
  bag->add(odometry, 1, odometryAt({1}));
  bag->add(odometry, 2, odometryAt({2, 0, 0, 0, {}, "trailer"}));
  EXPECT_REFUSED(load(), "/odom, message 3: child frame trailer");
  SetUp();
  bag->add(clouds, 0, cloudAt(1));
  bag->add(odometry, 1, odometryAt({5}));
  EXPECT_REFUSED(load(), "no odometry at the time of any scan", "1700000005.000");
}

TEST_F(Rosbag2Test, RefusesTruncatedMessages) {
  writeDrive(3, {});
  options.readsTiming = false;
  bag->run("UPDATE messages SET data = substr(data, 1, length(data) - 10) WHERE id = 2");
  const ScanFolder folder = load();  // clouds are read later
  EXPECT_EQ(folder.read(folder.scans[0]).size(), 1u);
  EXPECT_REFUSED(folder.read(folder.scans[1]), "a.db3: /points, message 2: cut short");
  bag->run("UPDATE messages SET data = substr(data, 1, 300) WHERE id = 5");
  EXPECT_REFUSED(load(), "a.db3: /odom, message 5: cut short");
  bag->run("UPDATE messages SET data = substr(data, 1, 9) WHERE id = 3");
  EXPECT_REFUSED(load(), "a.db3: /points, message 3: cut short");
}

TEST_F(Rosbag2Test, TakesPositionsFromSatellites) {
  writeDrive(3, {});
  const int fixes = bag->topic("/fix", fix2);
  bag->add(transforms, 0, transformsMessage({{"base_link", "gnss", -0.5, 0.25, 2, 0}}));
  const double none = std::nan(""), start = kStart;
  const std::vector<TestFix> messages{
      {start, 49, 8, {2, 6}},     {start + 1, none, none},           {start + 2, 49, 8, {2, 6}, 0},
      {start + 3, 49, 8, {0, 0}}, {start + 4, 49, 8, {2, 6}, 2, -1}, {start + 5, 49, 181}};
  for (const TestFix& fix : messages) bag->add(fixes, 0, fixMessage(fix));
  const ScanFolder folder = load();
  expectNote(folder, "/fix: 3 positions from satellites");
  ASSERT_EQ(folder.fixes.size(), 3u);
  EXPECT_EQ(folder.fixes[0].time, kStart);
  EXPECT_EQ(folder.fixes[0].latitude, 49);
  EXPECT_EQ(folder.fixes[0].longitude, 8);
  EXPECT_EQ(folder.fixes[0].sigma, 2);
  EXPECT_EQ(folder.fixes[0].antenna_robot, Eigen::Vector2d(-0.5, 0.25));
  EXPECT_EQ(folder.fixes[1].sigma, 2.5) << "covariance not known";
  EXPECT_EQ(folder.fixes[2].sigma, 2.5) << "no variances";
}

TEST_F(Rosbag2Test, OfSeveralReceiversOneIsChosen) {
  writeDrive(3, {});
  for (const char* name : {"/fix", "/rtk"}) {
    const int topic = bag->topic(name, fix2);
    bag->add(topic, 0, fixMessage({kStart, name == std::string("/fix") ? 49.0 : 50.0, 8}));
  }
  EXPECT_TRUE(load().fixes.empty());
  expectNote(load(), "/fix (1 messages), /rtk (1 messages); none is used");
  options.topics.fixes = "/rtk";
  ASSERT_EQ(load().fixes.size(), 1u);
  EXPECT_EQ(load().fixes[0].latitude, 50);
  EXPECT_EQ(load().fixes[0].antenna_robot, Eigen::Vector2d(0, 0));
  options.topics.fixes = "/points";
  EXPECT_REFUSED(load(), "--gnss-topic /points: no such topic");
}

}  // namespace
}  // namespace polemcl::test_rosbag2
