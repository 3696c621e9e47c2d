#include "io/rosbag/RosResults.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <sstream>

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

/// By the name without "msg". Members are those since ROS 2 Humble.
const std::map<std::string, std::string>& definitions() {
  static const std::map<std::string, std::string> all{
      {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
      {"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"},
      {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
      {"std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"},
      {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
      {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
      {"geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"},
      {"geometry_msgs/Pose",
       "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
      {"geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"},
      {"geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
      {"geometry_msgs/PoseWithCovarianceStamped",
       "std_msgs/Header header\ngeometry_msgs/PoseWithCovariance pose\n"},
      {"geometry_msgs/Transform",
       "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
      {"geometry_msgs/TransformStamped",
       "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
      {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
      {"nav_msgs/Path", "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n"},
      {"sensor_msgs/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n"},
      {"visualization_msgs/UVCoordinate", "float32 u\nfloat32 v\n"},
      {"visualization_msgs/MeshFile", "string filename\nuint8[] data\n"},
      {"visualization_msgs/Marker",
       "std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\n"
       "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\n"
       "builtin_interfaces/Duration lifetime\nbool frame_locked\ngeometry_msgs/Point[] points\n"
       "std_msgs/ColorRGBA[] colors\nstring texture_resource\n"
       "sensor_msgs/CompressedImage texture\nvisualization_msgs/UVCoordinate[] uv_coordinates\n"
       "string text\nstring mesh_resource\nvisualization_msgs/MeshFile mesh_file\n"
       "bool mesh_use_embedded_materials\n"},
      {"visualization_msgs/MarkerArray", "visualization_msgs/Marker[] markers\n"},
      {"diagnostic_msgs/KeyValue", "string key\nstring value\n"},
      {"diagnostic_msgs/DiagnosticStatus",
       "byte OK=0\nbyte WARN=1\nbyte ERROR=2\nbyte STALE=3\nbyte level\nstring name\n"
       "string message\nstring hardware_id\ndiagnostic_msgs/KeyValue[] values\n"},
      {"diagnostic_msgs/DiagnosticArray",
       "std_msgs/Header header\ndiagnostic_msgs/DiagnosticStatus[] status\n"}};
  return all;
}

/// Appends the definitions of the types in `definition`, each once.
void addParts(const std::string& definition, std::set<std::string>& done, std::string& text) {
  std::istringstream lines(definition);
  for (std::string type, rest; lines >> type && std::getline(lines, rest);) {
    type = type.substr(0, type.find('['));
    const bool isPart = type.find('/') != std::string::npos;
    if (!isPart || !done.insert(type).second) continue;
    const std::string& part = definitions().at(type);
    text += std::string(80, '=') + "\nMSG: " + type + '\n' + part;
    addParts(part, done, text);
  }
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

std::string rosSchema(const std::string& type) {
  const std::string middle = "/msg/";
  std::string name = type;
  if (const auto at = name.find(middle); at != std::string::npos)
    name.replace(at, middle.size(), "/");
  const auto found = definitions().find(name);
  if (found == definitions().end()) throw Error(type + ": no message that is written");
  std::string text = found->second;
  std::set<std::string> done;
  addParts(text, done, text);
  return text;
}

}  // namespace polemcl::io
