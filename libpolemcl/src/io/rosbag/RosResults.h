#pragma once
/// \file RosResults.h
/// \brief Messages of ROS 2 that show a localization: poses, transforms, poles, health.
///
/// Poses are planar: z, roll and pitch are 0, with variance 0.

#include <string>
#include <utility>
#include <vector>

#include <polemcl/core/common/Types.h>

namespace polemcl::io {

/// \brief Names of the types, as bags state them.
constexpr const char *kPoseType = "geometry_msgs/msg/PoseWithCovarianceStamped",
                     *kPathType = "nav_msgs/msg/Path",
                     *kMarkersType = "visualization_msgs/msg/MarkerArray",
                     *kDiagnosticsType = "diagnostic_msgs/msg/DiagnosticArray";

/// \brief Time and frame of a message.
struct RosStamp {
  double time = 0;  ///< s since 1970
  std::string frame;
};

/// \brief A pole as a standing cylinder.
struct PoleMarker {
  double x = 0, y = 0, radius = 0, bottom = 0, top = 0;  ///< m
  float red = 0, green = 0, blue = 0;                    ///< in [0, 1]
};

/// \brief diagnostic_msgs/msg/DiagnosticStatus.
struct RosDiagnostic {
  enum Level : std::uint8_t { ok, warning, error } level = ok;
  std::string name, message;
  std::vector<std::pair<std::string, std::string>> values;
};

/// \brief Time in ns since 1970, to a microsecond near today's times, as far as doubles go.
/// \throws Error when ROS cannot state it: it is not in [0, 2^31) s.
std::uint64_t rosNanoseconds(double time);

/// \name Messages in CDR
/// \throws Error as rosNanoseconds().
/// @{
std::string encodePose(const RosStamp& stamp, const PoseWithCovariance& pose);
/// \param pose Of the frame `child` in the frame of the stamp.
std::string encodeTransform(const RosStamp& stamp, const std::string& child, const Pose2D& pose);
/// \param stamp Of the path; each pose has its own time.
std::string encodePath(const RosStamp& stamp, const std::vector<StampedPose2D>& poses);
/// \brief Poles in the frame of the stamp, in place of all markers of the topic before.
std::string encodePoles(const RosStamp& stamp, const std::string& name,
                        const std::vector<PoleMarker>& poles);
std::string encodeDiagnostic(const RosStamp& stamp, const RosDiagnostic& diagnostic);
/// @}

/// \brief The definition of a type with those of all types in it, as `ros2msg` states them.
/// \param type "nav_msgs/msg/Path". \throws Error when it is not one that is written.
std::string rosSchema(const std::string& type);

}  // namespace polemcl::io
