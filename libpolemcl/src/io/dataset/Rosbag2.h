#pragma once
/// \file Rosbag2.h
/// \brief Recordings of ROS 2 in SQLite (`.db3`) and MCAP, read without ROS.

#include "io/dataset/ScanFolder.h"

namespace polemcl::io {

/// \brief Names of topics. An empty one stands for the only topic of its type.
struct RosbagTopics {
  std::string cloud;       ///< sensor_msgs/msg/PointCloud2
  std::string odometry;    ///< nav_msgs/msg/Odometry; there may be none
  std::string imu;         ///< sensor_msgs/msg/Imu; if it is empty, no IMU is used
  std::string fixes = {};  ///< sensor_msgs/msg/NavSatFix; there may be none
};

/// \brief What to take from a bag.
struct Rosbag2Options {
  RosbagTopics topics;
  bool readsSensorPose = true;  ///< from /tf_static
  bool readsOdometry = true;    ///< the motions; if not, its topic only names the robot
  bool readsTiming = true;      ///< from the times of the points
};

/// \brief Reads the clouds of a topic, with the motions between them.
///
/// Times of the scans are the stamps of their headers. There is no truth. The motions come from the
/// odometry, see addRosbagMotions(); without odometry there are none. The robot frame is the child
/// frame of the odometry, or `base_link` without odometry. The pose of the sensor is the static
/// transform from the frame of the clouds to that frame; without it nothing is set, with a note.
/// The timing comes from the times of the points, see TimingEstimate. Positions from satellites are
/// those of the only topic of their type; if several have them and none is chosen, there are none,
/// with a note. Scans whose stamps do not increase are left out: the fewest possible.
/// \param bag Folder, or one `.db3` or `.mcap` file.
/// \throws Error with the file, the topic and the id of the message: as Bag, several topics of a
///         type and none of them chosen, no clouds, stamps that do not increase, a message that
///         cannot be decoded, odometry at the time of no scan.
ScanFolder readRosbag2(const std::filesystem::path& bag, const Rosbag2Options& options);

}  // namespace polemcl::io
