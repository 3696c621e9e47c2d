#pragma once
/// \file Types.h
/// \brief The small data types that every step of the pipeline shares.
///
/// Units: metres, radians, seconds. Frames: *map* z up; *robot* x forward, y left, z up;
/// *sensor* the frame the points come in. Heights are above the local ground unless said otherwise.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <polemcl/export.h>

namespace polemcl {

/// \brief Bad input: what, where, what is allowed, what to do, in one line. Programs exit with 1.
class POLEMCL_EXPORT Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// \brief Planar pose: x, y in metres, yaw in radians, counter-clockwise, in (-pi, pi].
struct Pose2D {
  double x = 0;
  double y = 0;
  double yaw = 0;
};

/// \brief Composition `base ⊕ other`. \param other In the frame of `base`.
/// \return The same pose in the frame in which `base` is given.
POLEMCL_EXPORT Pose2D compose(const Pose2D& base, const Pose2D& other);
/// \brief The pose `to` expressed in the frame of `from` (⊖).
POLEMCL_EXPORT Pose2D relative(const Pose2D& from, const Pose2D& to);
/// \brief Wraps an angle into (-pi, pi].
POLEMCL_EXPORT double wrapAngle(double angle);

/// \brief A pose or a motion with its uncertainty.
struct POLEMCL_EXPORT PoseWithCovariance {
  Pose2D mean;
  /// Covariance of (x, y, yaw), m², m·rad, rad².
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// \brief Planar velocity in the robot frame.
struct POLEMCL_EXPORT Velocity {
  double x = 0, y = 0;  ///< m/s
  double yaw = 0;       ///< rad/s
};

struct StampedPose2D {
  double time = 0;  ///< s
  Pose2D pose;
};

/// \brief A borrowed cloud, structure of arrays; index i is point i in all three. Nothing is owned.
struct PointsView {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  std::size_t size = 0;
};

/// \brief One pole seen in one scan.
struct PoleDetection {
  /// Centre of the trunk in the plane, m. Frame: the one named by who hands it out (sensor or
  /// robot).
  double x = 0;
  double y = 0;
  double radius = 0;      ///< m
  double bottom = 0;      ///< lowest return, m above local ground
  double top = 0;         ///< highest return, m above local ground
  double confidence = 1;  ///< in [0, 1]: probability-like score that this is a pole
  /// Covariance of (x, y), m², same frame as x, y. See isCovariance().
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity() * 0.01;
  std::uint32_t points = 0;  ///< returns that support it
  /// Time from the stamp of the scan to the moment the pole was measured, s: x, y and covariance
  /// are those of this moment. 0: at the stamp, or the scan was corrected for motion.
  double timeOffset = 0;
  /// Turning rate of the LiDAR, rad/s, positive counterclockwise seen from above: radius, x and y
  /// are those of a pole that stood still while the beam crossed it. 0: it did, or unknown.
  double turnRate = 0;
};

/// \brief One scan in the form that map and filter need.
struct PoleScan {
  double time = 0;  ///< s
  /// Motion since the previous scan, in its robot frame. Ignored for the first scan; nullopt:
  /// unknown.
  std::optional<PoseWithCovariance> motion;
  std::vector<PoleDetection> poles_robot;
  std::size_t points = 0;                   ///< valid points of the scan; 0: none or unknown
  std::vector<float> visibilityRange = {};  ///< as in CObservationPoles; may be empty
  Pose2D pose_robot_sensor = {};            ///< pose of the frame of visibilityRange
  /// Velocity at the time of the scan, where the motions up to it do not tell.
  std::optional<Velocity> velocity = {};
};

/// \brief One pole of a map, map frame.
struct MapPole {
  double x = 0;
  double y = 0;
  double radius = 0;
  double bottom = 0;  ///< m above local ground
  double top = 0;     ///< m above local ground
  double confidence = 1;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity() * 0.01;  ///< of (x, y), m², map frame
  std::uint32_t count = 0;  ///< detections merged into it, at most one a scan
};

}  // namespace polemcl
