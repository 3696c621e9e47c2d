#pragma once
/// \file RosbagMotions.h
/// \brief Motions between the scans of a ROS 2 bag: odometry, and the gyroscope of an IMU.

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>

#include "io/dataset/ScanFolder.h"
#include "io/rosbag/Bag.h"

namespace polemcl::io {

/// \brief Frames, each with its pose in its parent.
class FrameTree {
 public:
  /// \brief Sets the pose of a frame; a later one replaces the earlier one.
  void add(const std::string& parent, const std::string& child,
           const Eigen::Isometry3d& T_parent_child);

  /// \brief The pose of `frame` in `base`, m; identity if both are one. \return Nothing if they are
  /// not connected.
  std::optional<Eigen::Isometry3d> find(const std::string& base, const std::string& frame) const;

 private:
  struct Link {
    std::string parent;
    Eigen::Isometry3d T_parent_child;
  };
  /// The frames above one and itself, with its pose in each of them.
  std::map<std::string, Eigen::Isometry3d> above(const std::string& frame) const;

  std::map<std::string, Link> m_links;  ///< by the name of the child
};

/// \brief Sets the motions between the scans.
///
/// The poses of the odometry are interpolated at the times of the scans. Scans at times without
/// odometry are dropped, with a note; so are those without IMU, if it is used.
///
/// Covariances: the errors of the velocity are taken as independent from one message of the
/// odometry to the next. A message thus adds its covariance of (vx, vy, yaw rate) times dt², dt
/// being the time since the message before; the steps are composed, see MotionSteps. Messages
/// without a covariance (all zero, negative, not finite) are left out; if they are half of a
/// motion, kDefaultMotionNoise applies to it. The variances of motionFloorMetres and
/// motionFloorRadians are added.
///
/// With an IMU, the yaw of a motion is the integral of the angular velocity about the robot's z
/// axis, with the variance of the IMU in the same way. The displacement turns by half of the change
/// of the yaw, as on an arc. Where the IMU was silent for over 0.2 s, the odometry's yaw stays.
/// \param odometry Topic, index in bag.topics(). \param imu The same; nothing: not used.
/// \param frames Static transforms; if the pose of the IMU is not among them, its z axis is taken
///        for that of the robot, with a note.
/// \throws Error as decodeOdometry(), decodeImu() and requireVehicleFrame(), or when the odometry
///         has two child frames, or no scan has odometry (or IMU, if it is used) at its time.
void addRosbagMotions(const Bag& bag, std::size_t odometry, std::optional<std::size_t> imu,
                      const FrameTree& frames, ScanFolder& folder);

}  // namespace polemcl::io
