#pragma once
/// \file PointCloud2.h
/// \brief Clouds of ROS 2, with the times of their points.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <polemcl/io/data/Cloud.h>
#include "io/rosbag/RosMessages.h"

namespace polemcl::io {

/// \brief A cloud with what ROS says of it.
struct RosCloud {
  RosHeader header;
  Cloud cloud;  ///< in the frame of the header
  /// Time from the stamp to each point of `cloud`, s; empty if the points have no times.
  std::vector<double> offsets;
};

/// \brief Decodes a sensor_msgs/msg/PointCloud2.
///
/// Points need the fields x, y and z (float32); `intensity` may be of any type, and is 0 where it
/// is missing. Times are in the first of the fields `t`, `time`, `timestamp`, `time_stamp` and
/// `offset_time` that is there: uint32 in ns, float32 or float64 in s, since the stamp. A float64
/// is a time since 1970 if it is above 1e8 s, in ns if it is above 1e17. Other fields are not read.
/// Invalid points are dropped and counted as in readKittiBin().
/// \param withTimes Whether to read the times. \param where Prefix of error messages.
/// \throws Error when the message is cut short, its sizes contradict each other, a field has
///         another type or lies outside its point, or a time is not finite.
RosCloud decodeCloud(std::string_view message, const std::string& where, bool withTimes);

}  // namespace polemcl::io
