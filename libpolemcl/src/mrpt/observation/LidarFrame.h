#pragma once
/// \file LidarFrame.h
/// \brief The frame the extraction works in, and points moved there. Private to the library.

#include <mrpt/poses/CPose3D.h>

#include <Eigen/Core>
#include <vector>

#include "core/common/Types.h"
#include "core/sensor/SensorOptions.h"

namespace polemcl {

/// \brief Where the lidar frame is, seen from the cloud and from the planar sensor frame.
struct LidarFrame {
  Eigen::Matrix3d R_lidar_cloud = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t_lidar_cloud = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_planar_lidar = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t_planar_lidar = Eigen::Vector3d::Zero();  ///< z is of no consequence
  bool cloudIsLidar = true;
  bool planarIsLidar = true;
};

/// \brief The lidar frame of clouds with this sensor pose, as ObservationPoleExtractor describes
/// it. \param level Level with the robot whatever the sensor pose is.
LidarFrame lidarFrame(const mrpt::poses::CPose3D& sensorPose, const SensorOptions& sensor,
                      bool level = false);

/// \brief Points in the lidar frame; keeps its buffers.
class MovedPoints {
 public:
  /// \brief The cloud itself where nothing is to be moved. Zeros (no return) stay zeros.
  PointsView toLidar(const PointsView& cloud, const LidarFrame& f);

 private:
  std::vector<float> m_x, m_y, m_z;
};

}  // namespace polemcl
