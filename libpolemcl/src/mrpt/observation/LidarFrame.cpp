#include "mrpt/observation/LidarFrame.h"

#include <Eigen/Geometry>
#include <cmath>

namespace polemcl {

bool isPose(const Eigen::Matrix4d& matrix) {
  const Eigen::Matrix3d turn = matrix.topLeftCorner<3, 3>();
  return matrix.allFinite() && turn.isUnitary(1e-3) && turn.determinant() > 0;
}

LidarFrame lidarFrame(const mrpt::poses::CPose3D& sensorPose, const SensorOptions& sensor,
                      bool level) {
  LidarFrame f;
  const Eigen::Vector3d origin(sensor.originX, sensor.originY, sensor.originZ);
  const Eigen::Matrix3d R_robot_cloud = sensorPose.getRotationMatrix().asEigen();
  const Eigen::Matrix3d R_robot_planar =
      Eigen::AngleAxisd(sensorPose.yaw(), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const double upright = R_robot_cloud(2, 2);  // cosine of the angle between the two z axes
  Eigen::Matrix3d R_robot_lidar = R_robot_cloud;
  if (!level && upright < -M_SQRT1_2) {
    f.R_lidar_cloud = Eigen::Vector3d(1, -1, -1).asDiagonal();  // half a turn about x
    R_robot_lidar = R_robot_cloud * f.R_lidar_cloud;
  } else if (level || upright < M_SQRT1_2) {
    f.R_lidar_cloud = R_robot_planar.transpose() * R_robot_cloud;
    R_robot_lidar = R_robot_planar;
  }
  f.t_lidar_cloud = -(R_robot_lidar.transpose() * origin);
  f.R_planar_lidar = R_robot_planar.transpose() * R_robot_lidar;
  f.t_planar_lidar = R_robot_planar.transpose() * origin;
  f.cloudIsLidar = f.R_lidar_cloud.isIdentity(0) && origin.isZero(0);
  f.planarIsLidar = f.R_planar_lidar.isIdentity(1e-12) && origin.isZero(0);
  return f;
}

PointsView MovedPoints::toLidar(const PointsView& cloud, const LidarFrame& f) {
  if (f.cloudIsLidar) return cloud;
  m_x.resize(cloud.size);
  m_y.resize(cloud.size);
  m_z.resize(cloud.size);
  const Eigen::Matrix3f R = f.R_lidar_cloud.cast<float>();
  const Eigen::Vector3f t = f.t_lidar_cloud.cast<float>();
  for (std::size_t i = 0; i < cloud.size; ++i) {
    const float px = cloud.x[i], py = cloud.y[i], pz = cloud.z[i];
    if (px == 0 && py == 0 && pz == 0) {  // no return: must not become a point elsewhere
      m_x[i] = m_y[i] = m_z[i] = 0;
      continue;
    }
    m_x[i] = R(0, 0) * px + R(0, 1) * py + R(0, 2) * pz + t.x();
    m_y[i] = R(1, 0) * px + R(1, 1) * py + R(1, 2) * pz + t.y();
    m_z[i] = R(2, 0) * px + R(2, 1) * py + R(2, 2) * pz + t.z();
  }
  return {m_x.data(), m_y.data(), m_z.data(), cloud.size};
}

}  // namespace polemcl
