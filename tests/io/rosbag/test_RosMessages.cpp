#include <functional>
#include <limits>

#include "io/data/Trajectory.h"
#include "io/dataset/RosbagMotions.h"
#include "io/rosbag/RosMessages.h"
#include "support/IoFiles.h"
#include "support/RosBags.h"

namespace polemcl::test_ros_messages {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;
using namespace polemcl::tests;

/// Each beginning of the message that is too short.
void expectRefusedWhenCut(const std::string& message,
                          const std::function<void(const std::string&)>& decode) {
  for (std::size_t size = 0; size < message.size(); size += 7)
    EXPECT_REFUSED(decode(message.substr(0, size)), "a.db3: ", "cut short");
}

RosCloud decode(const TestCloud& cloud) {
  return decodeCloud(cloud.message(), "a.db3: ", true);
}

/// A point at (1, 2, 3) whose time field holds this value.
template <class T>
TestCloud timed(const std::string& name, std::uint8_t type, T time) {
  TestCloud cloud;
  cloud.time = 1700000000.25;
  cloud.fields.push_back({name, 16, type});
  cloud.pointBytes = 16 + sizeof(T);
  cloud.point(1, 2, 3, 4).put(time);
  return cloud;
}

TEST(RosMessages, OdometryInBothByteOrders) {
  for (const bool bigEndian : {false, true}) {
    const auto message = odometryMessage({1700000000.25, 1.5, -2, 0.5, {1, 2, 3}}, bigEndian);
    const RosOdometry odometry = decodeOdometry(message, "a.db3: ");
    EXPECT_EQ(odometry.header.time, 1700000000.25);
    EXPECT_EQ(odometry.header.frame, "odom");
    EXPECT_EQ(odometry.child, "base_link");
    const Pose2D pose = planar(*odometry.T_odom_child);
    EXPECT_EQ(pose.x, 1.5);
    EXPECT_EQ(pose.y, -2);
    EXPECT_NEAR(pose.yaw, 0.5, 1e-12);
    EXPECT_EQ(odometry.twistCovariance.diagonal(),
              (Eigen::Matrix<double, 6, 1>() << 1, 2, 0, 0, 0, 3).finished());
  }
  expectRefusedWhenCut(odometryMessage({}),
                       [](const std::string& part) { decodeOdometry(part, "a.db3: "); });
}

TEST(RosMessages, Imu) {
  const auto message = imuMessage(12.5, "/imu", {1, 2, 3}, 0.25);
  const RosImu imu = decodeImu(message, "a.db3: ");
  EXPECT_EQ(imu.header.frame, "imu") << "without the slash of ROS 1";
  EXPECT_EQ(imu.rate, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(imu.rateCovariance, Eigen::Matrix3d(0.25 * Eigen::Matrix3d::Identity()));
  expectRefusedWhenCut(message, [](const std::string& part) { decodeImu(part, "a.db3: "); });
}

TEST(RosMessages, NavSatFixInBothByteOrders) {
  for (const bool bigEndian : {false, true}) {
    const auto message = fixMessage({12.5, 49, -8.5, {4, 9}, 3, -1, "/gnss"}, bigEndian);
    const RosNavSatFix fix = decodeNavSatFix(message, "a.db3: ");
    EXPECT_EQ(fix.header.time, 12.5);
    EXPECT_EQ(fix.header.frame, "gnss");
    EXPECT_EQ(fix.status, -1);
    EXPECT_EQ(fix.latitude, 49);
    EXPECT_EQ(fix.longitude, -8.5);
    EXPECT_EQ(fix.covariance.diagonal(), Eigen::Vector3d(4, 9, 100));
    EXPECT_EQ(fix.covarianceType, 3);
  }
  expectRefusedWhenCut(fixMessage({}),
                       [](const std::string& part) { decodeNavSatFix(part, "a.db3: "); });
}

TEST(RosMessages, Transforms) {
  const auto message = transformsMessage({{"base_link", "mast", 1, 2, 3, 0}, {"mast", "lidar"}});
  const auto transforms = decodeTransforms(message, "a.db3: ");
  ASSERT_EQ(transforms.size(), 2u);
  EXPECT_EQ(transforms[0].header.frame, "base_link");
  EXPECT_EQ(transforms[0].child, "mast");
  EXPECT_EQ(transforms[0].T_parent_child->translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(transforms[1].child, "lidar");
  expectRefusedWhenCut(message, [](const std::string& part) { decodeTransforms(part, "a.db3: "); });
}

TEST(RosMessages, RefusesNonsense) {
  CdrWriter late;
  late.put(std::int32_t{1}).put(std::uint32_t{1000000000}).text("odom");
  EXPECT_REFUSED(decodeOdometry(late.message(), "a.db3: "), "1000000000 nanoseconds; less than");
}

TEST(RosMessages, NonsenseIsNoPose) {
  CdrWriter zero, nan;
  zero.header(1, "odom").text("base_link").zeros(7).zeros(100);
  EXPECT_FALSE(decodeOdometry(zero.message(), "").T_odom_child);
  nan.header(1, "odom").text("base_link");
  nan.pose(std::numeric_limits<double>::quiet_NaN(), 0, 0, 0).zeros(100);
  EXPECT_FALSE(decodeOdometry(nan.message(), "").T_odom_child);
}

TEST(FrameTree, ComposesUpAndDown) {
  FrameTree tree;
  tree.add("base_link", "mast", spatial({1, 2, M_PI / 2}));
  tree.add("mast", "lidar", spatial({3, 0, 0}));
  tree.add("footprint", "base_link", spatial({0.5, 0, 0}));
  tree.add("base_link", "imu", spatial({0, 1, 0}));
  const auto lidar = planar(*tree.find("base_link", "lidar"));
  EXPECT_NEAR(lidar.x, 1, 1e-12);
  EXPECT_NEAR(lidar.y, 2 + 3, 1e-12) << "the mast looks left";
  EXPECT_NEAR(lidar.yaw, M_PI / 2, 1e-12);
  EXPECT_NEAR(planar(*tree.find("imu", "lidar")).y, 4, 1e-12) << "by the common parent";
  EXPECT_NEAR(planar(*tree.find("base_link", "footprint")).x, -0.5, 1e-12) << "upwards";
  EXPECT_TRUE(tree.find("camera", "camera")->isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_FALSE(tree.find("base_link", "camera"));
}

TEST(FrameTree, CirclesEnd) {
  FrameTree tree;
  tree.add("a", "b", Eigen::Isometry3d::Identity());
  tree.add("b", "a", Eigen::Isometry3d::Identity());
  EXPECT_FALSE(tree.find("c", "a"));
  EXPECT_TRUE(tree.find("a", "b"));
}

TEST(PointCloud2, PointsArriveBitByBit) {
  const float tiny = std::numeric_limits<float>::denorm_min(), third = 1.0f / 3;
  for (const bool bigEndian : {false, true}) {
    TestCloud cloud;
    cloud.bigEndian = bigEndian;
    cloud.time = 5.5;
    cloud.point(third, -tiny, 3e38f, 0.1f).point(-0.7f, 8, 9, 255);
    const RosCloud read = decode(cloud);
    EXPECT_EQ(read.header.time, 5.5);
    EXPECT_EQ(read.header.frame, "lidar");
    EXPECT_EQ(read.cloud.x, (std::vector<float>{third, -0.7f}));
    EXPECT_EQ(read.cloud.y, (std::vector<float>{-tiny, 8}));
    EXPECT_EQ(read.cloud.z, (std::vector<float>{3e38f, 9}));
    EXPECT_EQ(read.cloud.intensity, (std::vector<float>{0.1f, 255}));
    EXPECT_TRUE(read.offsets.empty());
  }
}

TEST(PointCloud2, FieldsInAnyOrderAndRowsWithPadding) {
  TestCloud cloud;
  cloud.fields = {{"ring", 0, 4}, {"intensity", 2, 4}, {"z", 4, 7}, {"y", 8, 7}, {"x", 12, 7}};
  cloud.height = 2;
  cloud.width = 1;
  cloud.rowBytes = 20;  // four bytes of padding
  cloud.put(std::uint16_t{9}).put(std::uint16_t{300}).put(3.f).put(2.f).put(1.f).put(99.f);
  cloud.put(std::uint16_t{9}).put(std::uint16_t{7}).put(6.f).put(5.f).put(4.f).put(99.f);
  const RosCloud read = decode(cloud);
  EXPECT_EQ(read.cloud.x, (std::vector<float>{1, 4}));
  EXPECT_EQ(read.cloud.z, (std::vector<float>{3, 6}));
  EXPECT_EQ(read.cloud.intensity, (std::vector<float>{300, 7}));
}

TEST(PointCloud2, InvalidPointsAreCountedAndEmptyCloudsAreEmpty) {
  TestCloud cloud;
  cloud.point(std::numeric_limits<float>::quiet_NaN(), 0, 0, 1).point(0, 0, 0, 1);
  EXPECT_EQ(decode(cloud).cloud.invalid, 2u);
  EXPECT_EQ(decode(TestCloud{}).cloud.size(), 0u);
}

TEST(PointCloud2, TimesOfAllKinds) {
  const double stamp = 1700000000.25;
  EXPECT_NEAR(decode(timed("t", 6, std::uint32_t{50000000})).offsets.at(0), 0.05, 1e-12);
  EXPECT_NEAR(decode(timed("time", 7, -0.03f)).offsets.at(0), -0.03, 1e-8);
  EXPECT_NEAR(decode(timed("offset_time", 8, 0.02)).offsets.at(0), 0.02, 1e-12);
  EXPECT_NEAR(decode(timed("timestamp", 8, stamp + 0.08)).offsets.at(0), 0.08, 1e-6);
  EXPECT_NEAR(decode(timed("time_stamp", 8, (stamp + 0.08) * 1e9)).offsets.at(0), 0.08, 1e-6);
  EXPECT_TRUE(decodeCloud(timed("t", 6, std::uint32_t{5}).message(), "", false).offsets.empty());
  EXPECT_NEAR(decode(timed("t", 8, (stamp + 0.08) * 1e3)).offsets.at(0), 0.08, 1e-6);
  EXPECT_NEAR(decode(timed("t", 8, (stamp + 0.08) * 1e6)).offsets.at(0), 0.08, 1e-6);
}

TEST(PointCloud2, TimesOfASimulatedClock) {
  TestCloud cloud = timed("timestamp", 8, 10.05);
  cloud.time = 10;
  EXPECT_NEAR(decode(cloud).offsets.at(0), 0.05, 1e-12);
}

TEST(PointCloud2, TimesThatAreNoneLeaveThePoints) {
  TestCloud cloud = timed("t", 8, 0.05);
  cloud.point(1, 2, 3, 4).put(std::nan(""));
  for (const TestCloud& untimed : {cloud, timed("t", 4, std::uint16_t{5})}) {
    const RosCloud read = decode(untimed);
    EXPECT_EQ(read.cloud.size(), untimed.width);
    EXPECT_TRUE(read.offsets.empty());
  }
}

TEST(PointCloud2, CoordinatesOfDoublePrecision) {
  TestCloud cloud;
  cloud.fields = {{"x", 0, 8}, {"y", 8, 8}, {"z", 16, 8}};
  cloud.pointBytes = 24;
  cloud.width = 1;
  cloud.put(1.5).put(-2.0).put(0.25);
  EXPECT_EQ(decode(cloud).cloud.y, std::vector<float>{-2});
}

TEST(PointCloud2, RefusesSizesThatDoNotFit) {
  TestCloud good;
  good.point(1, 2, 3, 4).point(1, 2, 3, 4);
  TestCloud bad = good;
  bad.width = 3;
  EXPECT_REFUSED(decode(bad),
                 "a.db3: cut short: 32 bytes of points; 1 rows of 3 points of 16 bytes");
  bad = good;
  bad.height = bad.width = 0xffffffff;
  bad.rowBytes = 16;
  EXPECT_REFUSED(decode(bad), "cut short");
  bad = good;
  bad.pointBytes = 0;
  EXPECT_REFUSED(decode(bad), "points of 0 bytes");
  bad = good;
  bad.fields[2].offset = 13;
  EXPECT_REFUSED(decode(bad), "the field z lies outside its point of 16 bytes");
  bad = good;
  bad.fields[1].type = 5;
  EXPECT_REFUSED(decode(bad), "no field y of float32 or float64");
  bad = good;
  bad.fields[3].type = 9;
  EXPECT_REFUSED(decode(bad), "the field intensity has the type 9; 1 to 8");
  const std::string message = good.message();
  for (std::size_t size = 0; size < message.size(); ++size)
    EXPECT_REFUSED(decodeCloud(message.substr(0, size), "a.db3: ", true), "a.db3: ", "cut short");
}

}  // namespace
}  // namespace polemcl::test_ros_messages
