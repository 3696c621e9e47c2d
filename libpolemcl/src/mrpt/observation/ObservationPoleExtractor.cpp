#include <mrpt/obs/CObservation3DRangeScan.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <polemcl/mrpt/observation/ObservationPoleExtractor.h>
#include "core/common/Transform.h"
#include "core/extraction/VisibilityRange.h"
#include "core/sensor/PinholeCamera.h"
#include "core/sensor/PointOrder.h"
#include "core/sensor/SensorConfigCheck.h"
#include "mrpt/observation/LidarFrame.h"
#include "mrpt/observation/ObservationPoints.h"

namespace polemcl {

namespace {

/// Slope (dx/dz, dy/dz) of a vertical pole in the LiDAR frame, caused by sensor tilt.
Eigen::Vector2f upright(const LidarFrame& f) {
  const Eigen::Vector3d up = f.R_planar_lidar.row(2);
  return (up.head<2>() / up.z()).cast<float>();
}

/// Height of a detection's centre in the LiDAR frame: of the scan-line method that of the sensor,
/// of the method of the paper the mean of all points. Heights above ground are converted along the
/// robot's z axis.
double heightOfCentre(const LidarFrame& f, ExtractionMethod method, double ground,
                      const PoleDetection& pole) {
  if (method == ExtractionMethod::scanLine) return 0;
  const Eigen::RowVector3d up = f.R_planar_lidar.row(2);
  const auto inLidar = [&](double aboveGround) {
    return (aboveGround + ground - up.x() * pole.x - up.y() * pole.y) / up.z();
  };
  return 0.5 * (inLidar(pole.bottom) + inLidar(pole.top));
}

/// Transforms a detection from the LiDAR frame to the planar sensor frame.
void toPlanar(const LidarFrame& f, double z, PoleDetection& pole) {
  if (f.planarIsLidar) return;
  const Eigen::Vector3d centre =
      f.R_planar_lidar * Eigen::Vector3d(pole.x, pole.y, z) + f.t_planar_lidar;
  const Eigen::Matrix2d turn = f.R_planar_lidar.topLeftCorner<2, 2>();
  pole.x = centre.x();
  pole.y = centre.y();
  pole.covariance = symmetrized<2>(turn * pole.covariance * turn.transpose());
}

/// Converts the visibility ranges from the LiDAR frame to the planar sensor frame. A sector that
/// overlaps two takes the smaller range. A horizontal offset between the origins is subtracted.
std::vector<float> planarVisibilityRange(const LidarFrame& f,
                                         const std::vector<float>& visibilityRange) {
  if (f.planarIsLidar || visibilityRange.empty()) return visibilityRange;
  const std::size_t n = visibilityRange.size();
  const Eigen::Matrix2d turn = f.R_planar_lidar.topLeftCorner<2, 2>().transpose();
  const double aside = f.t_planar_lidar.head<2>().norm();
  const auto from = [&](double part) {
    const double azimuth = part * 2 * M_PI / static_cast<double>(n) - M_PI;
    const Eigen::Vector2d d = turn * Eigen::Vector2d(std::cos(azimuth), std::sin(azimuth));
    return visibilityRange[visibilityRangeSector(std::atan2(d.y(), d.x()), n)];
  };
  std::vector<float> planar(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto part = static_cast<double>(i);
    const float seen = std::min(from(part + 0.01), from(part + 0.99));
    planar[i] = std::max(0.f, seen - static_cast<float>(aside));
  }
  return planar;
}

}  // namespace

mrpt::poses::CPose3D ObservationPoleExtractorOptions::poseOf(
    const mrpt::obs::CObservation& observation) const {
  mrpt::poses::CPose3D pose;
  observation.getSensorPose(pose);
  if (sensorPose) pose = *sensorPose;
  if (!isPose(pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen()))
    throw Error(std::string("the sensor pose of a ") + observation.GetRuntimeClass()->className +
                " is not a finite place and a rotation: give the right one with --sensor-pose");
  return pose;
}

struct ObservationPoleExtractor::Impl {
  explicit Impl(const ObservationPoleExtractorOptions& o)
      : sensor(o.sensor),
        fromCloud(o.extraction.method == ExtractionMethod::rangeImage &&
                  o.extraction.rangeImage.projectFrom == "cloud"),
        points(o.sensor),
        options(o),
        extractor(o.sensor, o.extraction),
        check(o.sensor, o.extraction.method == ExtractionMethod::scanLine) {}

