#include "Messages.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace polemcl_ros {
namespace {

/// Places of x, y, yaw among x, y, z, roll, pitch, yaw.
constexpr int kPlanar[] = {0, 1, 5};

template <class Covariance>
Eigen::Matrix3d planarOf(const Covariance& covariance) {
  Eigen::Matrix3d result;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      result(row, column) = covariance[6 * kPlanar[row] + kPlanar[column]];
  return result;
}

visualization_msgs::msg::Marker allDeleted(const std_msgs::msg::Header& header) {
  visualization_msgs::msg::Marker marker;
  marker.header = header;
  marker.action = visualization_msgs::msg::Marker::DELETEALL;
  return marker;
}

/// The marker of a pole. \tparam Pole MapPole or PoleDetection.
template <class Pole>
visualization_msgs::msg::Marker markerOf(const Pole& pole, const std_msgs::msg::Header& header) {
  visualization_msgs::msg::Marker marker;
  marker.header = header;
  marker.type = visualization_msgs::msg::Marker::CYLINDER;
  marker.pose.position.x = pole.x;
  marker.pose.position.y = pole.y;
  marker.pose.position.z = (pole.bottom + pole.top) / 2;
  marker.scale.x = marker.scale.y = 2 * pole.radius;
  marker.scale.z = std::max(0.1, pole.top - pole.bottom);  // not seen if it is flat
  return marker;
}

template <class Pole>
visualization_msgs::msg::MarkerArray markersIn(const std::vector<Pole>& poles,
                                               const std_msgs::msg::Header& header,
                                               const std_msgs::msg::ColorRGBA& color) {
  visualization_msgs::msg::MarkerArray array;
  array.markers.push_back(allDeleted(header));
  for (const Pole& pole : poles) {
    array.markers.push_back(markerOf(pole, header));
    array.markers.back().id = static_cast<int>(array.markers.size());
    array.markers.back().color = color;
  }
  return array;
}

std_msgs::msg::ColorRGBA colorOf(float red, float green, float blue) {
  std_msgs::msg::ColorRGBA color;
  color.r = red;
  color.g = green;
  color.b = blue;
  color.a = 1;
  return color;
}

diagnostic_msgs::msg::DiagnosticArray arrayOf(const std_msgs::msg::Header& header,
                                              diagnostic_msgs::msg::DiagnosticStatus status) {
  status.name = "polemcl: localization";
  diagnostic_msgs::msg::DiagnosticArray array;
  array.header.stamp = header.stamp;
  array.status.push_back(std::move(status));
  return array;
}

unsigned char levelOf(polemcl::HealthState state) {
  using diagnostic_msgs::msg::DiagnosticStatus;
  if (state == polemcl::HealthState::ok) return DiagnosticStatus::OK;
  return state == polemcl::HealthState::degraded ? DiagnosticStatus::WARN : DiagnosticStatus::ERROR;
}

}  // namespace

double secondsOf(const builtin_interfaces::msg::Time& stamp) {
  return stamp.sec + stamp.nanosec * 1e-9;
}

polemcl::Pose2D planar(const geometry_msgs::msg::Pose& pose) {
  const auto& q = pose.orientation;
  const Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
  if (!(std::abs(rotation.norm() - 1) < 0.01))
    throw polemcl::Error("the quaternion of the pose has length " +
                         std::to_string(rotation.norm()) + "; 1 is expected");
  const Eigen::Matrix3d axes = rotation.normalized().toRotationMatrix();
  if (!(axes(2, 2) > 0))
    throw polemcl::Error(
        "the z axis of the pose points down; a frame with x ahead and z up is expected");
  return {pose.position.x, pose.position.y, std::atan2(axes(1, 0), axes(0, 0))};
}

Eigen::Isometry3d isometryOf(const geometry_msgs::msg::Transform& transform) {
  const auto& q = transform.rotation;
  Eigen::Isometry3d result(Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized());
  const auto& t = transform.translation;
  result.translation() = Eigen::Vector3d(t.x, t.y, t.z);
  return result;
}

