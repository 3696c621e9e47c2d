#include <mrpt/poses/CPose3D.h>
#include <polemcl/mrpt/PoleExtraction.h>

#include <Eigen/Geometry>
#include <cmath>

#include "MrptReason.h"
#include "ObservationPoints.h"

namespace polemcl {

namespace {

/// Where the lidar frame is, seen from the cloud and from the planar sensor frame.
struct Frames {
  Eigen::Matrix3d R_lidar_cloud = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t_lidar_cloud = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_planar_lidar = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t_planar_lidar = Eigen::Vector3d::Zero();  ///< z is of no consequence
  bool cloudIsLidar = true;
  bool planarIsLidar = true;
};

Frames framesOf(const mrpt::poses::CPose3D& sensorPose, const SensorOptions& sensor) {
  Frames f;
  const Eigen::Vector3d origin(sensor.originX, sensor.originY, sensor.originZ);
  const Eigen::Matrix3d R_robot_cloud = sensorPose.getRotationMatrix().asEigen();
  const Eigen::Matrix3d R_robot_planar =
      Eigen::AngleAxisd(sensorPose.yaw(), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const double upright = R_robot_cloud(2, 2);  // cosine between the two z axes
  Eigen::Matrix3d R_robot_lidar = R_robot_cloud;
  if (upright < -M_SQRT1_2) {
    f.R_lidar_cloud = Eigen::Vector3d(1, -1, -1).asDiagonal();  // half a turn about x
    R_robot_lidar = R_robot_cloud * f.R_lidar_cloud;
  } else if (upright < M_SQRT1_2) {
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

/// Moves a detection from the lidar frame to the planar sensor frame, at its middle height: there
/// the axis of a pole that stands askew in the lidar frame passes through the centre found. Heights
/// are above the ground under the pole, which the robot stands on too: level in its frame.
void toPlanar(const Frames& f, double ground, PoleDetection& pole) {
  if (f.planarIsLidar) return;
  const double middle = (pole.bottom + pole.top) / 2 + ground;  // above the sensor, along robot z
  const Eigen::RowVector3d up = f.R_planar_lidar.row(2);
  const double z = (middle - up.x() * pole.x - up.y() * pole.y) / up.z();
  const Eigen::Vector3d centre =
      f.R_planar_lidar * Eigen::Vector3d(pole.x, pole.y, z) + f.t_planar_lidar;
  const Eigen::Matrix2d turn = f.R_planar_lidar.topLeftCorner<2, 2>();
  const Eigen::Matrix2d covariance = turn * pole.covariance * turn.transpose();
  pole.x = centre.x();
  pole.y = centre.y();
  pole.covariance = (covariance + covariance.transpose()) / 2;  // symmetric to the last bit
}

/// Runs what reads an observation's points; errors of MRPT name its class.
template <class Work>
void readingPoints(const mrpt::obs::CObservation& observation, const Work& work) {
  try {
    work();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(std::string("points of a ") + observation.GetRuntimeClass()->className +
                " cannot be had: " + mrptReason(error.what()));
  }
}

}  // namespace

struct PoleExtraction::Impl {
  explicit Impl(const PoleExtractionOptions& o)
      : sensor(o.sensor), points(o.sensor), extractor(o.sensor, o.extraction) {}

  SensorOptions sensor;
  ObservationPoints points;
  PoleExtractor extractor;
  ExtractionReport report;
  std::vector<float> x, y, z;  ///< moved points

  PointsView toLidar(const PointsView& cloud, const Frames& f);
};

PointsView PoleExtraction::Impl::toLidar(const PointsView& cloud, const Frames& f) {
  if (f.cloudIsLidar) return cloud;
  x.resize(cloud.size);
  y.resize(cloud.size);
  z.resize(cloud.size);
  const Eigen::Matrix3f R = f.R_lidar_cloud.cast<float>();
  const Eigen::Vector3f t = f.t_lidar_cloud.cast<float>();
  for (std::size_t i = 0; i < cloud.size; ++i) {
    const float px = cloud.x[i], py = cloud.y[i], pz = cloud.z[i];
    if (px == 0 && py == 0 && pz == 0) {  // no return: must not become a point somewhere else
      x[i] = y[i] = z[i] = 0;
      continue;
    }
    x[i] = R(0, 0) * px + R(0, 1) * py + R(0, 2) * pz + t.x();
    y[i] = R(1, 0) * px + R(1, 1) * py + R(1, 2) * pz + t.y();
    z[i] = R(2, 0) * px + R(2, 1) * py + R(2, 2) * pz + t.z();
  }
  return {x.data(), y.data(), z.data(), cloud.size};
}

PoleExtraction::PoleExtraction(const PoleExtractionOptions& options)
    : m_impl(std::make_unique<Impl>(options)) {}
PoleExtraction::~PoleExtraction() = default;
PoleExtraction::PoleExtraction(PoleExtraction&&) noexcept = default;
PoleExtraction& PoleExtraction::operator=(PoleExtraction&&) noexcept = default;

bool PoleExtraction::canProcess(const mrpt::obs::CObservation& observation) {
  return ObservationPoints::canRead(observation);
}

CObservationPoles::Ptr PoleExtraction::process(const mrpt::obs::CObservation& observation) {
  auto result = std::make_shared<CObservationPoles>();
  result->timestamp = observation.timestamp;
  result->sensorLabel = observation.sensorLabel;
  observation.getSensorPose(result->sensorPose);
  m_impl->report = ExtractionReport();
  readingPoints(observation, [&] {
    const ObservationPoints::Loan loan(m_impl->points);
    const PointsView cloud = m_impl->points.read(observation);
    if (cloud.size > 0) {
      const Frames frames = framesOf(result->sensorPose, m_impl->sensor);
      result->poles = m_impl->extractor.extract(m_impl->toLidar(cloud, frames));
      m_impl->report = m_impl->extractor.report();
      for (auto& pole : result->poles) toPlanar(frames, m_impl->report.ground, pole);
    }
    m_impl->report.points += m_impl->points.dropped();
    m_impl->report.invalid += m_impl->points.dropped();
  });
  result->points = static_cast<std::uint32_t>(m_impl->report.points - m_impl->report.invalid);
  return result;
}

io::Cloud PoleExtraction::lidarPoints(const mrpt::obs::CObservation& observation) {
  mrpt::poses::CPose3D sensorPose;
  observation.getSensorPose(sensorPose);
  io::Cloud cloud;
  readingPoints(observation, [&] {
    const ObservationPoints::Loan loan(m_impl->points);
    const PointsView points =
        m_impl->toLidar(m_impl->points.read(observation), framesOf(sensorPose, m_impl->sensor));
    cloud.x.assign(points.x, points.x + points.size);
    cloud.y.assign(points.y, points.y + points.size);
    cloud.z.assign(points.z, points.z + points.size);
    cloud.intensity.resize(points.size);
    cloud.invalid = m_impl->points.dropped();
  });
  return cloud;
}

const ExtractionReport& PoleExtraction::report() const {
  return m_impl->report;
}

}  // namespace polemcl
