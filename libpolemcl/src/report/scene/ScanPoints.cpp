#include "report/scene/ScanPoints.h"

#include <mrpt/poses/CPose3D.h>

#include <cmath>

#include "mrpt/observation/ObservationPoints.h"

namespace polemcl::report {
namespace {

constexpr std::size_t kMost = 50000;

using Points = std::vector<mrpt::math::TPoint3Df>;

void append(Points& points, const mrpt::obs::CObservation& source,
            const ObservationPoleExtractorOptions& options) {
  ObservationPoints reader(options.sensor);
  const ObservationPoints::Loan loan(reader);
  const PointsView cloud = reader.read(source);
  const mrpt::poses::CPose3D pose = options.poseOf(source);
  for (std::size_t i = 0; i < cloud.size; ++i) {
    const mrpt::math::TPoint3D point(cloud.x[i], cloud.y[i], cloud.z[i]);
    const double range = point.norm();
    if (!std::isfinite(range) || range == 0) continue;
    const mrpt::math::TPoint3D place = pose.composePoint(point);
    points.emplace_back(static_cast<float>(place.x), static_cast<float>(place.y),
                        static_cast<float>(place.z));
  }
}

}  // namespace

Points scanPoints(const std::vector<mrpt::obs::CObservation::Ptr>& sources,
                  const SequenceOptions& reading) {
  Points points;
  for (const auto& source : sources) {
    const auto lidar = reading.vehicle.indexOf(source->sensorLabel);
    append(points, *source,
           lidar ? reading.vehicle.lidars[*lidar].extractor() : reading.extraction);
  }
  if (points.size() <= kMost) return points;
  for (std::size_t k = 0; k < kMost; ++k) points[k] = points[k * points.size() / kMost];
  points.resize(kMost);
  return points;
}

}  // namespace polemcl::report
