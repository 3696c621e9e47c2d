#include "io/rosbag/RosResults.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "io/rosbag/Cdr.h"

namespace polemcl::io {

namespace {

constexpr std::uint64_t kSecond = 1000000000;
/// Markers without size are not drawn.
constexpr double kLeastRadius = 0.05, kLeastHeight = 0.1;
/// Numbers of the type and the actions in visualization_msgs/msg/Marker.
constexpr std::int32_t kCylinder = 3, kAdd = 0, kDeleteAll = 3;

void putHeader(CdrEncoder& message, const RosStamp& stamp) {
  const std::uint64_t time = rosNanoseconds(stamp.time);
  message.put(static_cast<std::int32_t>(time / kSecond));
  message.put(static_cast<std::uint32_t>(time % kSecond));
  message.putText(stamp.frame);
}

/// Position and quaternion; translation and rotation of a transform are the same.
void putPlanarPose(CdrEncoder& message, const Pose2D& pose, double z = 0) {
  for (const double value : {pose.x, pose.y, z, 0.0, 0.0}) message.put(value);
  message.put(std::sin(pose.yaw / 2));
  message.put(std::cos(pose.yaw / 2));
}

/// The members of a Marker after its frame_locked: what cylinders do not need.
void putUnusedMembers(CdrEncoder& message) {
  message.putCount(0);           // points
  message.putCount(0);           // colors
  message.putText("");           // texture_resource
  putHeader(message, {});        // texture
  message.putText("");           // its format
  message.putCount(0);           // its data
  message.putCount(0);           // uv_coordinates
  message.putText("");           // text
  message.putText("");           // mesh_resource
  message.putText("");           // mesh_file
  message.putCount(0);           // its data
  message.put(std::uint8_t{0});  // mesh_use_embedded_materials
}

void putMarker(CdrEncoder& message, const RosStamp& stamp, const std::string& name, std::int32_t id,
               std::int32_t action, const PoleMarker& pole) {
  putHeader(message, stamp);
  message.putText(name);
  for (const std::int32_t value : {id, kCylinder, action}) message.put(value);
  putPlanarPose(message, {pole.x, pole.y, 0}, (pole.bottom + pole.top) / 2);
  const double diameter = 2 * std::max(pole.radius, kLeastRadius);
  for (const double size : {diameter, diameter, std::max(pole.top - pole.bottom, kLeastHeight)})
    message.put(size);
  for (const float part : {pole.red, pole.green, pole.blue, 1.0f}) message.put(part);
  message.put(std::int32_t{0});  // lifetime: for ever
  message.put(std::uint32_t{0});
  message.put(std::uint8_t{0});  // frame_locked
  putUnusedMembers(message);
}

}  // namespace

std::uint64_t rosNanoseconds(double time) {
  const bool inRange = time >= 0 && time < 2147483648.0;
  if (!inRange)
    throw Error("time " + std::to_string(time) +
                " s: bags of ROS 2 state times from 0 to 2147483647 s since 1970");
  const double whole = std::floor(time);
  return static_cast<std::uint64_t>(whole) * kSecond +
         static_cast<std::uint64_t>(std::llround((time - whole) * 1e9));
}

std::string encodePose(const RosStamp& stamp, const PoseWithCovariance& pose) {
  CdrEncoder message;
  putHeader(message, stamp);
  putPlanarPose(message, pose.mean);
  const int planar[6] = {0, 1, -1, -1, -1, 2};  // of x, y, z, roll, pitch, yaw
  for (const int row : planar)
    for (const int column : planar)
      message.put(row < 0 || column < 0 ? 0.0 : pose.covariance(row, column));
  return message.message();
}

std::string encodeTransform(const RosStamp& stamp, const std::string& child, const Pose2D& pose) {
  CdrEncoder message;
  message.putCount(1);
  putHeader(message, stamp);
  message.putText(child);
  putPlanarPose(message, pose);
  return message.message();
}

std::string encodePath(const RosStamp& stamp, const std::vector<StampedPose2D>& poses) {
  CdrEncoder message;
  putHeader(message, stamp);
  message.putCount(poses.size());
  for (const StampedPose2D& pose : poses) {
    putHeader(message, {pose.time, stamp.frame});
    putPlanarPose(message, pose.pose);
  }
  return message.message();
}

std::string encodePoles(const RosStamp& stamp, const std::string& name,
                        const std::vector<PoleMarker>& poles) {
  CdrEncoder message;
  message.putCount(poles.size() + 1);
  putMarker(message, stamp, name, 0, kDeleteAll, {});
  for (std::size_t i = 0; i < poles.size(); ++i)
    putMarker(message, stamp, name, static_cast<std::int32_t>(i), kAdd, poles[i]);
  return message.message();
}

std::string encodeDiagnostic(const RosStamp& stamp, const RosDiagnostic& diagnostic) {
  CdrEncoder message;
  putHeader(message, stamp);
  message.putCount(1);
  message.put(static_cast<std::uint8_t>(diagnostic.level));
  message.putText(diagnostic.name);
  message.putText(diagnostic.message);
  message.putText("");  // hardware_id
  message.putCount(diagnostic.values.size());
  for (const auto& [key, value] : diagnostic.values) {
    message.putText(key);
    message.putText(value);
  }
  return message.message();
}

}  // namespace polemcl::io
