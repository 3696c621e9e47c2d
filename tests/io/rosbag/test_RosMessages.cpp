#include <functional>
#include <limits>

#include "io/data/Trajectory.h"
#include "io/rosbag/FrameTree.h"
#include "io/rosbag/RosMessages.h"
#include "support/IoFiles.h"
#include "support/RosBags.h"

namespace polemcl::test_ros_messages {

using namespace polemcl::io;
using namespace polemcl::io::test;
using namespace polemcl::tests;

namespace {

/// Each beginning of the message that is too short.
void expectRefusedWhenCut(const std::string& message,
                          const std::function<void(const std::string&)>& decode) {
  for (std::size_t size = 0; size < message.size(); size += 7)
    EXPECT_REFUSED(decode(message.substr(0, size)), "a.db3: ", "cut short");
}

}  // namespace

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
  const auto refusal = [](const CdrWriter& writer) {
    return messageOf([&] { decodeOdometry(writer.message(), "a.db3: "); });
  };
  CdrWriter late;
  late.put(std::int32_t{1}).put(std::uint32_t{1000000000}).text("odom");
  expectIn(refusal(late), "1000000000 nanoseconds; less than");
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

}  // namespace polemcl::test_ros_messages