  SensorOptions sensor;
  bool fromCloud;  ///< the range image is projected from the origin of the clouds
  ObservationPoints points;
  ObservationPoleExtractorOptions options;
  PoleExtractor extractor;
  std::optional<PoleExtractor> cameraExtractor;  ///< for the last camera
  PinholeCamera camera;
  ExtractionReport report;
  ScanTiming recorded;  ///< of the scans, if the settings do not say it
  MovedPoints moved;
  SensorConfigCheck check;
  int checksLeft = 3;  ///< number of scans still to be compared with the configuration

  void compare(const mrpt::obs::CObservation& observation, const PointsView& cloud,
               const mrpt::poses::CPose3D& sensorPose);
  LidarFrame frameOf(const mrpt::poses::CPose3D& sensorPose) const;
  PoleExtractor& extractorFor(const LidarFrame& frames);
  ScanTiming timingOf(PointsView& cloud) const;
  void setTimeOffsets(const LidarFrame& frames, const ScanTiming& timing,
                      std::vector<PoleDetection>& poles) const;
  /// Whether the last points read are those of a depth image.
  bool pinhole() const { return points.camera().has_value(); }
};

/// Frame for the last points read. Points of a depth image are levelled; its rows are planes in any
/// frame. Its optical centre is the cloud's origin.
LidarFrame ObservationPoleExtractor::Impl::frameOf(const mrpt::poses::CPose3D& sensorPose) const {
  if (!pinhole() && !fromCloud) return lidarFrame(sensorPose, sensor);
  SensorOptions own = sensor;
  own.originX = own.originY = own.originZ = 0;
  return lidarFrame(sensorPose, own, pinhole());
}

/// Extractor for the last points read.
PoleExtractor& ObservationPoleExtractor::Impl::extractorFor(const LidarFrame& frames) {
  if (!pinhole()) return extractor;
  PinholeCamera seen = *points.camera();
  seen.R_lidar_camera = frames.R_lidar_cloud;
  if (!cameraExtractor || !(seen == camera)) {
    cameraExtractor.emplace(seen, sensor, options.extraction);
    camera = seen;
  }
  return *cameraExtractor;
}

/// \param cloud The last points read. Where their order tells the begin, one turn of them is left,
///        that of the time stamp.
ScanTiming ObservationPoleExtractor::Impl::timingOf(PointsView& cloud) const {
  ScanTiming timing = sensor.timing;
  if (timing.turn == Turn::automatic) {
    timing = points.timing().value_or(recorded);
    timing.clock += sensor.timing.clock;
  }
  if (!timing.known() || !timing.movingCut) return timing;
  if (const auto order = pointOrder(cloud)) {
    const OneTurn turn = oneTurn(cloud, *order, timing.stamp);
    cloud = turn.points;
    timing.cut = turn.begin;
    return timing;
  }
  if (cloud.size >= SensorConfigCheck::kFewestPoints) throw UnorderedScan();
  timing.turn = Turn::compensated;  // nothing to correct
  return timing;
}

/// \param poles In the LiDAR frame.
void ObservationPoleExtractor::Impl::setTimeOffsets(const LidarFrame& frames,
                                                    const ScanTiming& timing,
                                                    std::vector<PoleDetection>& poles) const {
  if (!timing.known() && timing.clock == 0) return;
  const bool onItsHead = frames.R_lidar_cloud(2, 2) < 0;
  for (PoleDetection& pole : poles) {
    const Eigen::Vector3d cloud =
        frames.R_lidar_cloud.transpose() * Eigen::Vector3d(pole.x, pole.y, 0);
    pole.timeOffset = timing.offset(std::atan2(cloud.y(), cloud.x()));
    pole.turnRate = onItsHead ? -timing.turnRate() : timing.turnRate();
  }
}

void ObservationPoleExtractor::Impl::compare(const mrpt::obs::CObservation& observation,
                                             const PointsView& cloud,
                                             const mrpt::poses::CPose3D& sensorPose) {
  const bool image = dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation);
  if (!sensor.checkBeams || checksLeft <= 0 || image ||
      cloud.size < SensorConfigCheck::kFewestPoints)
    return;
  const std::string ofPackets = packetContradiction(observation);
  if (!ofPackets.empty()) throw Error(ofPackets + "; check_beams = false uses them anyway");
  const std::string contradiction =
      check.contradiction(moved.toLidar(cloud, lidarFrame(sensorPose, sensor)));
  if (!contradiction.empty()) throw Error(contradiction);
  --checksLeft;
}

