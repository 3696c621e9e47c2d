#pragma once
/// \file Messages.h
/// \brief From messages of ROS to what polemcl takes, and back.

#include <Eigen/Geometry>
#include <cstddef>
#include <diagnostic_msgs/msg/diagnostic_array.hpp>
#include <geometry_msgs/msg/pose_with_covariance_stamped.hpp>
#include <geometry_msgs/msg/transform_stamped.hpp>
#include <nav_msgs/msg/odometry.hpp>
#include <sensor_msgs/msg/point_cloud2.hpp>
#include <string>
#include <vector>
#include <visualization_msgs/msg/marker_array.hpp>

#include <polemcl/polemcl.h>

namespace polemcl_ros {

/// \brief A stamp in s.
double secondsOf(const builtin_interfaces::msg::Time& stamp);
/// \brief The yaw and place of a pose, rad and m.
/// \throws Error when its quaternion is not of unit length (1 % off at most), or z points down.
polemcl::Pose2D planar(const geometry_msgs::msg::Pose& pose);
Eigen::Isometry3d isometryOf(const geometry_msgs::msg::Transform& transform);

/// \brief The cloud; its bytes stay in the message.
polemcl::io::PackedCloud packedOf(const sensor_msgs::msg::PointCloud2& message);
/// \throws Error as planar().
polemcl::OdometryReading readingOf(const nav_msgs::msg::Odometry& message);
/// \brief A pose of an operator with its covariance of (x, y, yaw). \throws Error as planar().
polemcl::PoseWithCovariance guessOf(const geometry_msgs::msg::PoseWithCovarianceStamped& message);

geometry_msgs::msg::PoseWithCovarianceStamped poseMessage(
    const std_msgs::msg::Header& header, const polemcl::PoseWithCovariance& estimate);
/// \brief Without header and child.
geometry_msgs::msg::Transform transformOf(const polemcl::Pose2D& pose);
/// \brief `sensor` names the LiDAR. \param jumps Localizer::odometryJumps().
diagnostic_msgs::msg::DiagnosticArray diagnosticsOf(const polemcl::LocalizationUpdate& update,
                                                    std::size_t jumps,
                                                    const std_msgs::msg::Header& header,
                                                    const std::string& sensor);
/// \brief What went wrong with a scan. \param header That of its cloud.
diagnostic_msgs::msg::DiagnosticArray failureOf(const std::string& what,
                                                const std_msgs::msg::Header& header);

/// \brief Cylinders for the poles of a map, and for those seen in a scan; they replace the ones
/// before.
visualization_msgs::msg::MarkerArray markersOf(const std::vector<polemcl::MapPole>& poles,
                                               const std_msgs::msg::Header& header);
visualization_msgs::msg::MarkerArray markersOf(const std::vector<polemcl::PoleDetection>& poles,
                                               const std_msgs::msg::Header& header);

}  // namespace polemcl_ros
