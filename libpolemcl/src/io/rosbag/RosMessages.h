#pragma once
/// \file RosMessages.h
/// \brief Messages of ROS 2 that bags hold: clouds, odometry, IMU, transforms, positions.

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <polemcl/io/rosbag/PackedCloud.h>
#include "io/rosbag/Cdr.h"

namespace polemcl::io {

/// \brief Names of the types, as bags state them.
constexpr const char *kCloudType = "sensor_msgs/msg/PointCloud2",
                     *kOdometryType = "nav_msgs/msg/Odometry", *kImuType = "sensor_msgs/msg/Imu",
                     *kTransformsType = "tf2_msgs/msg/TFMessage",
                     *kFixType = "sensor_msgs/msg/NavSatFix";

/// \brief std_msgs/msg/Header.
struct RosHeader {
  double time = 0;    ///< the stamp, s
  std::string frame;  ///< without a slash at its begin
};

/// \brief sensor_msgs/msg/PointCloud2, in the frame of its header.
struct RosCloud : TimedCloud {
  RosHeader header;
};

/// \brief nav_msgs/msg/Odometry.
struct RosOdometry {
  RosHeader header;
  std::string child;                              ///< frame of the robot
  std::optional<Eigen::Isometry3d> T_odom_child;  ///< m
  /// Covariance of (vx, vy, vz, wx, wy, wz) in the child frame; m, rad, s. As stored, not checked.
  Eigen::Matrix<double, 6, 6> twistCovariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// \brief sensor_msgs/msg/Imu without orientation and acceleration.
struct RosImu {
  RosHeader header;
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();  ///< angular velocity, rad/s, frame of the IMU
  Eigen::Matrix3d rateCovariance = Eigen::Matrix3d::Zero();  ///< (rad/s)², as stored
};

/// \brief One transform of a tf2_msgs/msg/TFMessage.
struct RosTransform {
  RosHeader header;  ///< its frame is the parent
  std::string child;
  std::optional<Eigen::Isometry3d> T_parent_child;  ///< m
};

/// \brief sensor_msgs/msg/NavSatFix without height. Its numbers are as stored, not checked: they
/// may be NaN where there is no fix.
struct RosNavSatFix {
  RosHeader header;                                      ///< its frame is that of the antenna
  std::int8_t status = 0;                                ///< negative: no fix
  double latitude = 0, longitude = 0;                    ///< deg on WGS 84
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (east, north, up), m²
  int covarianceType = 0;                                ///< 0: the covariance is not known
};

/// \brief Decode the message. \param where Prefix of error messages.
/// There is no pose if one of its numbers is not finite, or its quaternion is not of unit length
/// (1 % off at most).
/// \throws Error when the message is cut short, another number is not finite, or nanoseconds are a
///         second or more; for clouds as unpack(), too.
RosHeader readHeader(CdrReader& reader);
/// \param withTimes Whether to read the times of the points.
RosCloud decodeCloud(std::string_view message, const std::string& where, bool withTimes);
RosOdometry decodeOdometry(std::string_view message, const std::string& where);
RosImu decodeImu(std::string_view message, const std::string& where);
RosNavSatFix decodeNavSatFix(std::string_view message, const std::string& where);
std::vector<RosTransform> decodeTransforms(std::string_view message, const std::string& where);

}  // namespace polemcl::io
