#pragma once
/// \file PointCloud2.h
/// \brief Clouds of ROS 2, with the times of their points.

#include <string>
#include <string_view>

#include <polemcl/io/rosbag/PackedCloud.h>
#include "io/rosbag/RosMessages.h"

namespace polemcl::io {

/// \brief A cloud in the frame of its header.
struct RosCloud : TimedCloud {
  RosHeader header;
};

/// \brief Decodes a sensor_msgs/msg/PointCloud2. \param withTimes Whether to read the times.
/// \param where Prefix of error messages.
/// \throws Error when the message is cut short, and as unpack().
RosCloud decodeCloud(std::string_view message, const std::string& where, bool withTimes);

}  // namespace polemcl::io
