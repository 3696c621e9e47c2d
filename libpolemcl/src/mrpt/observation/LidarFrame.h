#pragma once
/// \file LidarFrame.h
/// \brief The LiDAR frame in which the extraction works, and transformation of points to it.
/// Private to the library.

#include <mrpt/poses/CPose3D.h>

#include <Eigen/Core>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/core/sensor/SensorOptions.h>

namespace polemcl {

/// \brief Pose of the LiDAR frame relative to the cloud and to the planar sensor frame.
struct LidarFrame {
  Eigen::Matrix3d R_lidar_cloud = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t_lidar_cloud = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_planar_lidar = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t_planar_lidar = Eigen::Vector3d::Zero();  ///< z is not used
  bool cloudIsLidar = true;
  bool planarIsLidar = true;
};

/// \brief The LiDAR frame of clouds with this sensor pose, as described at
/// ObservationPoleExtractor. \param level True: level with the robot for any sensor pose.
LidarFrame lidarFrame(const mrpt::poses::CPose3D& sensorPose, const SensorOptions& sensor,
                      bool level = false);

/// \brief Whether the matrix is a pose: a finite place and a rotation. MRPT reads any numbers.
bool isPose(const Eigen::Matrix4d& matrix);

/// \brief Transforms points to the LiDAR frame; reuses its buffers.
class MovedPoints {
 public:
  /// \brief Returns the cloud itself if no transformation is needed. Zeros (no return) stay zeros.
  PointsView toLidar(const PointsView& cloud, const LidarFrame& f);

 private:
  std::vector<float> m_x, m_y, m_z;
};

}  // namespace polemcl
