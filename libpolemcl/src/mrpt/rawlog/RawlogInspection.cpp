#include "mrpt/rawlog/RawlogInspection.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationRotatingScan.h>

#include <cmath>
#include <optional>

#include <polemcl/mrpt/observation/CObservationPoles.h>
#include <polemcl/mrpt/observation/ObservationPoleExtractor.h>
#include "core/common/Angles.h"
#include "mrpt/observation/LidarFrame.h"
#include "mrpt/observation/ObservationPoints.h"
#include "mrpt/rawlog/ScanSource.h"

namespace polemcl {
namespace {

constexpr std::size_t kMostScans = 8;

/// Scans spread evenly over the rawlog, in a single pass. If there are too many, every second one
/// is dropped and the stride is doubled.
std::vector<ScanSource::Scan> spreadScans(ScanSource& source, std::size_t& count) {
  std::vector<ScanSource::Scan> kept;
  std::size_t stride = 1;
  while (auto scan = source.next()) {
    ++count;
    if (scan->index % stride != 0) continue;
    kept.push_back(std::move(*scan));
    if (kept.size() <= kMostScans) continue;
    stride *= 2;
    std::vector<ScanSource::Scan> half;
    for (auto& each : kept)
      if (each.index % stride == 0) half.push_back(std::move(each));
    kept.swap(half);
  }
  return kept;
}

void requireBeams(const mrpt::obs::CObservation& scan) {
  if (dynamic_cast<const CObservationPoles*>(&scan))
    throw Error("holds poles, not scans; give the rawlog that they were extracted from");
  if (dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&scan))
    throw Error("is from a depth camera, which has an image and no beams: it needs no inspection");
  if (dynamic_cast<const mrpt::obs::CObservationRotatingScan*>(&scan))
    throw Error(
        "holds rotating scans, which do not state the elevations of their rings, so they cannot be "
        "inspected; write [sensor] by hand: model, or elevations_deg in the order of the rings");
}

std::vector<PointOrder> ordersOf(const std::vector<ScanSource::Scan>& scans) {
  std::vector<PointOrder> orders;
  ObservationPoints points{SensorOptions()};
  for (const ScanSource::Scan& scan : scans) {
    const ObservationPoints::Loan loan(points);
    const auto order = pointOrder(points.read(*scan.parts.front().observation));
    if (!order) return {};
    if (order->isWhole()) orders.push_back(*order);
  }
  return orders;
}

/// What all scans say alike of their measuring times, as packets do. The first may be cut short.
ScanTiming commonTiming(const std::vector<ScanSource::Scan>& scans) {
  constexpr double kSameCut = 15 * degree;  // turns are cut between two packets
  ObservationPoints points{SensorOptions()};
  std::optional<ScanTiming> common;
  for (std::size_t i = scans.size() > 1 ? 1 : 0; i < scans.size(); ++i) {
    points.read(*scans[i].parts.front().observation);
    const ObservationPoints::Loan loan(points);
    const auto& own = points.timing();
    if (!own || (common && std::abs(wrapAngle(own->cut - common->cut)) > kSameCut)) return {};
    if (!common) common = own;
  }
  return common.value_or(ScanTiming());
}

bool hasTimes(const mrpt::obs::CObservation& scan) {
  ObservationPoints points{SensorOptions()};
  points.read(scan);
  const ObservationPoints::Loan loan(points);
  return points.timing().has_value();
}

/// The options of a sensor identified in its own axes, for clouds with this sensor pose.
SensorOptions mounted(const SensorIdentification& sensor, const mrpt::poses::CPose3D& pose) {
  SensorOptions options = sensor.options();
  const Eigen::Matrix3d R_robot_lidar = pose.getRotationMatrix().asEigen() *
                                        lidarFrame(pose, SensorOptions()).R_lidar_cloud.transpose();
  const Eigen::Vector3d origin =
      R_robot_lidar * Eigen::Vector3d(options.originX, options.originY, options.originZ);
  const auto significant = [](double length) {
    return std::round(length * 1000) / 1000 + 0.0;
  };  // no -0
  options.originX = significant(origin.x());
  options.originY = significant(origin.y());
  options.originZ = significant(origin.z());
  return options;
}

}  // namespace

RawlogInspection inspectRawlog(const std::string& path, bool allowTruncated) {
  RawlogInspection result;
  ScanSource source(path, MotionOptions(), allowTruncated);
  const auto scans = spreadScans(source, result.scans);
  if (scans.empty()) throw Error(path + ": there is no scan in it");
  ObservationPoleExtractor reader{
      ObservationPoleExtractorOptions()};  // without an origin: that of the clouds applies
  std::vector<io::Cloud> clouds;
  std::vector<PointsView> views;
  for (const auto& scan : scans) {
    try {
      requireBeams(*scan.parts.front().observation);
      const std::string contradiction = packetContradiction(*scan.parts.front().observation);
      if (!contradiction.empty()) throw Error(contradiction);
      clouds.push_back(reader.lidarPoints(*scan.parts.front().observation));
    } catch (const Error& error) {
      throw Error(path + ": scan " + std::to_string(scan.index) + ": " + error.what());
    }
    result.used.push_back(scan.index);
  }
  views.reserve(clouds.size());
  for (const io::Cloud& cloud : clouds) views.push_back(cloud.view());
  result.orders = ordersOf(scans);
  for (PointsView& view : views)
    if (const auto order = pointOrder(view)) view = oneTurn(view, *order, 0).points;
  const auto& first = *scans.front().parts.front().observation;
  result.label = std::string(first.GetRuntimeClass()->className) +
                 (first.sensorLabel.empty() ? "" : " " + first.sensorLabel);
  first.getSensorPose(result.sensorPose);
  if (!source.timing().movingCut) result.stated = source.timing();
  if (!result.stated.known()) result.stated = commonTiming(scans);
  result.isTimed = source.timing().turn != Turn::automatic || hasTimes(first);
  try {
    result.sensor = identifySensor(views);
  } catch (const Error& error) {
    throw Error(path + ": " + error.what());
  }
  result.options = mounted(result.sensor, result.sensorPose);
  return result;
}

}  // namespace polemcl
