#pragma once
/// \file RosSchemas.h
/// \brief Definitions of the messages of ROS 2 that are written, as text.

#include <string>

namespace polemcl::io {

/// \brief The definition of a type with those of all types in it, as `ros2msg` states them.
/// \param type "nav_msgs/msg/Path". \throws Error when it is not one that is written.
std::string rosSchema(const std::string& type);

}  // namespace polemcl::io