polemcl::io::PackedCloud packedOf(const sensor_msgs::msg::PointCloud2& message) {
  polemcl::io::PackedCloud packed;
  packed.stamp = secondsOf(message.header.stamp);
  packed.rows = message.height;
  packed.columns = message.width;
  packed.pointBytes = message.point_step;
  packed.rowBytes = message.row_step;
  packed.bigEndian = message.is_bigendian;
  for (const auto& field : message.fields)
    packed.fields.push_back({field.name, field.offset, field.datatype});
  packed.data = {reinterpret_cast<const char*>(message.data.data()), message.data.size()};
  return packed;
}

polemcl::OdometryReading readingOf(const nav_msgs::msg::Odometry& message) {
  const auto& twist = message.twist.twist;
  polemcl::OdometryReading reading;
  reading.time = secondsOf(message.header.stamp);
  reading.pose = planar(message.pose.pose);
  reading.velocity = polemcl::Velocity{twist.linear.x, twist.linear.y, twist.angular.z};
  reading.velocityCovariance = planarOf(message.twist.covariance);
  return reading;
}

polemcl::PoseWithCovariance guessOf(const geometry_msgs::msg::PoseWithCovarianceStamped& message) {
  return {planar(message.pose.pose), planarOf(message.pose.covariance)};
}

geometry_msgs::msg::PoseWithCovarianceStamped poseMessage(
    const std_msgs::msg::Header& header, const polemcl::PoseWithCovariance& estimate) {
  geometry_msgs::msg::PoseWithCovarianceStamped message;
  message.header = header;
  const auto transform = transformOf(estimate.mean);
  message.pose.pose.position.x = transform.translation.x;
  message.pose.pose.position.y = transform.translation.y;
  message.pose.pose.orientation = transform.rotation;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      message.pose.covariance[6 * kPlanar[row] + kPlanar[column]] =
          estimate.covariance(row, column);
  return message;
}

geometry_msgs::msg::Transform transformOf(const polemcl::Pose2D& pose) {
  geometry_msgs::msg::Transform transform;
  transform.translation.x = pose.x;
  transform.translation.y = pose.y;
  transform.rotation.z = std::sin(pose.yaw / 2);
  transform.rotation.w = std::cos(pose.yaw / 2);
  return transform;
}

diagnostic_msgs::msg::DiagnosticArray diagnosticsOf(const polemcl::LocalizationUpdate& update,
                                                    std::size_t jumps,
                                                    const std_msgs::msg::Header& header,
                                                    const std::string& sensor) {
  const polemcl::Health& health = update.health;
  diagnostic_msgs::msg::DiagnosticStatus status;
  status.level = levelOf(health.state);
  status.hardware_id = sensor;
  status.message = polemcl::name(health.state);
  if (health.state != polemcl::HealthState::ok)
    status.message += std::string(": ") + polemcl::name(health.reason);
  const auto add = [&](const char* key, double value) {
    std::ostringstream text;
    text << value;
    status.values.emplace_back();
    status.values.back().key = key;
    status.values.back().value = text.str();
  };
  add("poles in the scan", static_cast<double>(update.poles));
  add("share of poles on the map", health.matchedShare);
  add("poles seen, share of the usual", health.seenShare);
  add("innovation, 1 expected", health.innovation);
  add("spread, m", health.spread);
  add("spread of the heading, rad", health.spreadHeading);
  add("share of the best place", health.modeShare);
  add("effective particles", health.effectiveParticles);
  add("jumps of the odometry so far", static_cast<double>(jumps));
  return arrayOf(header, std::move(status));
}

diagnostic_msgs::msg::DiagnosticArray failureOf(const std::string& what,
                                                const std_msgs::msg::Header& header) {
  diagnostic_msgs::msg::DiagnosticStatus status;
  status.level = diagnostic_msgs::msg::DiagnosticStatus::ERROR;
  status.hardware_id = header.frame_id;
  status.message = what;
  return arrayOf(header, std::move(status));
}

visualization_msgs::msg::MarkerArray markersOf(const std::vector<polemcl::MapPole>& poles,
                                               const std_msgs::msg::Header& header) {
  return markersIn(poles, header, colorOf(0.5f, 0.5f, 0.5f));
}

visualization_msgs::msg::MarkerArray markersOf(const std::vector<polemcl::PoleDetection>& poles,
                                               const std_msgs::msg::Header& header) {
  return markersIn(poles, header, colorOf(1, 0.5f, 0));
}

}  // namespace polemcl_ros