ObservationPoleExtractor::UnorderedScan::UnorderedScan()
    : Error(
          "the points of the cloud are not in the order of measuring, so moving_cut = true finds "
          "no begin of the scan; cut_deg names a fixed one") {}

ObservationPoleExtractor::ObservationPoleExtractor(const ObservationPoleExtractorOptions& options)
    : m_impl(std::make_unique<Impl>(options)) {}
ObservationPoleExtractor::~ObservationPoleExtractor() = default;
ObservationPoleExtractor::ObservationPoleExtractor(ObservationPoleExtractor&&) noexcept = default;
ObservationPoleExtractor& ObservationPoleExtractor::operator=(ObservationPoleExtractor&&) noexcept =
    default;

bool ObservationPoleExtractor::canProcess(const mrpt::obs::CObservation& observation) {
  return ObservationPoints::canRead(observation);
}

CObservationPoles::Ptr ObservationPoleExtractor::process(
    const mrpt::obs::CObservation& observation) {
  auto result = std::make_shared<CObservationPoles>();
  result->timestamp = observation.timestamp;
  result->sensorLabel = observation.sensorLabel;
  result->sensorPose = m_impl->options.poseOf(observation);
  m_impl->report = ExtractionReport();
  const ObservationPoints::Loan loan(m_impl->points);
  PointsView cloud = m_impl->points.read(observation);
  if (cloud.size > 0) {
    const LidarFrame frames = m_impl->frameOf(result->sensorPose);
    m_impl->compare(observation, cloud, result->sensorPose);
    const ScanTiming timing = m_impl->timingOf(cloud);
    const PointsView points = m_impl->moved.toLidar(cloud, frames);
    PoleExtractor& extractor = m_impl->extractorFor(frames);
    result->poles = extractor.extract(points, upright(frames));
    m_impl->report = extractor.report();
    m_impl->setTimeOffsets(frames, timing, result->poles);
    result->visibilityRange = planarVisibilityRange(frames, extractor.visibilityRange());
    for (auto& pole : result->poles)
      toPlanar(
          frames,
          heightOfCentre(frames, m_impl->options.extraction.method, m_impl->report.ground, pole),
          pole);
  }
  m_impl->report.points += m_impl->points.dropped();
  m_impl->report.invalid += m_impl->points.dropped();
  result->points = static_cast<std::uint32_t>(m_impl->report.points - m_impl->report.invalid);
  return result;
}

io::Cloud ObservationPoleExtractor::lidarPoints(const mrpt::obs::CObservation& observation) {
  const mrpt::poses::CPose3D sensorPose = m_impl->options.poseOf(observation);
  io::Cloud cloud;
  const ObservationPoints::Loan loan(m_impl->points);
  const PointsView read = m_impl->points.read(observation);
  const PointsView points = m_impl->moved.toLidar(read, m_impl->frameOf(sensorPose));
  cloud.x.assign(points.x, points.x + points.size);
  cloud.y.assign(points.y, points.y + points.size);
  cloud.z.assign(points.z, points.z + points.size);
  cloud.intensity.resize(points.size);
  cloud.invalid = m_impl->points.dropped();
  return cloud;
}

void ObservationPoleExtractor::checkNext(bool compare) {
  m_impl->checksLeft = compare ? 1 : 0;
}

void ObservationPoleExtractor::setRecordedTiming(const ScanTiming& timing) {
  m_impl->recorded = timing;
}

const ExtractionReport& ObservationPoleExtractor::report() const {
  return m_impl->report;
}

}  // namespace polemcl
