#pragma once
/// \file RosbagFixes.h
/// \brief Positions from satellites in a ROS 2 bag.

#include <string>

#include "io/dataset/ScanFolder.h"
#include "io/rosbag/Bag.h"
#include "io/rosbag/FrameTree.h"

namespace polemcl::io {

/// \brief Adds the fixes of a topic of sensor_msgs/msg/NavSatFix, with a note.
///
/// Messages without a fix are left out. The sigma is the root of the mean of the two horizontal
/// variances; where none are stated, kAssumedFixSigma.
/// \param topic Index in bag.topics().
/// \param frames Static transforms; without one to the frame of the fixes, the antenna is taken to
///        be at the robot.
/// \param robot Frame of the robot.
/// \throws Error as decodeNavSatFix().
void addRosbagFixes(const Bag& bag, std::size_t topic, const FrameTree& frames,
                    const std::string& robot, ScanFolder& folder);

}  // namespace polemcl::io
