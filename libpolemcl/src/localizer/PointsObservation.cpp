#include "localizer/PointsObservation.h"

#include <mrpt/maps/CSimplePointsMap.h>

#include <string>

#include "core/common/DetectionCheck.h"

namespace polemcl {

mrpt::obs::CObservationPointCloud observationOf(double time, const PointsView& points) {
  if (!isTimeInSeconds(time))
    throw Error("a scan at " + std::to_string(time) + " s: " + kTimeAllowed);
  if (points.size > 0 && !(points.x && points.y && points.z))
    throw Error("points without x, y or z: each must be an array of " +
                std::to_string(points.size) + " numbers");
  const auto map = mrpt::maps::CSimplePointsMap::Create();
  map->resize(points.size);
  for (std::size_t i = 0; i < points.size; ++i)
    map->setPointFast(i, points.x[i], points.y[i], points.z[i]);
  mrpt::obs::CObservationPointCloud scan;
  scan.pointcloud = map;
  scan.timestamp = mrpt::Clock::fromDouble(time);
  return scan;
}

}  // namespace polemcl
