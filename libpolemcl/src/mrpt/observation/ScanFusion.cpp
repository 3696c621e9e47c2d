#include "mrpt/observation/ScanFusion.h"

#include <algorithm>
#include <cmath>

#include "core/extraction/VisibilityRange.h"

namespace polemcl {
namespace {

/// No LiDAR sees farther, m; poles from a damaged rawlog may say so.
constexpr double kFarthest = 1000;

/// How far one LiDAR sees along a ray from the robot's origin, m: up to the first step that it does
/// not see.
float seenAlong(double azimuth, const CObservationPoles& part) {
  const auto& ranges = part.visibilityRange;
  if (ranges.empty()) return 0;
  const Pose2D lidar = part.planarSensorPose();
  const double most = std::min<double>(kFarthest, *std::max_element(ranges.begin(), ranges.end()));
  float seen = 0;
  for (float reach = VisibilityRangeFinder::kStep;; reach += VisibilityRangeFinder::kStep) {
    const Pose2D place = relative(lidar, {reach * std::cos(azimuth), reach * std::sin(azimuth), 0});
    const double distance = std::hypot(place.x, place.y);
    const double visible =
        ranges[visibilityRangeSector(std::atan2(place.y, place.x), ranges.size())];
    if (distance > most || distance > visible) return seen;
    seen = reach;
  }
}

}  // namespace

const char* const kFusedLabel = "fused";

std::vector<float> fusedVisibility(const std::vector<CObservationPoles::Ptr>& parts) {
  std::size_t sectors = 0;
  for (const auto& part : parts) sectors = std::max(sectors, part->visibilityRange.size());
  std::vector<float> fused(sectors, 0);
  for (std::size_t i = 0; i < sectors; ++i) {
    const double azimuth =
        (static_cast<double>(i) + 0.5) * 2 * M_PI / static_cast<double>(sectors) - M_PI;
    for (const auto& part : parts) fused[i] = std::max(fused[i], seenAlong(azimuth, *part));
  }
  return fused;
}

FusedScan fuseScans(const std::vector<CObservationPoles::Ptr>& parts, double time,
                    const Velocity& velocity) {
  FusedScan result;
  result.observation = std::make_shared<CObservationPoles>();
  CObservationPoles& fused = *result.observation;
  fused.timestamp = mrpt::Clock::fromDouble(time);
  fused.sensorLabel = kFusedLabel;
  for (const auto& part : parts) {
    auto poles = part->polesInRobotFrame();
    const double shift = mrpt::Clock::toDouble(part->timestamp) - time;
    for (PoleDetection& pole : poles) pole.timeOffset += shift;
    result.agreements.push_back(fuseDetections(fused.poles, poles, velocity));
    fused.points += part->points;
  }
  fused.visibilityRange = fusedVisibility(parts);
  return result;
}

}  // namespace polemcl
